#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <deque>
#include <opencv2/core.hpp>
#include <vector>

#include "pose/reconstruction/map/frame_levels.hpp"
#include "pose/reconstruction/map/landmarks.hpp"
#include "pose/reconstruction/tracking/take.hpp"

namespace houghstream::reconstruction {

/// Classifies the motion in a take by comparing each frame with the first one: either the camera moves, or the object
/// moves before a static camera. The camera is static as long as the corners of the surroundings are where they were at
/// first; where there are few, as long as the surroundings look as they did then rather than as a moved camera would
/// see them. The object moves where it alone looks different.
class MotionClassifier {
 public:
  MotionClassifier() = default;
  /// `levels` are of the first frame; `on_object` is CV_8UC1, as large as the finest, and not 0 where the object is.
  /// `min_landmarks` is the minimum in common with the first frame that decides whether the camera is static.
  MotionClassifier(FlowFrame first, const FrameLevels& levels, const cv::Mat& on_object,
                   const Eigen::Isometry3d& T_camera_world, std::size_t min_landmarks);

  const FlowFrame& first() const { return first_; }

  /// Classifies the next frame, given the pose that a moved camera would have. Where the camera is static, the pose
  /// becomes the first frame's. Returns kUnknown until three consecutive frames agree.
  Motion classify(const FlowFrame& now, const FrameLevels& levels, Eigen::Isometry3d& T_camera_world);

  /// Returns the number of consecutive frames in which the object moved, the last one included.
  int moving_object_frames() const { return moving_object_frames_; }

 private:
  bool is_camera_static(const FlowFrame& now, const FrameLevels& levels, const Eigen::Isometry3d& T_moved) const;

  FlowFrame first_;
  cv::Mat first_intensity_, object_mask_, background_mask_;  ///< masks and intensity of its finest level
  Eigen::Isometry3d T_first_ = Eigen::Isometry3d::Identity();
  std::size_t min_landmarks_ = 0;
  std::vector<cv::Point2f> corners_;  ///< corners of the first frame, away from the object
  LevelPoints surroundings_;          ///< points away from the object, world frame
  int moving_object_frames_ = 0;
  int moving_camera_frames_ = 0;
};

/// Intensities of the last frames of a static camera, while the object turns.
class StaticShadingDetector {
 public:
  /// Shading and highlights stay in place while the object turns: pixels that are unchanged since some frames ago do
  /// not constrain the rotation, unless all pixels are and the object rests. Marks them in the next frame's levels
  /// (FrameLevel::static_mask). `on_object`: as for MotionClassifier.
  void mark_static_intensity(const cv::Mat& on_object, FrameLevels& levels);

 private:
  std::deque<std::vector<cv::Mat>> intensities_;  ///< intensities by level, the oldest frame first
};

}  // namespace houghstream::reconstruction
