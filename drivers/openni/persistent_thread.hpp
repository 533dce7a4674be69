#pragma once

#include <functional>
#include <memory>

namespace houghstream::openni {

/// Work on a thread that is not ended with it: the next work gets it. OpenNI2 keeps the handle of every thread that has
/// waited for an image and asks after it when another comes to wait; a thread that has ended makes that crash.
class PersistentThread {
 public:
  /// Begins the work, which must not throw, on a thread that is idle or, where there is none, on a new one.
  explicit PersistentThread(std::function<void()> work);
  PersistentThread(const PersistentThread&) = delete;
  PersistentThread& operator=(const PersistentThread&) = delete;

  /// Waits for the work's end.
  ~PersistentThread();

  class Worker;

 private:
  std::unique_ptr<Worker> worker_;
};

}  // namespace houghstream::openni
