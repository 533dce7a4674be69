#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "pipeline/base/settings_fields.hpp"
#include "pipeline/types/brightness.hpp"

namespace houghstream {

/// Handling of an object's distance.
enum class ScaleHandling : std::uint32_t {
  kDepthNormalised = 0,  ///< tests and offsets are divided by the measured depth (paper, Section 5.1.2)
  /// The image is searched in several sizes (Gall et al. 2011), by detector/baseline. Nothing is known of depth:
  /// lengths on the object count as if it stood 1 m away, metres = working pixels / (image_scale * focal length), and
  /// centres have no depth.
  kScaleSpace = 1,
};

constexpr int kMaxScales = 5;

/// Settings of the feature planes. Stored in the forest file, since training and detection must agree.
struct FeatureSettings {
  std::uint32_t families = 15;  ///< see FeatureFamily; default: the paper's final features (Section 4, end)
  ScaleHandling handling = ScaleHandling::kDepthNormalised;
  std::array<float, kMaxScales> scales{};  ///< sizes of the image in a scale space, 0 = unused
  float image_scale = 0.5F;                ///< working size over frame size for near surfaces (paper, Section 5.1.1)
  float far_distance = 1.2F;       ///< surfaces beyond are looked at in twice that size, metres: see feature_levels
  float max_distance = 2.8F;       ///< surfaces beyond belong to no object that was taught, metres
  int depth_sobel_px = 7;          ///< kernel of the depth derivatives, working pixels (paper, Section 4.3)
  int min_max_px = 5;              ///< neighbourhood of minimum and maximum, working pixels (paper, Section 3)
  float fill_distance_px = 24.0F;  ///< distance over which a pixel may borrow measured depth, working pixels
  /// ... or metres on the surface that it borrows from, if those are more pixels, see HoleReach. 0: the nearest pixel
  /// lends, whatever its depth. A scale space takes it for 0.
  float fill_distance = 0.06F;
  BrightnessRange tone;  ///< frames that are searched are brought into it; what is learnt from stays as it is
};

template <typename Visit>
void fields(const FeatureSettings& /*settings*/, const Visit& visit) {
  using S = FeatureSettings;
  visit(number("image_scale", &S::image_scale, 0.05, 2));
  visit(number("far_distance", &S::far_distance, 0, 1000, "m"));
  visit(number("max_distance", &S::max_distance, 0, 1000, "m"));
  visit(number("depth_sobel_px", &S::depth_sobel_px, 3, 31, "working pixels"));
  visit(number("min_max_px", &S::min_max_px, 1, 31, "working pixels"));
  visit(number("fill_distance_px", &S::fill_distance_px, 0, 1000, "working pixels"));
  visit(number("fill_distance", &S::fill_distance, 0, 1, "m"));
  visit(group("tone", &S::tone));
}

/// Checks the settings as pipeline/base/check_settings.hpp says. Throws InputError also where families, handling,
/// scales or kernels do not exist.
void check_settings(const FeatureSettings& settings, const std::string& source);

}  // namespace houghstream
