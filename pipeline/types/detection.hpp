#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "pipeline/types/frame_id.hpp"
#include "pipeline/types/stage_time.hpp"

namespace houghstream {

/// Holds the rotation that a supporting vote stores of its training view, rotated to the ray along which it was seen.
struct RotationVote {
  Eigen::Quaternionf R_camera_object = Eigen::Quaternionf::Identity();
  float weight = 0.0F;
};

/// Describes one object found in a frame.
struct Detection {
  int class_id = 0;  ///< 1 or more; 0 is no class
  std::string class_name;
  float score = 0.0F;                                       ///< probability that the object is there, 0 to 1
  bool reported = true;                                     ///< false: a candidate, see object_pose.hpp is_reported()
  cv::Rect2f box_px;                                        ///< visible box, pixels of the full-size frame
  Eigen::Vector3f centre_camera = Eigen::Vector3f::Zero();  ///< the point that votes are for, metres; NaN where unknown
  float vote_weight = 0.0F;                                 ///< sum of the supporting votes' weights
  int vote_count = 0;                                       ///< supporting votes before the list was capped
  std::vector<RotationVote> rotations;                      ///< heaviest first, capped
};

/// Detections of one detector in one frame, strongest first.
struct Detections {
  FrameId frame;  ///< frame in which they were found
  std::vector<Detection> detections;
  std::vector<StageTime> stages;
};

/// Returns the intersection over union of two boxes; 0 where either is empty.
float box_iou(const cv::Rect2f& a, const cv::Rect2f& b);

}  // namespace houghstream
