#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "drivers/datasets/bop_dataset.hpp"

// Ground truth of an object from hs-render takes, and its reconstruction by hs-teach show --keep.

namespace houghstream::studies {

/// Holds both takes of one object with their ground truth.
struct TrueTakes {
  int object_id = 0;
  std::vector<BopScene> scenes;  ///< scenes in the order of their takes
  Mesh mesh;                     ///< true, metres
};

/// Reads FOLDER/takes.json, the object's scenes and FOLDER/models/. Throws InputError where it is not among them.
TrueTakes read_true_takes(const std::filesystem::path& folder, const std::string& object);

/// Returns the object's ground truth in a frame, or nothing where hardly any of it is visible.
const GroundTruthObject* ground_truth_object(const TrueTakes& takes, std::size_t scene, std::size_t frame);

/// A pose that was estimated of a frame of a take.
struct ShownPose {
  std::size_t scene = 0;  ///< index in TrueTakes::scenes
  std::size_t frame = 0;
  Eigen::Isometry3d T_camera_taught = Eigen::Isometry3d::Identity();  ///< metres
};

/// Reads the rows of KEPT/camera_poses.csv that were tracked: frame, utime, tracked, twelve numbers of the
/// object-to-camera matrix row by row, metres; of the first take. Throws InputError naming file and line.
std::vector<ShownPose> read_camera_poses(const std::filesystem::path& file);

/// A kept view, found again among the takes' frames by its image.
struct KeptView {
  ShownPose pose;
  double mask_iou = 0.0;  ///< overlap of its mask with the ground truth
};

/// Reads the views of KEPT/views/; those whose image is in none of the takes are left out.
std::vector<KeptView> read_kept_views(const std::filesystem::path& folder, const TrueTakes& takes);

}  // namespace houghstream::studies
