#include "tools/teach/show/teaching_publisher.hpp"

#include <algorithm>
#include <utility>

#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"

namespace houghstream::teach {
namespace {

constexpr std::chrono::milliseconds kApart(100);
constexpr std::chrono::milliseconds kRepeat(1000);

}  // namespace

Teaching teaching_of(const ShowProgress& now,
                     const std::array<Eigen::Vector3d, ShowProgress::kDirections>& directions) {
  Teaching teaching;
  teaching.frame = now.frame;
  teaching.name = now.name;
  teaching.state = now.state;
  teaching.message = now.message;
  teaching.progress = static_cast<float>(std::clamp(now.progress, 0.0, 1.0));
  teaching.frames = now.frames;
  teaching.keyframes = now.keyframes;
  if (!now.box.empty()) teaching.box_px = now.box;
  teaching.T_camera_object = now.T_camera_object;
  for (std::size_t i = 0; i < directions.size(); ++i)
    teaching.directions.push_back({directions[i].cast<float>().normalized(), now.seen[i]});
  return teaching;
}

TeachingPublisher::TeachingPublisher(LcmBus& bus,
                                     const std::array<Eigen::Vector3d, ShowProgress::kDirections>& directions)
    : bus_(bus), directions_(directions) {
  const BlockStopSignals block;
  thread_ = std::thread([this] { repeat(); });
}

TeachingPublisher::~TeachingPublisher() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void TeachingPublisher::progress(const ShowProgress& now) {
  Teaching teaching = teaching_of(now, directions_);
  const std::lock_guard lock(mutex_);
  const bool is_new = !last_ || last_->state != teaching.state;
  last_ = std::move(teaching);
  is_sent_ = false;
  if (is_new || Clock::now() - sent_ >= kApart) publish();
}

void TeachingPublisher::publish() {
  bus_.publish(channel::kTeaching, to_message(*last_));
  is_sent_ = true;
  sent_ = Clock::now();
}

void TeachingPublisher::repeat() noexcept {
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, kApart, [this] { return ending_; })) {
    if (!last_ || Clock::now() - sent_ < (is_sent_ ? kRepeat : kApart)) continue;
    try {
      publish();
    } catch (const std::exception& error) {
      log_warning("{}", error.what());
    }
  }
}

bool CoverageCriterion::operator()(const ShowProgress& now) {
  constexpr std::int64_t kMin_us = 6'000'000;
  constexpr std::int64_t kMaxStep_us = 10'000'000;
  const std::int64_t step_us = last_utime_ ? microseconds_between(*last_utime_, now.frame.utime) : 0;
  last_utime_ = now.frame.utime;
  if (step_us > 0 && step_us <= kMaxStep_us) nothing_new_us_ += step_us;
  const int seen = static_cast<int>(std::count(now.seen.begin(), now.seen.end(), true));
  if (seen != seen_) took_us_ += std::exchange(nothing_new_us_, 0);
  seen_ = seen;
  return 2 * seen > ShowProgress::kDirections && nothing_new_us_ > std::max(kMin_us, took_us_ / 2);
}

}  // namespace houghstream::teach
