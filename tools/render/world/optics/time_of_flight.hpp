#pragma once

#include "tools/render/world/optics/depth_sensor.hpp"

// A time-of-flight depth camera (Kinect v2, Azure Kinect, PMD): it times modulated light that comes back along the line
// of sight. Nothing is matched, so there is no baseline, no infrared shadow and no disparity step. What there is
// instead, from the sources below; the constants are ours, so that a half-reflecting wall has 1.6 mm at 1 m and 4.9 mm
// at 2 m.
// - Lange & Seitz, "Solid-State Time-of-Flight Range Camera", IEEE J. Quantum Electronics 37(3), 2001: the random error
//   is inverse to the amplitude of the light that returns, which falls with the square of the distance, on dark and on
//   slanting surfaces.
// - Sabov & Krueger, "Identification and Correction of Flying Pixels in Range Camera Data", SCCG 2008: a pixel at a
//   depth edge sees both surfaces and reports a depth between them, nearer to that which returns more.
// - Fuchs, "Multipath Interference Compensation in Time-of-Flight Camera Images", ICPR 2010: light that takes a way
// round
//   by another surface makes concave places seem farther away.
// - Sarbolandi, Lefloch & Kolb, "Kinect Range Sensing: Structured-Light versus Time-of-Flight Kinect", CVIU 139, 2015:
//   the same effects, measured for both kinds side by side.

namespace houghstream::world {

struct TimeOfFlightSettings {
  double near_m = 0.3;               ///< nearer is none
  double far_m = 4.5;                ///< farther is none
  double floor_m = 0.001;            ///< deviation however much light returns
  double light_m = 0.0006;           ///< deviation at amplitude 1 m^-2, inverse to the amplitude
  double min_amplitude = 0.0025;     ///< m^-2; less gives nothing
  double edge_step = 0.02;           ///< a depth edge, relative to depth
  double flying_fraction = 0.5;      ///< fraction of the pixels at depth edges that see both surfaces, 0 to 1
  double multipath = 0.4;            ///< bias of a concave place, in depths by which it lies behind its surroundings
  double multipath_reach_px = 15.0;  ///< radius of the surroundings of a pixel
  double multipath_reach_m = 0.1;    ///< maximum difference in depth: larger ones are edges, not concave places
};

/// Returns the amplitude of the light that returns, m^-2: reflectance * cosine / z^2. A glossy surface returns less
/// along the ray.
double returned_amplitude(const SensorView& view, const cv::Point& pixel);

/// Returns the deviation of measurements at this amplitude, metres.
double time_of_flight_sigma(double amplitude, const TimeOfFlightSettings& settings);

/// Returns the measured depth in the form of measure_depth(): CV_32FC1, whole millimetres given in metres, NaN = none.
/// The same seed gives the same noise. May be called from several threads.
cv::Mat measure_time_of_flight(const SensorView& view, const TimeOfFlightSettings& settings, std::uint64_t seed);

}  // namespace houghstream::world
