#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/geometry/symmetry.hpp"

namespace houghstream {

/// A pose of one frame by other means, to be compared with.
struct ReferencePose {
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();  ///< metres
  bool reliable = false;                                              ///< as its author states
};

/// Reads poses by frame name from {"poses": [{"frame": NAME, "R_m2c": [3][3], "t_m2c_mm": [3], "reliable": BOOL}]},
/// where x_camera = R x_object + t. Throws InputError when the file is missing or unreadable, or R is no rotation.
std::map<std::string, ReferencePose> read_reference_poses(const std::filesystem::path& file);

/// Holds the difference of two poses of one object.
struct PoseDifference {
  double shift_m = 0.0;  ///< distance between the positions of the object frame's origin
  double angle_deg = 0.0;
};

/// Returns the pose equivalent to `T_estimated` by symmetry whose rotation is nearest to the reference. The object
/// frame's origin should lie in the object: far from it, a small rotation becomes a large translation.
PoseDifference compare_poses(const Eigen::Isometry3d& T_estimated, const Eigen::Isometry3d& T_reference,
                             const Symmetries& symmetries);

/// Holds one frame with a reference.
struct ComparedFrame {
  std::string frame;
  bool reliable = false;
  std::string outcome;                       ///< "not detected", or the words of a PoseStatus
  std::optional<PoseDifference> difference;  ///< nothing without a pose
};

/// Summarises the frames with a reliable reference.
struct AgreementSummary {
  int frames = 0;
  int with_pose = 0;
  int within_5mm_5deg = 0;
  std::optional<PoseDifference> median;  ///< median of each, over those with a pose; nothing without any
};
AgreementSummary summarise(const std::vector<ComparedFrame>& frames);

}  // namespace houghstream
