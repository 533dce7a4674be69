#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "pipeline/base/settings_fields.hpp"

namespace houghstream {

/// Brightness and contrast of images: mean and standard deviation of their grey values (ITU-R BT.601), 0 to 255. As
/// it stands, every image is in the range.
struct BrightnessRange {
  float min_mean = 0.0F;
  float max_mean = 255.0F;
  float max_deviation = 255.0F;
};

template <typename Visit>
void fields(const BrightnessRange& /*settings*/, const Visit& visit) {
  using S = BrightnessRange;
  visit(number("least_mean", &S::min_mean, 0, 255, "grey values"));
  visit(number("most_mean", &S::max_mean, 0, 255, "grey values"));
  visit(number("most_deviation", &S::max_deviation, 1, 255, "grey values"));
}

/// Checks the range as described in pipeline/base/check_settings.hpp; the means must be in order too.
void check_settings(const BrightnessRange& range, const std::string& source);

/// Affine brightness transfer, value * gain + offset, equal for all coded values of all channels (DSO, Engel et al.
/// 2018).
struct AffineBrightness {
  float gain = 1.0F;
  float offset = 0.0F;
  bool changes() const { return gain != 1.0F || offset != 0.0F; }
};

/// Fits the curve to an image. Cameras choose brightness and contrast freely, and many exaggerate both: differences
/// common to the whole image say nothing about an object in it. The curve moves the mean no farther than into the
/// range, and reduces contrast that is greater than the range's, to no less than 0.6 of it. It reads a sixteenth of the
/// pixels. CV_8UC3 BGR, not empty.
AffineBrightness fit_affine_brightness(const cv::Mat& colour, const BrightnessRange& range);

/// Applies the curve to a CV_8UC3 image; `out` may be `colour`.
void apply_affine_brightness(const AffineBrightness& curve, const cv::Mat& colour, cv::Mat& out);

// The names of before, for one release.
using ToneRange [[deprecated("is BrightnessRange now")]] = BrightnessRange;
using ToneCurve [[deprecated("is AffineBrightness now")]] = AffineBrightness;

}  // namespace houghstream
