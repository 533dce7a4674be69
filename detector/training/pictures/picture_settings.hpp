#pragma once

#include <cstdint>

namespace houghstream::training {

/// How pictures are made to learn from.
struct PictureSettings {
  int patches_per_view = 250;        ///< of a training view
  int patches_per_background = 250;  ///< of a background frame
  int composites_per_view = 3;       ///< pictures made of one view: other background, distance and light
  int views_per_picture = 1;      ///< trees see one of so many views; the others are only remembered, for the evidence
  int spare_background = 10;      ///< background patches looked through for each one drawn blindly, see hard_negatives
  float min_distance = 0.3F;      ///< nearest distance taught, metres
  float max_distance = 2.6F;      ///< farthest distance taught, metres
  double occluded_share = 0.5;    ///< of the composites in which something stands in front of the object
  double dehazed_fraction = 0.5;  ///< of the composites in which haze is taken from the object, see remove_haze
  double sharpened_share = 0.5;   ///< of those that trees learn from, in which the object is sharpened, see sharpened
  double light_variation = 1.0;   ///< strength of the changes of exposure, colour cast and haze, 0 = none
  double tone_jitter_fraction = 0.0;   ///< of the images that trees learn from: coded values change, see jitter_tone
  double near_dropout_fraction = 0.5;  ///< of the composed frames that scores learn from, in which what is near has
                                       ///< lost most of its depth, see drop_near_depth
  double depth_error = 1.0;            ///< in all of those: strength of the errors of depth, see sensor_errors.hpp
  double surface_variation = 1.0;      ///< in all of those: strength of the changes of objects' colours, see resurfaced
  double camera_share = 0.7;           ///< of those, in which another camera looks, see camera_randomisation.hpp
  double camera_variation = 1.0;       ///< how widely these cameras vary
  std::uint64_t seed = 1;
  int threads = 2;
};

}  // namespace houghstream::training
