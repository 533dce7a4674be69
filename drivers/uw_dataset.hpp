#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/training_view.hpp"

namespace houghstream {

/// Which instances to read and what they are called.
struct UwSelection {
  std::vector<std::string> instances;  ///< for instance "can_1"; empty = all that are there
  /// Class of an instance: its own name, or its category where `by_category` ("can_1" and "can_2" teach "can").
  bool by_category = false;
};

/// Training views in the layout of the UW RGB-D Object Dataset (Lai et al. 2011):
/// CATEGORY/INSTANCE/INSTANCE_V_N_{crop,depthcrop,maskcrop}.png and _loc.txt. The dataset publishes no camera and no
/// pose: `camera` is that of the whole image; T_camera_object has the centre of the masked points, moved back
/// by half the object's extent along the ray, as origin, and a rotation from the turntable's yaw. Views without
/// depth on the object are skipped with a warning.
std::vector<TrainingView> read_uw_training_views(const std::filesystem::path& folder, const UwSelection& selection,
                                                 const Camera& camera);

/// Background frames: NAME_color.png or NAME.png with NAME_depth.png (uint16 millimetres).
std::vector<TrainingView> read_background_views(const std::filesystem::path& folder, const Camera& camera);

}  // namespace houghstream
