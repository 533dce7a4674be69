#pragma once

#include <OpenNI.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "drivers/openni/openni_parts.hpp"
#include "drivers/openni/persistent_thread.hpp"

// Only the .cpp files of this folder include this header.

namespace houghstream::openni {

/// Images in the order of their arrival, from one thread to another.
class ImageQueue {
 public:
  void put(SensorImage image) {
    const std::lock_guard<std::mutex> lock(mutex_);
    images_.push_back(std::move(image));
    if (images_.size() > kCapacity) images_.pop_front();
    arrived_.notify_one();
  }
  std::optional<SensorImage> take(std::chrono::milliseconds timeout) {
    std::unique_lock<std::mutex> lock(mutex_);
    if (!arrived_.wait_for(lock, timeout, [&] { return !images_.empty(); })) return std::nullopt;
    SensorImage image = std::move(images_.front());
    images_.pop_front();
    return image;
  }
  void clear() {
    const std::lock_guard<std::mutex> lock(mutex_);
    images_.clear();
  }

 private:
  static constexpr std::size_t kCapacity = 60;  // a second of both sensors at 30 Hz

  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<SensorImage> images_;
};

/// Takes each image the moment it arrives, as a stream keeps its newest one only, from a thread that goes before others
/// where the rights allow. OpenNI2's own listeners are not used: one that was called twice for one image waits inside
/// OpenNI2 for the next, which never comes while the other, synchronised stream's is not taken; it cannot be removed.
class StreamReader {
 public:
  /// Begins; the streams must run, and be stopped only after this has ended.
  StreamReader(::openni::VideoStream& depth, ::openni::VideoStream& colour, ImageQueue& to)
      : depth_(depth), colour_(colour), queue_(to), thread_([this] { run(); }) {}
  StreamReader(const StreamReader&) = delete;
  StreamReader& operator=(const StreamReader&) = delete;

  /// Ends behind an image, or when none comes: as a synchronised stream stops, OpenNI2 deletes what its driver's thread
  /// may just be handing an image to.
  ~StreamReader() { running_ = false; }

 private:
  static constexpr int kNiceLevel = -10;
  static constexpr std::chrono::milliseconds kTimeout{100};

  void run() {
    setpriority(PRIO_PROCESS, 0, kNiceLevel);  // on Linux this sets the calling thread
    while (running_) {
      const std::optional<SensorImage::Sensor> sensor = wait_for_image(depth_, colour_, kTimeout);
      if (!sensor) continue;
      std::optional<SensorImage> image = read_image(*sensor == SensorImage::Sensor::kDepth ? depth_ : colour_, *sensor);
      if (image) queue_.put(std::move(*image));
    }
  }

  ::openni::VideoStream& depth_;
  ::openni::VideoStream& colour_;
  ImageQueue& queue_;
  std::atomic<bool> running_{true};
  PersistentThread thread_;  // last, so that it is waited for first: it uses the others
};

}  // namespace houghstream::openni
