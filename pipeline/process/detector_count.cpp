#include "pipeline/process/detector_count.hpp"

#include <algorithm>

namespace houghstream {
namespace {

constexpr std::size_t kFrames = 16;  // frames with results
constexpr std::size_t kUtimes = 64;  // a result comes within so many frames

template <typename T>
void push_limited(std::deque<T>& queue, T item, std::size_t limit) {
  queue.push_back(std::move(item));
  if (queue.size() > limit) queue.pop_front();
}

}  // namespace

DetectorCount::Camera* DetectorCount::find_or_add_camera(const std::string& channel) {
  if (cameras_.size() >= kCameras && cameras_.count(channel) == 0) return nullptr;
  return &cameras_[channel];
}

DetectorCount::Frame* DetectorCount::Camera::find(std::int64_t utime) {
  const auto known = std::find_if(frames.begin(), frames.end(), [&](const Frame& f) { return f.utime == utime; });
  return known == frames.end() ? nullptr : &*known;
}

void DetectorCount::note_frame(const FrameId& frame) {
  Camera* camera = find_or_add_camera(frame.channel);
  if (camera == nullptr) return;
  Frame* frame_entry = camera->find(frame.utime);
  if (frame_entry != nullptr && frame_entry->has_arrived) {
    forget(frame);
  } else if (frame_entry != nullptr) {
    frame_entry->has_arrived = true;
  }
  push_limited(camera->utimes, frame.utime, kUtimes);
}

void DetectorCount::note_result(const FrameId& frame) {
  Camera* camera = find_or_add_camera(frame.channel);
  if (camera == nullptr) return;
  if (Frame* known = camera->find(frame.utime); known != nullptr) {
    ++known->results;
    return;
  }
  const bool has_arrived = std::find(camera->utimes.begin(), camera->utimes.end(), frame.utime) != camera->utimes.end();
  push_limited(camera->frames, Frame{frame.utime, 1, has_arrived}, kFrames);
}

void DetectorCount::forget(const FrameId& frame) {
  const auto camera = cameras_.find(frame.channel);
  if (camera == cameras_.end()) return;
  std::deque<Frame>& frames = camera->second.frames;
  frames.erase(std::remove_if(frames.begin(), frames.end(), [&](const Frame& f) { return f.utime == frame.utime; }),
               frames.end());
}

int DetectorCount::estimate(const std::string& channel) const {
  int maximum = 1;
  const auto camera = cameras_.find(channel);
  if (camera == cameras_.end()) return maximum;
  for (const Frame& frame : camera->second.frames) maximum = std::max(maximum, frame.results);
  return maximum;
}

}  // namespace houghstream
