#include "pose/tracks/world_clock.hpp"

#include <algorithm>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"

namespace houghstream::tracks {

TimeOrder WorldClock::order_of(const FrameId& frame, std::int64_t newest_utime) {
  constexpr double kBackS = 1.0;
  constexpr int kGone = 30;
  if (seconds_between(newest_utime, frame.utime) > kBackS) return TimeOrder::kLate;
  const auto camera = cameras_.find(frame.channel);
  if (camera != cameras_.end()) {
    const std::int64_t last_utime = camera->second.utime;
    if (seconds_between(newest_utime, last_utime) > kBackS) {
      tell_new_world(frame, last_utime);
      return TimeOrder::kAnew;
    }
    if (frame.utime < last_utime) return TimeOrder::kLate;
  }
  if (!newest_ || seconds_between(frame.utime, newest_->utime) <= kBackS) return TimeOrder::kNext;
  ++behind_;
  require(
      behind_ >= kGone,
      "frame {} is {:.1f} s older than the last one of {}, expected cameras whose clocks, and results, are within {} "
      "s of one another",
      to_string(frame), seconds_between(frame.utime, newest_->utime), newest_->channel, kBackS);
  tell_new_world(frame, newest_->utime);
  return TimeOrder::kAnew;
}

CameraClock& WorldClock::set(const FrameId& frame) {
  constexpr double kUsualS = 1.0 / 30.0;
  constexpr double kMostS = 0.1;
  behind_ = 0;
  if (!newest_ || frame.utime > newest_->utime) newest_ = frame;
  CameraClock& clock = cameras_[frame.channel];
  const double seconds = clock.results == 0 ? kUsualS : std::min(kMostS, seconds_between(clock.utime, frame.utime));
  if (clock.results == 0 || frame.utime != clock.utime) clock = {frame.utime, 0, seconds, {}, {}};
  ++clock.results;
  return clock;
}

void WorldClock::begin_world() {
  cameras_.clear();
  newest_.reset();
  behind_ = 0;
}

void WorldClock::tell_new_world(const FrameId& frame, std::int64_t last_utime) {
  const std::string line = fmt::format("frame {} is {:.1f} s older than the last one: a new world begins",
                                       to_string(frame), seconds_between(frame.utime, last_utime));
  const auto admitted = lines_.admit("world", line, LimitedLines::Clock::now());
  if (admitted) log_warning("{}", *admitted);
}

}  // namespace houghstream::tracks
