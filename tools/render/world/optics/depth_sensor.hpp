#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "pipeline/types/camera.hpp"

// A structured-light depth camera (Kinect, Xtion). Sources:
// - Khoshelham & Elberink, "Accuracy and Resolution of Kinect Depth Data for Indoor Mapping Applications", Sensors
// 12(2),
//   2012, doi:10.3390/s120201437: disparity is measured in steps of 1/8 pixel, so neighbouring depths lie
//   z^2 / (f b) / 8 = 2.85e-3 z^2 m apart (2.9 mm at 1 m, 7 cm at 5 m), and random error grows with z^2 (4 cm at 5 m).
// - Nguyen, Izadi & Lovell, "Modeling Kinect Sensor Noise for Improved 3D Reconstruction and Tracking", 3DIMPVT 2012,
//   doi:10.1109/3DIMPVT.2012.84: axial deviation 0.0012 + 0.0019 (z - 0.4)^2 m for surfaces seen at less than 60
//   degrees, plus 0.0001 / sqrt(z) * t^2 / (pi/2 - t)^2 at incidence t; lateral deviation 0.8 + 0.035 t / (pi/2 - t)
//   pixels.

namespace houghstream::world {

struct DepthSensorSettings {
  double baseline_m = 0.075;         ///< projector to the right of the camera
  double infrared_focal_px = 580.0;  ///< of the infrared camera, for the disparity
  double disparity_step_px = 0.125;  ///< quantisation
  double near_m = 0.4;               ///< nearer is none
  double far_m = 4.5;                ///< farther is none
  double edge_loss = 0.4;            ///< share of pixels at depth steps that give nothing, 0 to 1
  double edge_step = 0.02;           ///< a depth step, relative to depth
  double min_cosine = 0.14;          ///< surfaces seen flatter than this return too little
  double min_signal = 0.004;         ///< least reflectance * cosine / z^2 (m^-2) that is seen
  double glare = 0.27;               ///< mirror-like return above this blinds the camera
};

/// Inputs of the sensor, one value per pixel; all of one size.
struct SensorView {
  cv::Mat depth;          ///< CV_32FC1, metres, NaN = nothing
  cv::Mat cos_incidence;  ///< CV_32FC1, 0 to 1
  cv::Mat reflectance;    ///< CV_32FC1, 0 to 1
  cv::Mat specular;       ///< CV_32FC1, 0 to 1
};

/// Returns the axial deviation of measurements at depth z (m) and incidence cosine, metres (Nguyen et al. 2012).
double axial_sigma(double z, double cos_incidence);

/// Returns the distance between neighbouring measurable depths at depth z, metres (Khoshelham & Elberink 2012).
double depth_step(double z, const DepthSensorSettings& settings);

/// Returns the pixels that the projector, to the right of the camera, does not reach: CV_8UC1, 255 = in the infrared
/// shadow.
cv::Mat infrared_shadow(const cv::Mat& depth, const Camera& camera, double baseline_m);

/// Returns the measured depth: CV_32FC1, whole millimetres given in metres, NaN = none. The same seed gives the same
/// noise.
cv::Mat measure_depth(const SensorView& view, const Camera& camera, const DepthSensorSettings& settings,
                      std::uint64_t seed);

}  // namespace houghstream::world
