#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "pipeline/types/training_view.hpp"

namespace houghstream::fusion {

/// A training view as fusion needs it: the object's surface with its normals, and where the object surely is not. All
/// images have the size of the camera's.
struct DepthView {
  Camera camera;
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();  ///< metres
  cv::Mat colour;                                                     ///< CV_8UC3, BGR
  cv::Mat depth;            ///< CV_32FC1, metres, NaN off the object and where no normal is
  cv::Mat normals;          ///< CV_32FC3, camera frame, unit length, towards the camera; meaningless where depth is NaN
  cv::Mat free_space_mask;  ///< CV_8UC1, 255 where the ray through the pixel misses the object
  /// The whole image that the images are cut out of, in their pixels: beside it nothing is known. None: the cut keeps
  /// away from its edges, and all around it is within.
  std::optional<cv::Rect> image;
  /// Number of the lighting, from 0 on: views of one number have lighting that is static relative to the object; -1:
  /// unknown.
  int lighting_id = -1;

  Eigen::Vector3d normal(const cv::Point& px) const {
    const cv::Vec3f& n = normals.at<cv::Vec3f>(px);
    return {n[0], n[1], n[2]};
  }

  /// Returns the pixel that shows a point of the camera frame; none where that is not in the image.
  std::optional<cv::Point> pixel_of(const Eigen::Vector3d& point_camera) const;

  /// Returns whether the whole image shows a point of the camera frame, even where the cropped images do not.
  bool is_in_image(const Eigen::Vector3d& point_camera) const;
};

/// Normals are those of planes through the pixels around; surface that is seen too flatly, or stands alone, is dropped,
/// as are specks of the mask. Where there is no depth beside the mask, the mask was made of depth and lacks parts of
/// the object: only what is beside its convex hull is outside then.
DepthView make_depth_view(const TrainingView& view);

/// Holds one point of the object's surface.
struct SurfaceSample {
  Eigen::Vector3d point;   ///< camera frame, metres
  Eigen::Vector3d normal;  ///< camera frame, unit length, towards the camera
};

/// Returns at most about `maximum` points of the view, evenly over its pixels.
std::vector<SurfaceSample> sample_view(const DepthView& view, int maximum);

}  // namespace houghstream::fusion
