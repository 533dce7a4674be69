#include "tools/teach/show/show_progress.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace houghstream::teach {
ProgressReporter::ProgressReporter(const std::string& name, ShowObserver* observer) : observer_(observer) {
  now_.name = name;
}

void ProgressReporter::frame(const FrameId& id, const reconstruction::TakeMapperStatus& state) {
  using reconstruction::TakeMapperState;
  now_.frame = id;
  now_.state = state.state == TakeMapperState::kTracking ? TeachingState::kTracking
               : state.state == TakeMapperState::kLost   ? TeachingState::kLost
                                                         : TeachingState::kChoosing;
  now_.message = state.message;
  now_.seen = state.seen;
  now_.frames = state.frames;
  now_.keyframes = state.keyframes;
  now_.box = state.box_px;
  now_.T_camera_object = state.T_camera_object;
  now_.progress = static_cast<double>(reconstruction::count_covered(state.seen)) / ShowProgress::kDirections;
  report();
}

void ProgressReporter::step(TeachingState state, double progress, const std::string& message) {
  now_.state = state;
  now_.progress = progress;
  now_.message = message;
  now_.box = {};
  now_.T_camera_object.reset();
  printed_us_ = 0;
  report();
}

void ProgressReporter::fail(const std::string& message) {
  now_.state = TeachingState::kFailed;
  now_.message = message;
  if (observer_ != nullptr) observer_->progress(now_);
}

void ProgressReporter::report() {
  constexpr std::int64_t kApart_us = 1'000'000;  // interval of the take's time
  const std::string line = fmt::format("{}: {}", to_string(now_.state), now_.message);
  const bool is_choice = printed_state_ == TeachingState::kChoosing && now_.state != TeachingState::kChoosing;
  const std::int64_t since_us = microseconds_between(printed_us_, now_.frame.utime);
  const bool soon = printed_us_ != 0 && !is_choice && since_us > -kApart_us && since_us < kApart_us;
  if (line != printed_ && !soon) {
    fmt::print(stderr, "hs-teach: {}\n", line);
    printed_ = line;
    printed_us_ = now_.frame.utime;
    printed_state_ = now_.state;
  }
  if (observer_ != nullptr) observer_->progress(now_);
}

}  // namespace houghstream::teach
