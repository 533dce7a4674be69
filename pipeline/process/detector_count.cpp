#include "pipeline/process/detector_count.hpp"

#include <algorithm>

namespace houghstream {

void DetectorCount::note_result(const FrameId& frame) {
  constexpr std::size_t kFrames = 16;
  if (cameras_.size() >= kCameras && cameras_.count(frame.channel) == 0) return;
  std::deque<Frame>& frames = cameras_[frame.channel];
  const auto known = std::find_if(frames.begin(), frames.end(), [&](const Frame& f) { return f.utime == frame.utime; });
  if (known != frames.end()) {
    ++known->results;
    return;
  }
  frames.push_back({frame.utime, 1});
  if (frames.size() > kFrames) frames.pop_front();
}

void DetectorCount::forget(const FrameId& frame) {
  const auto camera = cameras_.find(frame.channel);
  if (camera == cameras_.end()) return;
  std::deque<Frame>& frames = camera->second;
  frames.erase(std::remove_if(frames.begin(), frames.end(), [&](const Frame& f) { return f.utime == frame.utime; }),
               frames.end());
}

int DetectorCount::of(const std::string& channel) const {
  int most = 1;
  const auto camera = cameras_.find(channel);
  if (camera == cameras_.end()) return most;
  for (const Frame& frame : camera->second) most = std::max(most, frame.results);
  return most;
}

}  // namespace houghstream
