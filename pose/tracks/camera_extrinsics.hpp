#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace houghstream::tracks {

/// Gives the pose of a camera at a time, or the reason why it is not known.
struct CameraPose {
  std::optional<Eigen::Isometry3d> T_world_camera;
  bool may_come = false;  ///< true if a later transform may determine it
  std::string reason;     ///< reason why it is unknown, one line
};

/// Stores the poses of cameras: static ones as they were set, moving ones interpolated between the transforms before
/// and after a time. Names of cameras are the channels of their frames, or the part before _TO_WORLD
/// (channel::camera_name). Not thread-safe.
class CameraExtrinsics {
 public:
  /// Maximum gap between transforms that are interpolated, unless they are equal.
  static constexpr double kMaxGapS = 0.5;
  /// Maximum number of moving cameras; further ones are refused, since an untrusted sender may make up channels without
  /// end.
  static constexpr std::size_t kMaxMoving = 256;

  void set_static(const std::string& camera, const Eigen::Isometry3d& T_world_camera);

  /// Adds a transform of a camera that moves. One that is older than the last one by more than a second starts over.
  /// Throws InputError for one camera too many.
  void add_transform(const std::string& camera, std::int64_t utime, const Eigen::Isometry3d& T_world_camera);

  /// Returns whether any camera has extrinsics.
  bool any() const { return !static_.empty() || !moving_.empty(); }

  /// Interpolates the pose at exactly that time; a camera that was at rest in its last two transforms is taken to be at
  /// rest still.
  CameraPose interpolate(const std::string& camera, std::int64_t utime) const;

 private:
  struct Sample {
    std::int64_t utime = 0;
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  };
  std::map<std::string, Eigen::Isometry3d> static_;
  std::map<std::string, std::deque<Sample>> moving_;  // samples by camera, in the order of time
};

/// Reads the poses of static cameras, T_world_camera by name, from a YAML file. It understands our own format,
///
///     cameras:
///       LEFT: {parent: world, translation: [x, y, z], rotation: [w, x, y, z]}
///
/// where `parent` may be another camera, and defaults to the world. It also understands static transforms of ROS, as
/// `ros2 topic echo /tf_static` prints them: entries of `transforms` with header.frame_id, child_frame_id and
/// transform, chained to the root frame, which is the world. Metres. Throws InputError naming file and camera for what
/// is missing, not rigid, part of a loop, of an unknown name, or a duplicate.
std::map<std::string, Eigen::Isometry3d> read_camera_extrinsics(const std::filesystem::path& file);

/// Parses the value of an option --camera-pose: CHANNEL=x,y,z,qw,qx,qy,qz, T_world_camera. Throws InputError.
std::pair<std::string, Eigen::Isometry3d> parse_camera_pose(const std::string& text);

/// Adds such a value to the poses. Throws InputError also where its camera has one already.
void add_camera_pose(const std::string& text, std::map<std::string, Eigen::Isometry3d>& poses);

}  // namespace houghstream::tracks
