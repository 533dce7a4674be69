#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/process/detector_count.hpp"
#include "tools/foxglove/foxglove_messages.hpp"

namespace houghstream::view {

/// Makes Foxglove's messages of a stream as it goes on: images at once, the objects of a frame as soon as all its
/// detectors and hs-pose have answered, or, of followed objects, with the first poses of the frame. Objects of a frame
/// that is older than one already shown are passed over. Not thread-safe.
class LiveConversion {
 public:
  using Messages = std::vector<foxglove::FoxgloveMessage>;

  /// Cameras whose frames and results are shown; further ones are passed over. A sender of rubbish may make up cameras.
  static constexpr std::size_t kMaxCameras = 64;

  /// `camera` are the intrinsics of frames that carry none.
  explicit LiveConversion(const std::optional<Camera>& camera);

  void set_models(const std::map<std::string, Mesh>& models) { messages_.set_models(models); }

  /// These throw InputError where the message cannot be understood.
  Messages add_frame(const images_t& frame, const std::string& channel);
  Messages add_detections(Detections detections);
  Messages add_poses(ObjectPoses poses);
  Messages add_world(const WorldObjects& world);
  Messages add_camera_pose(const std::string& channel, std::int64_t utime, const Eigen::Isometry3d& T_world_camera) {
    return messages_.convert_camera_pose(channel, utime, T_world_camera);
  }
  /// Keeps the room that objects take up until their world comes.
  void add_placements(ObjectPlacements placed) { placed_ = std::move(placed); }

 private:
  bool admit_camera(const std::string& channel);
  FrameResults* results_of(const FrameId& frame);
  bool is_complete(const FrameId& frame, const FrameResults& results) const;
  Messages show(const FrameId& frame, const FrameResults& results);

  foxglove::FoxgloveMessages messages_;
  std::optional<Camera> camera_;
  std::optional<ObjectPlacements> placed_;
  DetectorCount detectors_;
  std::map<FrameId, FrameResults> results_;    // of the last frames
  std::map<std::string, std::int64_t> shown_;  // time of the last frame whose objects were shown, by camera
  int unanswered_ = 0;                         // detections since the last poses
};

}  // namespace houghstream::view
