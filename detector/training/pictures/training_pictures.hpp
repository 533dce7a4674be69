#pragma once

#include <vector>

#include "detector/features/working_frame.hpp"
#include "detector/profiles.hpp"
#include "detector/training/pictures/training_set.hpp"
#include "pipeline/base/random.hpp"

namespace houghstream {

/// A picture that trees learn from.
struct TrainingPicture {
  FeatureImage features;
  std::vector<TrainingSample> samples;
  std::vector<TrainingSample> spare_background;
  float whole_area = 0.0F;  ///< of the object, square metres; 0 in a background picture
};

/// An object put into a background: patches on it and some beside it. Empty where the background is too small.
TrainingPicture object_picture(const TrainingView& view, int label, std::uint32_t view_index,
                               const RgbdFrame& background, const Profile& profile, Random& random);

constexpr int kBackgroundPictures = 4;  ///< per background frame, spread over the levels

/// A part of a background as one level sees it.
TrainingPicture background_picture(const RgbdFrame& background, const FeatureLevel& level, const Profile& profile,
                                   Random& random);

}  // namespace houghstream
