#pragma once

#include <opencv2/core.hpp>

namespace houghstream {

/// Brightness and contrast of pictures: mean and standard deviation of their grey values (ITU-R BT.601), 0 to 255. As
/// it stands, every picture is in the range.
struct BrightnessRange {
  float min_mean = 0.0F;
  float max_mean = 255.0F;
  float max_deviation = 255.0F;
  /// Whether these are grey values that a picture can be brought to.
  bool is_sound() const {
    return min_mean >= 0.0F && min_mean <= max_mean && max_mean <= 255.0F && max_deviation >= 1.0F &&
           max_deviation <= 255.0F;
  }
};

/// What brings a picture into a range: the same for all coded values of all its channels, value * gain + offset.
struct AffineBrightness {
  float gain = 1.0F;
  float offset = 0.0F;
  bool changes() const { return gain != 1.0F || offset != 0.0F; }
};

/// Cameras make brightness and contrast as they like, and many too much of both: what is common to all of a picture
/// says nothing about an object in it. The curve moves the mean no farther than into the range, and flattens contrast
/// that is greater than the range's, to no less than 0.6 of it. From a sixteenth of the pixels. CV_8UC3 BGR, not empty.
AffineBrightness fit_affine_brightness(const cv::Mat& colour, const BrightnessRange& range);

/// CV_8UC3; `out` may be `colour`.
void apply_affine_brightness(const AffineBrightness& curve, const cv::Mat& colour, cv::Mat& out);

// The names of before, for one release.
using ToneRange [[deprecated("is BrightnessRange now")]] = BrightnessRange;
using ToneCurve [[deprecated("is AffineBrightness now")]] = AffineBrightness;

}  // namespace houghstream
