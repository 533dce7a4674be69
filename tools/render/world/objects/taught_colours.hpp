#pragma once

#include <opencv2/core.hpp>

#include "pipeline/base/random.hpp"

// These are the typical colours of the four classes, so that distractors can be given them too.

namespace houghstream::world {

struct Hsv {
  double hue_deg = 0.0;
  double saturation = 0.0;  ///< 0-1
  double value = 0.0;       ///< 0-1
};

/// Gives the main colours of a class; those of one without a second colour are the same.
struct ClassColours {
  Hsv base;
  Hsv accent;
};

/// Returns the colours of class 1 to 4 (objects.hpp). Throws InputError for another class.
const ClassColours& class_colours(int class_id);

cv::Scalar bgr(const Hsv& colour);

/// Returns a colour that a person would call the same: BGR.
cv::Scalar near_colour(const Hsv& colour, Random& random);

}  // namespace houghstream::world
