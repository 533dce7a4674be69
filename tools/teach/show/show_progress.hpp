#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "pipeline/types/frame_id.hpp"
#include "pipeline/types/teaching.hpp"
#include "pose/reconstruction/tracking/take_mapper.hpp"

namespace houghstream::teach {

/// Progress of showing an object: after each frame, and during fusion and teaching.
struct ShowProgress {
  /// Directions of a sphere about the object: reconstruction::view_directions().
  static constexpr int kDirections = 60;

  FrameId frame;     ///< last frame that was processed
  std::string name;  ///< name of the object
  TeachingState state = TeachingState::kChoosing;
  std::string message;                   ///< one line for a person: what was observed, what is missing, why it failed
  std::array<bool, kDirections> seen{};  ///< directions of the object's frame that were observed
  int frames = 0;                        ///< number of frames processed so far
  int keyframes = 0;                     ///< number of keyframes kept so far
  cv::Rect box;                          ///< box of the object in the last frame, pixels; empty where it is not known
  double progress = 0.0;                 ///< 0 to 1: of the sphere while tracking, of the work afterwards
  std::optional<Eigen::Isometry3d> T_camera_object;  ///< metres, z up, origin at its foot; none while it is not known
};

/// Receives the progress of a showing, in the thread that processes it. An exception ends the showing.
struct ShowObserver {
  virtual ~ShowObserver() = default;
  virtual void progress(const ShowProgress& now) = 0;
};

/// Reports the progress of a showing to the observer and, where something is new, to the terminal. Not thread-safe.
class ProgressReporter {
 public:
  /// Reports on the object `name`. `observer` may be null.
  ProgressReporter(const std::string& name, ShowObserver* observer);

  /// Reports a frame of the take.
  void frame(const FrameId& id, const reconstruction::TakeMapperStatus& state);

  /// Reports a step after the takes; `progress` of all work, 0 to 1.
  void step(TeachingState state, double progress, const std::string& message);

  /// Reports a failure; the terminal gets the exception's line itself.
  void fail(const std::string& message);

 private:
  void report();

  ShowObserver* observer_;
  ShowProgress now_;
  std::string printed_;
  TeachingState printed_state_ = TeachingState::kChoosing;
  std::int64_t printed_us_ = 0;
};

}  // namespace houghstream::teach
