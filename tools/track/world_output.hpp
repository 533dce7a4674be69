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
  bool pose_channels = false;                         ///< a pose_t of each object on a channel of its own
};

/// Makes bot_core's pose of an object of the world, whose axes are those of its local frame.
pose_t pose_message(const TrackedObject& object, std::int64_t utime);

/// Publishes the objects_t after each frame and what the options ask for. Not thread-safe.
class WorldOutput {
 public:
  /// The bus must outlive this.
  WorldOutput(LcmBus& bus, const WorldOutputOptions& options);

  /// Replaces the classes' models.
  void set_models(const tracks::TrackModels& models);

  void publish(const WorldObjects& world);

 private:
  LcmBus& bus_;
  bool pose_channels_;
  std::optional<DrakeScene> drake_;
};

}  // namespace houghstream::track
