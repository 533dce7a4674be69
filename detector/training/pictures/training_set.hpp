#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "detector/features/feature_families.hpp"
#include "detector/features/feature_image.hpp"
#include "detector/forest/forest.hpp"
#include "detector/profiles.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream::training {

/// One patch to learn from.
struct TrainingSample {
  std::int32_t picture = 0;  ///< into TrainingSet::pictures
  std::int16_t x = 0;        ///< patch centre, working pixels
  std::int16_t y = 0;
  std::int32_t scale = 0;                            ///< patch_scale of its depth
  std::uint32_t view = 0;                            ///< into TrainingSet::views; meaningless for background
  std::uint16_t label = 0;                           ///< 0 = background, else class index + 1
  Eigen::Vector3f offset = Eigen::Vector3f::Zero();  ///< to the object's centre in the patch's ray frame, metres
};

/// Everything the trees see.
struct TrainingSet {
  FeatureLayout layout;  ///< of the pictures
  std::vector<FeatureImage> pictures;
  std::vector<TrainingSample> samples;           ///< grouped by picture
  std::vector<TrainingSample> spare_background;  ///< more background patches, from which the hard ones are chosen
  std::vector<ObjectClass> classes;              ///< by class id
  std::vector<TrainedView> views;
  std::uint16_t first_class = 0;  ///< classes and views that the forest has already
  std::uint32_t first_view = 0;
  std::vector<float> visible_areas;  ///< per class: mean over its pictures, square metres
};

/// Puts every view into several backgrounds, computes features and draws patches (paper, Section 4: 250 an image).
/// Throws InputError when a class or the background is missing or a mask is empty. `is_done` is called, from any
/// thread, when what an object's view shows is needed no more: it may be let go, as all views together are a third as
/// large as the set. It is not called for views of several composites.
TrainingSet make_training_set(const std::vector<const TrainingView*>& views, const Profile& profile,
                              const std::function<void(const TrainingView*)>& is_done);

}  // namespace houghstream::training
