#pragma once

#include <algorithm>
#include <cmath>
#include <opencv2/core/matx.hpp>

namespace houghstream {

/// Holds a pair of pixels across an object's predicted boundary: the change of depth and colour from inside to outside.
struct BoundarySample {
  float lateral_distance = 0.0F;  ///< metres from one to the other, across the ray
  float depth_change = 0.0F;      ///< depth, metres; NaN where it is not measured
  /// Expected change of depth if the object's surface continues straight, metres; NaN where that is not known.
  float expected_depth_change = 0.0F;
  float colour_sq = 0.0F;  ///< see colour_distance_sq
};

/// Returns the squared distance of two 8-bit CIE L*a*b* colours, with lightness at half its weight, since shading
/// changes it along a surface.
inline float colour_distance_sq(const cv::Vec3b& a, const cv::Vec3b& b) {
  const auto difference = [&](int channel) { return static_cast<float>(a[channel]) - static_cast<float>(b[channel]); };
  return 0.25F * difference(0) * difference(0) + difference(1) * difference(1) + difference(2) * difference(2);
}

/// Approximates exp(-square / 2) by (1 - square / 8)^4, which is zero from 8 on and needs no exponential.
inline float approximate_gaussian(float square) {
  const float base = std::max(0.0F, 1.0F - 0.125F * square);
  return (base * base) * (base * base);
}

/// Returns whether a nearer surface begins at the boundary, which then is an occluder's. `tolerance`: of depth, metres,
/// here and below.
inline bool is_foreground_step(const BoundarySample& sample, float tolerance) {
  constexpr float kSteepest = 2.5F;  // maximum slope of a table towards the camera: depth over lateral distance
  return sample.depth_change < -kSteepest * sample.lateral_distance - 2.0F * tolerance;
}

inline bool is_background_step(const BoundarySample& sample, float tolerance) {
  return sample.depth_change > 2.0F * tolerance + sample.lateral_distance;
}

/// Returns the continuation of the surface, 1 where it continues straight, 0 where it does not, 0.5 where that is
/// unknown.
inline float surface_continuation(const BoundarySample& sample, float tolerance) {
  constexpr float kUnknown = 0.5F;
  const float slack = 0.4F * sample.lateral_distance + 0.25F * tolerance;  // surfaces bend
  const float off = sample.depth_change - sample.expected_depth_change;
  const float straight = approximate_gaussian(off * off / (slack * slack));
  return std::isnan(off) ? kUnknown : straight;
}

/// Returns the continuation of the colour of an untextured object, 0 to 1.
inline float uniform_colour_continuation(const BoundarySample& sample) {
  return approximate_gaussian(sample.colour_sq / 16.0F);
}

/// Returns the continuation of the colour of an object that may be textured, 0 to 1.
inline float textured_colour_continuation(const BoundarySample& sample) {
  return approximate_gaussian(sample.colour_sq / 36.0F);
}

}  // namespace houghstream
