#pragma once

#include <algorithm>
#include <cmath>
#include <opencv2/core/matx.hpp>

namespace houghstream {

/// What is seen from within a thing's supposed outline to beyond it.
struct BoundarySample {
  float lateral_distance = 0.0F;  ///< metres from one to the other, across the ray
  float depth_change = 0.0F;      ///< depth, metres; NaN where it is not measured
  /// The same if the thing's surface goes on straight, metres; NaN where that is not known.
  float expected_depth_change = 0.0F;
  float colour_sq = 0.0F;  ///< see colour_distance_sq
};

/// Squared distance of two 8-bit CIE L*a*b* colours, lightness at half its weight: shading changes it along a surface.
inline float colour_distance_sq(const cv::Vec3b& a, const cv::Vec3b& b) {
  const auto difference = [&](int channel) { return static_cast<float>(a[channel]) - static_cast<float>(b[channel]); };
  return 0.25F * difference(0) * difference(0) + difference(1) * difference(1) + difference(2) * difference(2);
}

/// 1 at 0, falling as a Gaussian of variance 1 does, to nothing at 8. Its exponential would take most of the time.
inline float approximate_gaussian(float square) {
  const float base = std::max(0.0F, 1.0F - 0.125F * square);
  return (base * base) * (base * base);
}

/// Something stands in front there: the outline is another one's. `tolerance`: of depth, metres, here and below.
inline bool is_foreground_step(const BoundarySample& seen, float tolerance) {
  constexpr float kSteepest = 2.5F;  // what a table gains towards the camera, over the distance across the ray
  return seen.depth_change < -kSteepest * seen.lateral_distance - 2.0F * tolerance;
}

inline bool is_background_step(const BoundarySample& seen, float tolerance) {
  return seen.depth_change > 2.0F * tolerance + seen.lateral_distance;
}

/// 1 where the surface goes straight on, 0 where it does not; between where that is not known.
inline float surface_continuation(const BoundarySample& seen, float tolerance) {
  constexpr float kUnknown = 0.5F;
  const float slack = 0.4F * seen.lateral_distance + 0.25F * tolerance;  // surfaces bend
  const float off = seen.depth_change - seen.expected_depth_change;
  const float straight = approximate_gaussian(off * off / (slack * slack));
  return std::isnan(off) ? kUnknown : straight;
}

/// The same of the colour of a plain thing.
inline float uniform_colour_continuation(const BoundarySample& seen) {
  return approximate_gaussian(seen.colour_sq / 16.0F);
}

/// The same of the colour of one that may be printed.
inline float textured_colour_continuation(const BoundarySample& seen) {
  return approximate_gaussian(seen.colour_sq / 36.0F);
}

}  // namespace houghstream
