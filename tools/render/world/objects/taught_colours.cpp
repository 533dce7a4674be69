#include "tools/render/world/objects/taught_colours.hpp"

#include <algorithm>
#include <array>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/objects.hpp"

namespace houghstream::world {

const ClassColours& class_colours(int class_id) {
  static constexpr std::array<ClassColours, kClassCount> kColours = {{{{42, 0.18, 0.86}, {42, 0.18, 0.86}},
                                                                      {{218, 0.75, 0.68}, {46, 0.85, 0.92}},
                                                                      {{40, 0.06, 0.9}, {2, 0.75, 0.66}},
                                                                      {{356, 0.85, 0.62}, {0, 0.0, 0.85}}}};
  require(class_id >= 1 && class_id <= kClassCount, "class colours: class {}, expected 1 to {}", class_id, kClassCount);
  return kColours[static_cast<std::size_t>(class_id - 1)];
}

cv::Scalar bgr(const Hsv& colour) {
  return hsv(colour.hue_deg, colour.saturation, colour.value);
}

cv::Scalar near_colour(const Hsv& colour, Random& random) {
  return hsv(colour.hue_deg + random.uniform(-12, 12), std::min(1.0, colour.saturation * random.uniform(0.8, 1.2)),
             std::min(1.0, colour.value * random.uniform(0.85, 1.1)));
}

}  // namespace houghstream::world
