#pragma once

#include <cstdint>

#include "pipeline/base/settings_fields.hpp"

namespace houghstream::training {

/// Settings of the augmentation of training images.
struct AugmentationSettings {
  int patches_per_view = 250;        ///< patches of a training view
  int patches_per_background = 250;  ///< patches of a background frame
  int composites_per_view = 3;       ///< images made of one view: other background, distance and light
  int views_per_image = 1;           ///< trees see one of so many views; the others are view templates only
  int negative_pool = 10;          ///< background patches looked through for each one drawn blindly, see hard_negatives
  float min_distance = 0.3F;       ///< nearest distance taught, metres
  float max_distance = 2.6F;       ///< farthest distance taught, metres
  double occluded_fraction = 0.5;  ///< fraction of the composites in which something stands in front of the object
  /// Fraction of the composites of standing objects in which they stand on their plane (TrainingView::support); the
  /// others have the background alone about them. Chosen on rendered rooms, where 0 was tried beside it.
  double supported_fraction = 0.7;
  /// Fraction of the composites in which haze is removed from the object, see remove_haze.
  double dehazed_fraction = 0.5;
  /// Fraction of the composites that trees learn from, in which the object is sharpened, see apply_unsharp_mask.
  double sharpened_fraction = 0.5;
  double lighting_variation = 1.0;  ///< strength of the changes of exposure, colour cast and haze, 0 = none
  /// Fraction of the images that trees learn from, whose coded values change, see jitter_tone.
  double tone_jitter_fraction = 0.0;
  /// Fraction of the composed frames that scores learn from, in which near surfaces have lost most of their depth, see
  /// drop_near_depth.
  double near_dropout_fraction = 0.5;
  double depth_error = 1.0;  ///< strength of the errors of depth in all of those, see sensor_errors.hpp
  /// Strength of the changes of objects' colours in all of those, see perturb_appearance.
  double surface_variation = 1.0;
  double camera_fraction = 0.7;       ///< fraction of those that another camera sees, see camera_randomisation.hpp
  double camera_randomisation = 1.0;  ///< variation of these cameras
  std::uint64_t seed = 1;
  int threads = 2;
};

template <typename Visit>
void fields(const AugmentationSettings& /*settings*/, const Visit& visit) {
  using S = AugmentationSettings;
  visit(number("patches_per_view", &S::patches_per_view, 4, 100000));
  visit(number("patches_per_background", &S::patches_per_background, 4, 100000));
  visit(number("composites_per_view", &S::composites_per_view, 1, 100));
  visit(number("views_per_image", &S::views_per_image, 1, 100000));
  visit(number("negative_pool", &S::negative_pool, 0, 1000));
  visit(number("min_distance", &S::min_distance, 0.05, 20, "m"));
  visit(number("max_distance", &S::max_distance, 0.05, 20, "m"));
  visit(number("occluded_fraction", &S::occluded_fraction, 0, 1));
  visit(number("supported_fraction", &S::supported_fraction, 0, 1));
  visit(number("dehazed_fraction", &S::dehazed_fraction, 0, 1));
  visit(number("sharpened_fraction", &S::sharpened_fraction, 0, 1));
  visit(number("lighting_variation", &S::lighting_variation, 0, 10));
  visit(number("tone_jitter_fraction", &S::tone_jitter_fraction, 0, 1));
  visit(number("near_dropout_fraction", &S::near_dropout_fraction, 0, 1));
  visit(number("depth_error", &S::depth_error, 0, 10));
  visit(number("surface_variation", &S::surface_variation, 0, 10));
  visit(number("camera_fraction", &S::camera_fraction, 0, 1));
  visit(number("camera_randomisation", &S::camera_randomisation, 0, 10));
  visit(number("threads", &S::threads, 1, 256));
}

}  // namespace houghstream::training
