#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "detector/features/feature_image.hpp"
#include "detector/training/augmentation/training_set.hpp"
#include "pipeline/base/random.hpp"

namespace houghstream::toy {

constexpr int kClassPlane = 7;   ///< rises across every image of the object and is flat elsewhere
constexpr int kOffsetPlane = 8;  ///< rises where the offset is +0.05 m and is flat where it is -0.05 m
constexpr int kNoisePlane = 20;  ///< not informative

/// A set, and the images that its cutouts are made of.
struct Planted {
  std::vector<FeatureImage> images;
  training::TrainingSet set;
};

/// Returns the set of these images as they are now.
inline training::TrainingSet set_of(Planted planted) {
  planted.set.cutouts.clear();
  for (const FeatureImage& image : planted.images)
    planted.set.cutouts.emplace_back(image, training::spans_of(image.held()));
  return planted.set;
}

/// Returns what makes a set whose answer is known: 16 images, every other one background, and 50 samples of each.
inline Planted plant() {
  Planted planted;
  training::TrainingSet& set = planted.set;
  set.classes.resize(1);
  set.views.resize(1);
  Random random(3);
  for (int i = 0; i < 16; ++i) {
    FeatureImage image(32, 32, set.layout.pixel_stride());
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) {
        const auto ramp = static_cast<std::uint8_t>(4 * x);
        image.at(x, y)[kClassPlane] = i % 2 == 1 ? ramp : std::uint8_t{60};
        image.at(x, y)[kOffsetPlane] = i % 4 == 3 ? ramp : std::uint8_t{60};
        image.at(x, y)[kNoisePlane] = static_cast<std::uint8_t>(random.below(256));
      }
    }
    image.replicate_border();
    planted.images.push_back(image);
    for (int s = 0; s < 50; ++s) {
      training::TrainingSample sample;
      sample.image = i;
      sample.cutout = i;
      sample.x = static_cast<std::int16_t>(random.between(12, 19));
      sample.y = static_cast<std::int16_t>(random.between(12, 19));
      sample.scale = 256;
      sample.label = static_cast<std::uint16_t>(i % 2);
      if (sample.label != 0) sample.offset = {i % 4 == 3 ? 0.05F : -0.05F, 0.0F, 0.0F};
      set.samples.push_back(sample);
    }
  }
  return planted;
}

inline training::TrainingSet planted_set() {
  return set_of(plant());
}

}  // namespace houghstream::toy
