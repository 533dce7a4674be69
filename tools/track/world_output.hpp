#pragma once

#include <filesystem>
#include <houghstream/pose_t.hpp>
#include <optional>

#include "pipeline/bus/lcm_bus.hpp"
#include "tools/track/drake_scene.hpp"

namespace houghstream::track {

/// Messages for third-party tools, published beside the objects_t.
struct WorldOutputOptions {
  std::optional<std::filesystem::path> drake_meshes;  ///< folder of meshes for Drake; none = no messages
  bool pose_channels = false;  ///< a pose_t of each object, and of each of its named frames, on channels of their own
};

/// Makes bot_core's pose of an object of the world, whose axes are those of its local frame.
pose_t pose_message(const TrackedObject& object, std::int64_t utime);

/// Makes the pose of a frame that is named on the object and moves with it.
pose_t frame_pose_message(const TrackedObject& object, const PlacedObjectFrame& frame, std::int64_t utime);

/// Publishes the objects_t after each frame, before it their boxes and named frames where models are known, and what
/// the options ask for. Not thread-safe.
class WorldOutput {
 public:
  /// The bus must outlive this.
  WorldOutput(LcmBus& bus, const WorldOutputOptions& options);

  /// Replaces the classes' models.
  void set_models(const tracks::TrackModels& models);

  /// `placed` are those of the world. They go out where any model is known.
  void publish(const WorldObjects& world, const ObjectPlacements& placed);

 private:
  void publish_poses(const WorldObjects& world, const ObjectPlacements& placed);

  LcmBus& bus_;
  bool pose_channels_;
  bool has_models_ = false;
  std::optional<DrakeScene> drake_;
};

}  // namespace houghstream::track
