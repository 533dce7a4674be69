#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/object_pose.hpp"
#include "pose/model/object_model.hpp"
#include "pose/pose_settings.hpp"
#include "pose/registration/rotation_clusters.hpp"

namespace houghstream {

/// A place to start registration from.
struct PoseCandidate {
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  float score = 0.0F;  ///< DepthScore::value; 0 for poses of an earlier frame, which are not chosen by it
};

/// Tries each rotation at places about the detected centre, moved along the line of sight onto the measured surface;
/// gives the best place of each rotation, best first, at most SearchSettings::keep.
std::vector<PoseCandidate> place_candidates(const RgbdFrame& frame, const ObjectModel& model,
                                            const Eigen::Vector3f& centre_camera,
                                            const std::vector<RotationCandidate>& rotations,
                                            const PoseSettings& settings);

/// What an earlier frame's poses add: those of the class that lie near the detected centre, as they were then. None of
/// a frame that is later than `utime` or too long before it.
std::vector<PoseCandidate> earlier_candidates(std::int64_t utime, const Detection& detection,
                                              const ObjectPoses& earlier, const WarmStartSettings& settings);

}  // namespace houghstream
