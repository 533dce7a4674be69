#include "pose/tracks/world_clock.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/types/frame_time.hpp"

namespace houghstream::tracks {
namespace {

/// Whether the numbers say that the source was started again, or its log: they fall, or are of another run.
bool is_started_again(const FrameNumber& before, const FrameNumber& after) {
  if (before.run != 0 && after.run != 0 && before.run != after.run) return true;
  return before.sequence && after.sequence && *after.sequence < *before.sequence;
}

bool goes_on(const FrameNumber& before, const FrameNumber& after) {
  return before.run == after.run && before.sequence && after.sequence && *after.sequence > *before.sequence;
}

}  // namespace

TimeOrder WorldClock::order_of(const StampedFrame& frame) {
  constexpr int kGone = 30;
  if (seconds_between(frame.newest_utime, frame.id.utime) > kMaxOvertakenS) return TimeOrder::kLate;
  const std::int64_t utime = shifted(frame.id.utime, ahead_us_);
  const auto known = cameras_.find(frame.id.channel);
  if (known != cameras_.end()) {
    const TimeOrder order = order_after(known->second, frame, utime);
    if (order != TimeOrder::kNext) return order;
  } else if (newest_ && order_ahead(newest_->utime, frame, utime) == TimeOrder::kLate) {
    return TimeOrder::kLate;
  }
  const std::int64_t now = shifted(frame.id.utime, ahead_us_);
  if (!newest_ || seconds_between(now, newest_->utime) <= kMaxOvertakenS) return TimeOrder::kNext;
  ++behind_;
  require(
      behind_ >= kGone,
      "frame {} is {:.1f} s older than the last one of {}, expected cameras whose clocks, and results, are within {} "
      "s of one another",
      to_string(frame.id), seconds_between(now, newest_->utime), newest_->channel, kMaxOvertakenS);
  tell_new_world(frame.id, newest_->utime);
  return TimeOrder::kAnew;
}

TimeOrder WorldClock::order_after(const Camera& camera, const StampedFrame& frame, std::int64_t utime) {
  constexpr double kIntervals = 3.0;  // results may come seldom
  const std::int64_t last_utime = camera.clock.utime;
  if (seconds_between(shifted(frame.newest_utime, ahead_us_), last_utime) > kMaxOvertakenS)
    return order_behind(camera, frame, utime);
  const bool other_run = frame.number.run != camera.number.run && frame.number.run != 0 && camera.number.run != 0;
  if (utime <= last_utime && other_run) {
    tell_new_world(frame.id, last_utime);
    return TimeOrder::kAnew;
  }
  if (utime < last_utime) return TimeOrder::kLate;
  const double passed_s = seconds_between(last_utime, utime);
  if (passed_s <= std::max(kMaxOvertakenS, kIntervals * camera.interval_s)) return TimeOrder::kNext;
  return order_ahead(last_utime, frame, utime);
}

/// Of a camera whose frames have gone back.
TimeOrder WorldClock::order_behind(const Camera& camera, const StampedFrame& frame, std::int64_t utime) {
  const std::int64_t last_utime = camera.clock.utime;
  if (!is_started_again(camera.number, frame.number)) {
    const auto doubted = doubted_.find(frame.id.channel);
    const std::int64_t first = doubted == doubted_.end() ? utime : doubted->second;
    if (!is_confirmed(last_utime, frame.id, utime)) return TimeOrder::kLate;
    if (goes_on(camera.number, frame.number)) {
      warn(
          fmt::format("frame {} is {:.1f} s older than the last one, though its number is higher: the camera's clock "
                      "was set back, and the world goes on",
                      to_string(frame.id), seconds_between(utime, last_utime)));
      const std::int64_t apart_us = microseconds_between(std::min(first, utime), std::max(first, utime));
      move_to(shifted(last_utime, 2 * std::min<std::int64_t>(apart_us, 1'000'000)), frame.id);
      return TimeOrder::kNext;
    }
  }
  tell_new_world(frame.id, last_utime);
  return TimeOrder::kAnew;
}

TimeOrder WorldClock::order_ahead(std::int64_t last_utime, const StampedFrame& frame, std::int64_t utime) {
  constexpr std::int64_t kMaxDurationUs = 60'000'000;
  if (seconds_between(last_utime, utime) <= kMaxOvertakenS) return TimeOrder::kNext;
  const bool is_told_by_another = std::abs(seconds_between(newest_->utime, utime)) <= kMaxOvertakenS;
  if (!is_told_by_another && !is_confirmed(last_utime, frame.id, utime)) return TimeOrder::kLate;
  if (microseconds_between(newest_->utime, utime) > kMaxDurationUs)
    move_to(shifted(newest_->utime, kMaxDurationUs), frame.id);
  return TimeOrder::kNext;
}

/// Whether the camera's frame before lay beside this one, far from its last one. Another result of the same frame says
/// nothing.
bool WorldClock::is_confirmed(std::int64_t last_utime, const FrameId& frame, std::int64_t utime) {
  const auto [doubted, is_first] = doubted_.emplace(frame.channel, utime);
  if (is_first || doubted->second == utime) return false;
  const double beside_s = std::abs(seconds_between(doubted->second, utime));
  const bool confirmed = beside_s < std::abs(seconds_between(last_utime, utime));
  doubted->second = utime;
  return confirmed;
}

void WorldClock::move_to(std::int64_t world_utime, const FrameId& frame) {
  ahead_us_ = microseconds_between(frame.utime, world_utime);
}

CameraClock& WorldClock::set(const StampedFrame& frame) {
  constexpr double kUsualS = 1.0 / 30.0;
  constexpr double kMaxS = 0.1;
  behind_ = 0;
  const FrameId now{frame.id.channel, shifted(frame.id.utime, ahead_us_)};
  doubted_.erase(now.channel);
  if (!newest_ || now.utime > newest_->utime) newest_ = now;
  Camera& camera = cameras_[now.channel];
  CameraClock& clock = camera.clock;
  const double passed_s = seconds_between(clock.utime, now.utime);
  const double seconds = clock.results == 0 ? kUsualS : std::min(kMaxS, passed_s);
  if (clock.results > 0 && passed_s > 0.0) camera.interval_s = passed_s;
  if (clock.results == 0 || now.utime != clock.utime) {
    clock = CameraClock();
    clock.utime = now.utime;
    clock.seconds = seconds;
  }
  camera.number = frame.number;
  ++clock.results;
  return clock;
}

void WorldClock::begin_world() {
  cameras_.clear();
  doubted_.clear();
  newest_.reset();
  behind_ = 0;
  ahead_us_ = 0;
}

void WorldClock::tell_new_world(const FrameId& frame, std::int64_t last_utime) {
  warn(fmt::format("frame {} is {:.1f} s older than the last one: a new world begins", to_string(frame),
                   seconds_between(shifted(frame.utime, ahead_us_), last_utime)));
}

void WorldClock::warn(const std::string& line) {
  const auto admitted = lines_.admit("world", line, LogThrottle::Clock::now());
  if (admitted) log_warning("{}", *admitted);
}

}  // namespace houghstream::tracks
