#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <vector>

#include "pipeline/types/frame.hpp"

namespace houghstream::reconstruction {

/// Holds a frame at one resolution.
struct FrameLevel {
  Camera camera;
  cv::Mat intensity;  ///< CV_32FC1, brightness minus its local mean, over its local standard deviation: independent of
                      ///< exposure
  cv::Mat depth;      ///< CV_32FC1, metres, NaN = none
  cv::Mat static_mask;  ///< CV_8UC1, 255 where the intensity is not informative, as it stayed while the object rotated;
                        ///< empty = nowhere
};

/// Quality of an image, by which frames that would blur a model are left out.
struct ImageQuality {
  double sharpness = 0.0;        ///< mean square of the Laplacian over the mean square of the brightness' deviation
  double dark_fraction = 0.0;    ///< pixels that are black
  double bright_fraction = 0.0;  ///< pixels that are overexposed
};

/// Holds the image pyramid of a frame that registration needs.
struct FrameLevels {
  std::vector<FrameLevel> levels;  ///< the finest first, each half as large as the one before
  ImageQuality quality;
};

/// Region and resolution of a frame that registration uses.
struct LevelSettings {
  cv::Rect region_px;   ///< part of the frame; empty = all
  int min_width = 400;  ///< pixels: what is wider is halved before
  int levels = 3;
};

FrameLevels make_levels(const RgbdFrame& frame, const LevelSettings& settings);

/// A surface point as observed in a keyframe.
struct SurfacePoint {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();   ///< metres
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit length, towards the camera
  float intensity = 0.0F;  ///< value of FrameLevel::intensity there; NaN where it is not informative
  bool on_table = false;   ///< whether it lies on the plane z = 0 of the world
};

/// Points of each level, finest first.
using LevelPoints = std::vector<std::vector<SurfacePoint>>;

/// Settings of the selection of points: in each cell of a grid of pixels the one with the strongest intensity gradient,
/// of those with depth and a normal.
struct PointSettings {
  int cell_px = 6;          ///< side of a cell on the finest level; 3/4 of it on the next, and so on
  double min_facing = 0.2;  ///< cosine between normal and line of sight
};

/// Selects points, in the camera frame. `mask` (CV_8UC1 of the first level's size, or empty) limits the pixels.
LevelPoints choose_points(const FrameLevels& frame, const cv::Mat& mask, const PointSettings& settings);

/// Returns the standard deviation of a structured-light camera's depth at a distance, metres (Nguyen, Izadi, Lovell,
/// "Modeling Kinect sensor noise", 3DIMPVT 2012, equation 6).
inline double depth_sigma(double z) {
  return 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
}

}  // namespace houghstream::reconstruction
