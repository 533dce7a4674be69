#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/types/teaching.hpp"
#include "tools/teach/show/show_progress.hpp"

namespace houghstream::teach {

/// Converts the progress for the bus; `directions` are those of the viewing sphere.
Teaching teaching_of(const ShowProgress& now, const std::array<Eigen::Vector3d, ShowProgress::kDirections>& directions);

/// Publishes the progress of showing an object as teaching_t: at most ten times a second, each change of state at once,
/// and the last message again each second, by which receivers distinguish long work from a process that has ended.
class TeachingPublisher : public ShowObserver {
 public:
  /// Makes a publisher on `bus`, which must outlive it.
  TeachingPublisher(LcmBus& bus, const std::array<Eigen::Vector3d, ShowProgress::kDirections>& directions);
  ~TeachingPublisher() override;
  TeachingPublisher(const TeachingPublisher&) = delete;
  TeachingPublisher& operator=(const TeachingPublisher&) = delete;

  void progress(const ShowProgress& now) override;

 private:
  using Clock = std::chrono::steady_clock;
  void publish();
  void repeat() noexcept;

  LcmBus& bus_;
  std::array<Eigen::Vector3d, ShowProgress::kDirections> directions_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Teaching> last_;
  bool is_sent_ = true;  // the last one was sent as it is
  Clock::time_point sent_{};
  bool ending_ = false;
  std::thread thread_;
};

/// Decides when a take shows nothing new any more: more than half of the directions were observed, and for some seconds
/// of the frames' time, or half as long as that took, no further one. Steps of that time that lead back, or far ahead,
/// come of a clock that was set or of a wrong stamp, and do not count. Over the last third of a turn no new direction
/// is observed, although the turn has to be completed for the loop to close.
class CoverageCriterion {
 public:
  bool operator()(const ShowProgress& now);

 private:
  int seen_ = 0;
  std::optional<std::int64_t> last_utime_;
  std::int64_t took_us_ = 0;  // time from the first frame to the last one that brought something new
  std::int64_t nothing_new_us_ = 0;
};

}  // namespace houghstream::teach
