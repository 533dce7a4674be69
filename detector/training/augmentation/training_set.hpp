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
#include "detector/training/augmentation/cutout.hpp"
#include "detector/training/augmentation/scales.hpp"
#include "detector/training/augmentation/training_sample.hpp"
#include "pipeline/base/random.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream::training {

/// Everything the trees see.
struct TrainingSet {
  FeatureLayout layout;                       ///< layout of the cutouts
  std::vector<Cutout> cutouts;                ///< what patches read of the images, see cover_patches
  std::size_t images = 0;                     ///< number of composed images
  std::vector<TrainingSample> samples;        ///< grouped by image
  std::vector<TrainingSample> negative_pool;  ///< more background patches, from which the hard ones are chosen
  std::vector<ObjectClass> classes;           ///< classes by class id
  std::vector<ViewTemplate> views;
  std::uint16_t first_class = 0;  ///< classes and views that the forest has already
  std::uint32_t first_view = 0;
  std::vector<float> visible_areas;  ///< per class: mean over its images, square metres

  CutoutPatch patch(const TrainingSample& sample) const {
    return cutouts[static_cast<std::size_t>(sample.cutout)].patch(sample.x, sample.y, sample.scale);
  }
  /// Returns the size of all pixels that are held, bytes.
  std::size_t held_bytes() const;
};

/// Lets those pixels go that no patch of the set reads any more.
void drop_unread_pixels(const PatchSettings& patch, TrainingSet& set);

/// Input of the augmentation.
struct ImageInput {
  const FeatureSettings& features;
  const PatchSettings& patch;
  const AugmentationSettings& settings;
  const Scales& scales;
};

/// Puts every view into several backgrounds, computes features and draws patches (paper, Section 4: 250 an image).
/// Throws InputError when a class or the background is missing or a mask is empty. `is_done` is called, from any
/// thread, when what a view shows is needed no more: it may be let go, as all views together are as large as the set.
/// It is not called for objects' views of several composites.
TrainingSet make_training_set(const std::vector<const TrainingView*>& views, const ImageInput& input,
                              const std::function<void(const TrainingView*)>& is_done);

/// An image that trees learn from.
struct TrainingImage {
  cv::Size size;                ///< working pixels
  std::vector<Cutout> cutouts;  ///< what its patches read; TrainingSample::cutout counts from 0 in each image
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
