#pragma once

#include <vector>

#include "detector/features/features.hpp"
#include "detector/features/working_frame.hpp"
#include "detector/profiles.hpp"
#include "detector/training/pictures/training_set.hpp"
#include "pipeline/base/random.hpp"

namespace houghstream::training {

/// A picture that trees learn from.
struct TrainingPicture {
  FeatureImage features;
  std::vector<TrainingSample> samples;
  std::vector<TrainingSample> spare_background;
  float whole_area = 0.0F;  ///< of the object, square metres; 0 in a background picture
};

/// A view that objects are taught by.
struct TaughtView {
  const TrainingView& view;
  int label = 0;            ///< class index + 1
  std::uint32_t index = 0;  ///< into TrainingSet::views
};

/// Memory that pictures share, one after another: it is written to much faster than new memory, which the system has to
/// clear first.
struct PictureWorkspace {
  FeatureTiles tiles;
  FeatureMemory feature_memory;
  FeatureImage features;
};

/// An object put into a background: patches on it and some beside it. Empty where the background is too small.
TrainingPicture object_picture(const TaughtView& taught, const RgbdFrame& background, const Profile& profile,
                               Random& random, PictureWorkspace& own);

constexpr int kBackgroundPictures = 4;  ///< per background frame, spread over the levels

/// A part of a background as one level sees it.
TrainingPicture background_picture(const RgbdFrame& background, const FeatureLevel& level, const Profile& profile,
                                   Random& random, PictureWorkspace& own);

}  // namespace houghstream::training
