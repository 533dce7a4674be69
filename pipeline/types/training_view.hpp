#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "pipeline/types/frame.hpp"
#include "pipeline/types/plane.hpp"

namespace houghstream {

/// Holds one image of one object to be taught, or of the background without the objects: a training folder yields it
/// and the trainer takes it.
struct TrainingView {
  RgbdFrame frame;         ///< whole image or a crop of it (then frame.camera is the crop's)
  cv::Mat mask;            ///< CV_8UC1, 255 on the object, size of the frame; empty in a background frame
  int class_id = 0;        ///< 1 or more; 0 = background
  std::string class_name;  ///< empty in a background frame
  /// Metres, unused for background; votes are for its origin.
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  /// Plane on which the object stands, camera frame, metres, its normal towards the object; nothing where it stands on
  /// none or none is known.
  std::optional<Plane> support;
  std::string source;        ///< file it came from, for messages
  std::string object_frame;  ///< views of one class whose T_camera_object mean the same frame have equal names here
};

}  // namespace houghstream
