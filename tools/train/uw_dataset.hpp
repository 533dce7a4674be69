#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/types/training_view.hpp"

namespace houghstream {

/// Instances to read, with the class names that they teach.
struct UwSelection {
  /// "can_1", or "can_1=can" for an instance that teaches another class name; empty = all that are there.
  std::vector<std::string> instances;
  /// Class of an instance: its own name, or its category where `by_category` ("can_1" and "can_2" teach "can").
  bool by_category = false;
};

/// Reads training views in the layout of the UW RGB-D Object Dataset (Lai et al. 2011):
/// CATEGORY/INSTANCE/INSTANCE_V_N_{crop,depthcrop,maskcrop}.png and _loc.txt. Views are the crops. Classes are numbered
/// from 1 in the order of their names. The dataset publishes no camera and no pose: `camera` is that of the whole
/// image; each video V is taken as one full turn of a turntable, evenly spread over its frame numbers N, and
/// T_camera_object comes from estimate_turntable() (tools/train/turntable.hpp): origin on the axis at half the object's
/// height, z up, one frame for all views of a video, `object_frame` INSTANCE_V. Views without mask pixels or without
/// depth on them are left out with a warning. Throws InputError on missing or disagreeing files, and where no view of
/// an instance is left.
std::vector<TrainingView> read_uw_training_views(const std::filesystem::path& folder, const UwSelection& selection,
                                                 const Camera& camera);

/// Reads background frames: NAME_color.png or NAME.png with NAME_depth.png (uint16 millimetres) in `folder` and below
/// it, as in the UW RGB-D Scenes Dataset's background/background_K/background_K_N.png, in natural order. Throws
/// InputError where they are missing or their sizes disagree with the camera.
std::vector<TrainingView> read_background_views(const std::filesystem::path& folder, const Camera& camera);

}  // namespace houghstream
