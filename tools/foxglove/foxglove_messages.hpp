#pragma once

#include <cstdint>
#include <houghstream/images_t.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/camera.hpp"
#include "pipeline/types/placed_objects.hpp"
#include "pipeline/types/reported_objects.hpp"
#include "pipeline/types/tracked_object.hpp"

namespace houghstream::foxglove {

/// A message as Foxglove and Rerun read it, whatever carries it: a file or a WebSocket.
struct FoxgloveMessage {
  std::string topic;
  std::string type;        ///< full name of its message type, for instance "foxglove.RawImage"
  std::int64_t utime = 0;  ///< time of what it shows, microseconds since the epoch
  std::string data;        ///< encoded by ProtobufMessage
};

/// Makes Foxglove's messages of what the stream publishes. Coordinate frames: a camera's is its channel; an object's is
/// CAMERA/CLASS of a frame's pose (CAMERA/CLASS_2 for the second one of a class), and CLASS_NUMBER of hs-track's.
/// Topics:
///
/// - /CAMERA/colour, /CAMERA/depth, /CAMERA/calibration, /CAMERA/annotations: image, depth in millimetres, intrinsics,
///   and the boxes, names and scores of its objects
/// - /transforms: where objects, named frames on them and cameras are
/// - /CAMERA/objects/CLASS and /objects/CLASS_NUMBER: the model of one object, in its own frame, which the transforms
///   move: sent when the object appears, and deleted when it is gone
///
/// Not thread-safe.
class FoxgloveMessages {
 public:
  /// `models` are the classes' meshes, metres. A class without one is shown by its name, and of hs-track by its box.
  explicit FoxgloveMessages(const std::map<std::string, Mesh>& models);

  /// Replaces the models; what is shown already keeps the one that it was sent with.
  void set_models(const std::map<std::string, Mesh>& models);

  /// Converts a frame. Compressed colour stays as it is, raw colour becomes JPEG. Intrinsics are its own, else
  /// `fallback_camera`; without any there is no calibration. Throws InputError where its images cannot be decoded.
  std::vector<FoxgloveMessage> convert_frame(const images_t& frame, const std::string& channel,
                                             const std::optional<Camera>& fallback_camera);

  /// Converts the objects of a frame. The name of an object without a box stands where its origin is in the image, if
  /// the camera is known from a frame before.
  std::vector<FoxgloveMessage> convert_objects(const ReportedObjects& objects);

  /// Converts the world of hs-track. `placed` adds named frames, and the boxes of objects without a model, where it is
  /// of the same frame.
  std::vector<FoxgloveMessage> convert_world(const WorldObjects& world, const std::optional<ObjectPlacements>& placed);

  /// Converts a camera's pose as it is published on <CAMERA>_TO_WORLD. Gives nothing for a camera of which no frame has
  /// come.
  std::vector<FoxgloveMessage> convert_camera_pose(const std::string& channel, std::int64_t utime,
                                                   const Eigen::Isometry3d& T_world_camera) const;

 private:
  /// An object that is to be seen in the scene from now on.
  struct Shown {
    std::string topic;
    std::string frame;
    std::string class_name;
    std::optional<ObjectPlacement> place;
    Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  };
  FoxgloveMessage entity_message(const Shown& object, std::int64_t utime) const;
  void update_scene(const std::string& owner, const std::vector<Shown>& objects, std::int64_t utime,
                    std::vector<FoxgloveMessage>& messages);

  std::map<std::string, std::string> models_;           // binary glTF by class
  std::map<std::string, Camera> cameras_;               // the intrinsics by channel
  std::set<std::string> channels_;                      // the cameras whose frames have come
  std::map<std::string, std::set<std::string>> shown_;  // topics of the objects that are shown, by camera or world
};

}  // namespace houghstream::foxglove
