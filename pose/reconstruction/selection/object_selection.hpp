#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "pipeline/types/frame.hpp"
#include "pose/reconstruction/selection/support_planes.hpp"

namespace houghstream::reconstruction {

/// Describes the selected object.
struct SelectedObject {
  Plane plane{Eigen::Vector3d::UnitZ(), 0.0};  ///< plane on which it stands
  /// Stand: the frame whose origin is on the plane below the object's middle, z up.
  Eigen::Isometry3d T_camera_stand = Eigen::Isometry3d::Identity();
  double radius_m = 0.0;          ///< radius of its visible part about that axis
  double height_m = 0.0;          ///< above the plane
  cv::Mat mask;                   ///< CV_8UC1, 255 on it, size of the frame
  cv::Rect box_px;                ///< bounding box of the mask
  bool is_skin_coloured = false;  ///< true if its colour does not distinguish it from a hand
  bool has_given_box = false;     ///< a person has drawn its box: parts that touch it beyond do not belong to it
};

/// The selected object, or the reason why there is none.
struct ObjectSelection {
  std::optional<SelectedObject> object;
  std::string reason;  ///< empty with an object
};

struct SelectionSettings {
  std::optional<cv::Rect> box_px;  ///< about the object; none: what is nearest to at_px
  std::optional<cv::Point> at_px;  ///< pixel on the object or near it; none: the image's middle
  double min_m = 0.012;            ///< sides of an object
  double max_m = 0.6;
  double max_distance_m = 2.0;  ///< maximum distance from the camera
  /// Fraction of the image's width: maximum distance from its middle or from at_px, without a box.
  double max_fraction = 0.25;
  std::uint64_t seed = 1;
};

/// Returns the pixels with a colour of skin, CV_8UC1 (Chai & Ngan, "Face segmentation using skin-color map", 1999).
cv::Mat skin_pixels(const cv::Mat& colour);

/// Returns the rectangle about a projected box, which may exceed the image; none where a corner is nearer than 5 cm.
std::optional<cv::Rect> project_box(const Eigen::AlignedBox3d& box, const Camera& camera,
                                    const Eigen::Isometry3d& T_camera_box);

/// Selects the cluster of points above the dominant plane that is nearest to the image's centre, to a given pixel, or
/// in the box. Planes are tried in order until one supports a cluster.
ObjectSelection select_object(const RgbdFrame& frame, const SelectionSettings& settings);

/// Describes the selected object for a person: its position in the image, and its size.
std::string describe_selection(const SelectedObject& object);

}  // namespace houghstream::reconstruction
