#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "pipeline/base/settings_fields.hpp"
#include "pipeline/types/brightness.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pose/model/object_model.hpp"
#include "pose/seen/surface_foreground.hpp"

namespace houghstream {

/// Standard deviation of measured depth is base + per_m * z^2: the disparity error of a structured-light camera
/// (Khoshelham & Elberink 2012, 1.4 mm at 1 m) plus the error of registering depth to colour.
struct DepthNoise {
  double base_m = 0.001;
  double per_m = 0.00143;  ///< 1/m
  double sigma(double z) const { return base_m + per_m * z * z; }
};

template <typename Visit>
void fields(const DepthNoise& /*settings*/, const Visit& visit) {
  using S = DepthNoise;
  visit(number("base_m", &S::base_m, 0, 1, "m"));
  visit(number("per_m", &S::per_m, 0, 1, "1/m"));
}

/// Measured and model depth agree when they differ by no more than this.
struct DepthTolerance {
  double base_m = 0.0;
  DepthNoise noise;
  double at(double z) const { return base_m + 3.0 * noise.sigma(z); }
};

/// Settings of the part of the depth image that belongs to a detection.
struct RegionSettings {
  double enlarge = 0.15;        ///< fraction of the box's size, on each side
  double gate_margin_m = 0.06;  ///< depth farther from the centre than the model's radius plus this is not the object
  int min_points = 60;          ///< pixels with depth inside the gate; with fewer there is no pose
  BrightnessRange tone;         ///< the frame's colours are brought into it
};

template <typename Visit>
void fields(const RegionSettings& /*settings*/, const Visit& visit) {
  using S = RegionSettings;
  visit(number("enlarge", &S::enlarge, 0, 10));
  visit(number("gate_margin_m", &S::gate_margin_m, 0, 10, "m"));
  visit(number("min_points", &S::min_points, 0, 1000000));
  visit(group("tone", &S::tone));
}

/// Bounds where in the depth image a detected object can be: its box, slightly enlarged, and a range of depth.
struct DepthRegion {
  cv::Rect box_px;        ///< inside the image, may be empty
  float nearest = 0.0F;   ///< metres
  float farthest = 0.0F;  ///< metres
  int points = 0;         ///< pixels inside with depth in range
};
DepthRegion find_region(const RgbdFrame& frame, const Detection& detection, const ObjectModel& model,
                        const RegionSettings& settings);

/// Returns at most about `maximum` points of the region, camera frame, metres, evenly over the image.
std::vector<Eigen::Vector3f> region_points(const RgbdFrame& frame, const DepthRegion& region, int maximum);

/// Holds the colours of a part of a frame.
struct LabRegion {
  cv::Mat lab;          ///< CV_8UC3, 8-bit CIE L*a*b*, of the part; neighbouring pixels averaged against noise
  cv::Point origin_px;  ///< its first pixel in the frame
  /// CV_8UC1, not 0 where a channel is at the camera's limit, or a neighbour's is: there is no colour to compare.
  cv::Mat clipped;
};
/// Returns the colours of a part; `tone` is that of the whole frame. `part_px` must lie inside the image and not be
/// empty.
LabRegion lab_region(const RgbdFrame& frame, const cv::Rect& part_px, const AffineBrightness& tone);

/// Holds a frame in which objects are observed. The frame must outlive it.
struct FrameContext {
  const RgbdFrame& frame;
  DepthNoise noise;       ///< noise of its depth
  AffineBrightness tone;  ///< brings its colours into RegionSettings::tone
};
FrameContext make_frame_context(const RgbdFrame& frame, const RegionSettings& settings, const DepthNoise& noise);

/// Observes a detected object, together with its model; all later stages read it. Frame and model must outlive it.
struct ObjectObservation {
  const RgbdFrame& frame;
  const ObjectModel& model;
  /// Position at which ObjectModel::vote_centre was detected, metres, z > 0.
  Eigen::Vector3f centre_camera = Eigen::Vector3f::Zero();
  DepthNoise noise = {};  ///< noise of the frame's depth
  DepthRegion region = {};
  LabRegion colours = {};  ///< colours of the region's box; empty where the region has too few points
  /// Set where the object is thin and may lie on a plane; poses are then compared by it too.
  std::optional<SurfaceForeground> foreground = std::nullopt;
};
ObjectObservation observe_object(const FrameContext& context, const Detection& detection, const ObjectModel& model,
                                 const RegionSettings& settings);

/// Metres from where the object was detected to where it is at this pose.
double distance_from_detected(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object);

// The names of before, for one release.
using SeenFrame [[deprecated("is FrameContext now")]] = FrameContext;
using SeenObject [[deprecated("is ObjectObservation now")]] = ObjectObservation;

}  // namespace houghstream
