#include "tools/render/ordered_frames.hpp"

#include <condition_variable>
#include <mutex>

#include "pipeline/base/parallel.hpp"
#include "tools/common/progress_line.hpp"

namespace houghstream::render {
namespace {

/// Lets items through one at a time, by number.
class Gate {
 public:
  /// Runs `work` when all items before `index` are through. False when one of them failed.
  bool pass(int index, const std::function<void()>& work) {
    std::unique_lock<std::mutex> lock(mutex_);
    turn_.wait(lock, [&] { return next_ == index || failed_; });
    if (failed_) return false;
    work();
    ++next_;
    turn_.notify_all();
    return true;
  }

  /// Ends all waiting after a failure.
  void fail_all() {
    const std::lock_guard<std::mutex> lock(mutex_);
    failed_ = true;
    turn_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable turn_;
  int next_ = 0;
  bool failed_ = false;
};

}  // namespace

void render_in_order(const std::string& title, int threads, int count,
                     const std::function<world::RenderedFrame(int)>& render,
                     const std::function<void(const world::RenderedFrame&)>& write) {
  Gate gate;
  ProgressLine progress(title, count);
  parallel_for(threads, count, [&](int index) {
    try {
      const world::RenderedFrame frame = render(index);
      gate.pass(index, [&] {
        write(frame);
        progress.at(index + 1);
      });
    } catch (...) {
      gate.fail_all();
      throw;
    }
  });
}

}  // namespace houghstream::render
