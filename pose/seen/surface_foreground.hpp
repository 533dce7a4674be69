#pragma once

#include <opencv2/core.hpp>

#include "pipeline/types/plane.hpp"

namespace houghstream {

/// What lies on a plane and has another colour than the plane: where depth hardly tells a thin object from the table
/// under it.
struct SurfaceForeground {
  Plane plane;          ///< camera frame, metres; its normal points towards the camera
  cv::Point origin_px;  ///< first pixel of `evidence` in the frame
  /// CV_32FC1, from -1, where the plane's colour is observed, or what does not lie on the plane, to 1.
  cv::Mat evidence;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< centre of the foreground about the detection, on the plane
};

}  // namespace houghstream
