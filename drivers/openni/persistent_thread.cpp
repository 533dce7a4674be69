#include "drivers/openni/persistent_thread.hpp"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace houghstream::openni {

class PersistentThread::Worker {
 public:
  Worker() {
    std::thread([this] { run(); }).detach();
  }

  void begin(std::function<void()> work) {
    const std::lock_guard<std::mutex> lock(mutex_);
    work_ = std::move(work);
    changed_.notify_all();
  }
  void await_end() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return !work_; });
  }

 private:
  [[noreturn]] void run() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      changed_.wait(lock, [&] { return static_cast<bool>(work_); });
      lock.unlock();
      work_();
      lock.lock();
      work_ = nullptr;
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> work_;
};

namespace {

struct Idle {
  std::mutex mutex;
  std::vector<std::unique_ptr<PersistentThread::Worker>> workers;
};

/// Returns an object that is never destroyed, as the threads use it as long as the process lives.
Idle& idle() {
  static auto* const all = new Idle;
  return *all;
}

std::unique_ptr<PersistentThread::Worker> take_worker() {
  const std::lock_guard<std::mutex> lock(idle().mutex);
  if (idle().workers.empty()) return std::make_unique<PersistentThread::Worker>();
  auto worker = std::move(idle().workers.back());
  idle().workers.pop_back();
  return worker;
}

}  // namespace

PersistentThread::PersistentThread(std::function<void()> work) : worker_(take_worker()) {
  worker_->begin(std::move(work));
}

PersistentThread::~PersistentThread() {
  worker_->await_end();
  const std::lock_guard<std::mutex> lock(idle().mutex);
  idle().workers.push_back(std::move(worker_));
}

}  // namespace houghstream::openni
