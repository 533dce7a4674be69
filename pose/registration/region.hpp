#pragma once

#include <opencv2/core.hpp>

#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pose/model/object_model.hpp"
#include "pose/pose_settings.hpp"

namespace houghstream {

/// Where in the depth image a detected object can be: its box, a little enlarged, and a range of depth.
struct DepthRegion {
  cv::Rect box_px;        ///< inside the image, may be empty
  float nearest = 0.0F;   ///< metres
  float farthest = 0.0F;  ///< metres
  int points = 0;         ///< pixels inside with depth in range
};

DepthRegion find_region(const RgbdFrame& frame, const Detection& detection, const ObjectModel& model,
                        const RegionSettings& settings);

/// At most about `most` points of the region, camera frame, metres, evenly over the image.
std::vector<Eigen::Vector3f> region_points(const RgbdFrame& frame, const DepthRegion& region, int most);

}  // namespace houghstream
