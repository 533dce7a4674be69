#include "pipeline/base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace houghstream {
namespace {

/// Distributes the items of one call of parallel_for_workers.
class Items {
 public:
  Items(const WorkerItemFunction& work, int count) : work_(work), count_(count), error_index_(count) {}

  /// Works until there are no more.
  void work(int worker) {
    for (int i = next_++; i < count_; i = next_++) {
      try {
        work_(worker, i);
      } catch (...) {
        const std::lock_guard lock(error_mutex_);
        if (i < error_index_) {
          error_index_ = i;
          error_ = std::current_exception();
        }
      }
    }
  }

  void rethrow_first_error() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  const WorkerItemFunction& work_;
  int count_;
  std::atomic<int> next_{0};
  std::mutex error_mutex_;
  int error_index_;
  std::exception_ptr error_;
};

/// A thread that waits to be given items.
class Helper {
 public:
  Helper() : thread_([this] { live(); }) {}
  Helper(const Helper&) = delete;
  Helper& operator=(const Helper&) = delete;
  ~Helper() {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  void start(Items& items, int worker) {
    {
      const std::lock_guard lock(mutex_);
      items_ = &items;
      worker_ = worker;
    }
    changed_.notify_all();
  }

  /// Waits until the helper does not touch the items any more. One that has not woken up yet need not work on them.
  void finish() {
    std::unique_lock lock(mutex_);
    if (!working_) items_ = nullptr;
    changed_.wait(lock, [this] { return items_ == nullptr; });
  }

 private:
  void live() {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return ending_ || items_ != nullptr; });
      if (ending_) return;
      working_ = true;
      Items& items = *items_;
      const int worker = worker_;
      lock.unlock();
      items.work(worker);
      lock.lock();
      working_ = false;
      items_ = nullptr;
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  Items* items_ = nullptr;
  int worker_ = 0;
  bool working_ = false;
  bool ending_ = false;
  std::thread thread_;  // last: it uses the others
};

/// Keeps helpers that are idle. Calls that overlap take different ones, so that none waits for another.
class IdleHelpers {
 public:
  std::unique_ptr<Helper> take() {
    const std::lock_guard lock(mutex_);
    if (helpers_.empty()) return std::make_unique<Helper>();
    std::unique_ptr<Helper> helper = std::move(helpers_.back());
    helpers_.pop_back();
    return helper;
  }

  void give_back(std::unique_ptr<Helper> helper) {
    const std::lock_guard lock(mutex_);
    helpers_.push_back(std::move(helper));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Helper>> helpers_;
};

/// Returns the scope of the calling thread; null where it may use helper threads.
const SerialScope*& working_alone() {
  thread_local const SerialScope* alone = nullptr;
  return alone;
}

IdleHelpers& idle_helpers() {
  static IdleHelpers helpers;
  return helpers;
}

/// A helper at work on the items until it goes out of scope.
class BorrowedHelper {
 public:
  BorrowedHelper(Items& items, int worker) : helper_(idle_helpers().take()) { helper_->start(items, worker); }
  BorrowedHelper(const BorrowedHelper&) = delete;
  BorrowedHelper& operator=(const BorrowedHelper&) = delete;
  ~BorrowedHelper() {
    helper_->finish();
    idle_helpers().give_back(std::move(helper_));
  }

 private:
  std::unique_ptr<Helper> helper_;
};

void work_with_helpers(Items& items, int helpers) {
  if (helpers == 0) return items.work(0);
  const BorrowedHelper helper(items, helpers);
  work_with_helpers(items, helpers - 1);
}

}  // namespace

SerialScope::SerialScope(std::function<bool()> is_cancelled)
    : is_cancelled_(std::move(is_cancelled)), outer_(working_alone()) {
  working_alone() = this;
}

SerialScope::~SerialScope() {
  working_alone() = outer_;
}

void SerialScope::throw_if_cancelled() const {
  if (is_cancelled_ && is_cancelled_()) throw WorkCancelled("work that nobody waits for any more");
}

void parallel_for(int threads, int count, const ItemFunction& work) {
  parallel_for_workers(threads, count, [&](int, int item) { work(item); });
}

void parallel_for_workers(int threads, int count, const WorkerItemFunction& work) {
  const SerialScope* alone = working_alone();
  if (threads <= 1 || count <= 1 || alone != nullptr) {
    for (int i = 0; i < count; ++i) {
      if (alone != nullptr) alone->throw_if_cancelled();
      work(0, i);
    }
    return;
  }
  Items items(work, count);
  work_with_helpers(items, std::min(threads, count) - 1);
  items.rethrow_first_error();
}

}  // namespace houghstream
