#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "detector/features/feature_families.hpp"
#include "detector/features/feature_image.hpp"
#include "detector/features/features.hpp"
#include "detector/features/working_frame.hpp"
#include "detector/forest/forest.hpp"
#include "detector/training/augmentation/augmentation_settings.hpp"
#include "detector/training/augmentation/scales.hpp"
#include "pipeline/base/random.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream::training {

/// One patch to learn from.
struct TrainingSample {
  std::int32_t image = 0;  ///< index into TrainingSet::images
  std::int16_t x = 0;      ///< patch centre, working pixels
  std::int16_t y = 0;
  std::int32_t scale = 0;                            ///< patch_scale of its depth
  std::uint32_t view = 0;                            ///< index into TrainingSet::views; meaningless for background
  std::uint16_t label = 0;                           ///< 0 = background, else class index + 1
  Eigen::Vector3f offset = Eigen::Vector3f::Zero();  ///< offset to the object's centre in the patch's ray frame, metres
};

/// Everything the trees see.
struct TrainingSet {
  FeatureLayout layout;  ///< layout of the images
  std::vector<FeatureImage> images;
  std::vector<TrainingSample> samples;        ///< grouped by image
  std::vector<TrainingSample> negative_pool;  ///< more background patches, from which the hard ones are chosen
  std::vector<ObjectClass> classes;           ///< classes by class id
  std::vector<ViewTemplate> views;
  std::uint16_t first_class = 0;  ///< classes and views that the forest has already
  std::uint32_t first_view = 0;
  std::vector<float> visible_areas;  ///< per class: mean over its images, square metres
};

/// Input of the augmentation.
struct ImageInput {
  const FeatureSettings& features;
  const PatchSettings& patch;
  const AugmentationSettings& settings;
  const Scales& scales;
};

/// Puts every view into several backgrounds, computes features and draws patches (paper, Section 4: 250 an image).
/// Throws InputError when a class or the background is missing or a mask is empty. `is_done` is called, from any
/// thread, when what an object's view shows is needed no more: it may be let go, as all views together are a third as
/// large as the set. It is not called for views of several composites.
TrainingSet make_training_set(const std::vector<const TrainingView*>& views, const ImageInput& input,
                              const std::function<void(const TrainingView*)>& is_done);

/// An image that trees learn from.
struct TrainingImage {
  FeatureImage features;
  std::vector<TrainingSample> samples;
  std::vector<TrainingSample> negative_pool;
  float whole_area = 0.0F;  ///< area of the object, square metres; 0 in a background image
};

/// A view that objects are taught by.
struct LabelledView {
  const TrainingView& view;
  int label = 0;            ///< class index + 1
  std::uint32_t index = 0;  ///< into TrainingSet::views
};

/// Memory that images share, one after another: it is written to much faster than new memory, which the system has to
/// clear first.
struct ImageWorkspace {
  FeatureTiles tiles;
  FeatureWorkspace feature_workspace;
  FeatureImage features;
};

/// Makes an object's image: puts it into a background, with patches on it and some beside it. Empty where the
/// background is too small.
TrainingImage object_image(const LabelledView& taught, const RgbdFrame& background, const ImageInput& input,
                           Random& random, ImageWorkspace& workspace);

constexpr int kBackgroundImages = 4;  ///< per background frame, spread over the levels

/// Makes an image of a part of a background as one level sees it.
TrainingImage background_image(const RgbdFrame& background, const FeatureLevel& level, const ImageInput& input,
                               Random& random, ImageWorkspace& workspace);

}  // namespace houghstream::training
