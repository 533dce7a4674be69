#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "detector/features/feature_image.hpp"
#include "pipeline/base/settings_fields.hpp"

namespace houghstream {

/// Scale of the tests of a patch. Stored in the forest file.
struct PatchSettings {
  /// Metres per step of a test offset on the object (depth normalisation, Section 5.1.2); in a scale space, working
  /// pixels per step.
  float unit = 0.002F;
  int radius = 10;  ///< test offsets reach from -radius to +radius steps
};

template <typename Visit>
void fields(const PatchSettings& /*settings*/, const Visit& visit) {
  using S = PatchSettings;
  visit(number("unit", &S::unit, 1e-6, 1, "m or working pixels"));
  visit(number("radius", &S::radius, 1, 127, "steps"));
}

/// Distance of the patches of a frame.
struct PatchSpacing {
  int stride = 2;  ///< working pixels (paper, Section 5.1.3)
  /// On a surface that faces the camera: where the stride puts patches nearer to each other, some are left out, see
  /// add_patches. 0 = none are. With depth normalisation only.
  float metres = 0.022F;
};

template <typename Visit>
void fields(const PatchSpacing& /*settings*/, const Visit& visit) {
  using S = PatchSpacing;
  visit(number("stride", &S::stride, 1, 64, "working pixels"));
  visit(number("metres", &S::metres, 0, 10, "m"));
}

/// Returns the working pixels per step of a test offset in 1/256 pixel, for steps of `step_px`; limited so that a patch
/// stays inside the border of a FeatureImage.
inline std::int32_t limited_scale(const PatchSettings& patch, double step_px) {
  const double limit = static_cast<double>(FeatureImage::kPad) / patch.radius;
  return static_cast<std::int32_t>(std::lround(256.0 * std::min(step_px, limit)));
}

/// Returns the same at depth z (depth normalisation).
inline std::int32_t patch_scale(const PatchSettings& patch, double focal_px, float z) {
  return limited_scale(patch, patch.unit * focal_px / z);
}

/// Returns how far the tests of a patch reach, pixels.
inline int max_offset(const PatchSettings& patch, std::int32_t scale) {
  return (patch.radius * scale + 128) >> 8;
}

}  // namespace houghstream
