#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <optional>

namespace houghstream {

struct ObjectObservation;
struct ProjectedView;

/// What lies on a plane and has another colour than the plane: where depth hardly tells a thin object from the table
/// under it.
struct SurfaceForeground {
  Eigen::Hyperplane<double, 3> plane;  ///< camera frame, metres; its normal points towards the camera
  cv::Point origin_px;                 ///< first pixel of `evidence` in the frame
  /// CV_32FC1, from -1, where the plane's colour is observed, or what does not lie on the plane, to 1.
  cv::Mat evidence;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< centre of the foreground about the detection, on the plane

  /// Returns the mean evidence of a view's points, -1 to 1; points beside `evidence` count -1.
  float mean_at(const ProjectedView& projected) const;
};

/// Finds the plane in the observed region, the plane's colours at the region's edge, and what differs from them and is
/// no higher above the plane than the model is thick. Returns nothing where less than half of the region is one plane,
/// or where nothing differs.
std::optional<SurfaceForeground> find_surface_foreground(const ObjectObservation& observation);

}  // namespace houghstream
