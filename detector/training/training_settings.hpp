#pragma once

#include <cstdint>

#include "detector/forest/forest.hpp"

namespace houghstream::training {

/// How a forest is trained.
struct TrainingSettings {
  int trees = 15;
  int max_depth = 25;         ///< levels
  int min_samples = 20;       ///< a node with fewer becomes a leaf
  int tests_per_node = 2000;  ///< random pixel tests tried; where fewer samples choose, as many as these, or 64
  /// Of the nodes are split so that offsets agree, the others so that labels do; Gall et al. 2011 draw one or the other
  /// alike. It is always offsets where there is one label only, and labels where nearly all is background.
  double offset_share = 0.5;
  double alone_share = 0.3;  ///< of the tests look at one pixel alone, see PixelTest::kAlone
  /// At least so many of the tests on depth and on the surface, point histograms aside: these are the same in any
  /// light, without a comparison.
  double shape_alone_share = 0.0;
  /// Of the nodes look at point feature histograms, and only at those; the others never. What is shaped like an object
  /// stands in no room that is learnt from: they would win nearly every node, and the object's colours go unlearnt.
  double histogram_share = 0.3;
  int node_samples = 1500;      ///< at most so many samples choose a node's test; all are then split by it
  int patches_per_view = 250;   ///< of a training view
  int patches_per_room = 250;   ///< of a background frame
  int composites_per_view = 3;  ///< pictures made of one view: other background, distance and light
  int views_per_picture = 1;    ///< trees see one of so many views; the others are only remembered, for the evidence
  int spare_background = 10;    ///< background patches looked through for each one drawn blindly, see hard_negatives
  /// The background weighs as much as all objects together, but at most as so many: what a patch is worth to an object
  /// does not depend on how many others were taught.
  float most_background = 4.0F;
  double in_bag = 0.75;          ///< share of the pictures that a tree sees
  float min_distance = 0.3F;     ///< nearest distance taught, metres
  float max_distance = 2.6F;     ///< farthest distance taught, metres
  double occluded_share = 0.5;   ///< of the composites in which something stands in front of the object
  double cleared_share = 0.5;    ///< of the composites in which haze is taken from the object, see clear_haze
  double sharpened_share = 0.5;  ///< of those that trees learn from, in which the object is sharpened, see sharpened
  double light_variation = 1.0;  ///< strength of the changes of exposure, colour cast and haze, 0 = none
  double tone_share = 0.0;       ///< of the pictures that trees learn from, in which coded values change, see vary_tone
  int max_leaf_votes = 12;       ///< offsets kept per leaf and class after merging
  int max_leaf_views = 12;       ///< remembered training views per leaf and class
  float merge_radius = 0.008F;   ///< offsets nearer than this to each other become one vote, metres
  Scoring scoring = Scoring::kEvidence;
  int validation_frames = 300;     ///< composed pictures on which the score learns what it is worth
  double dazzled_share = 0.5;      ///< of these, in which what is near has lost most of its depth, see lose_near_depth
  double depth_error = 1.0;        ///< in all of these: strength of the errors of depth, see sensor_errors.hpp
  double surface_variation = 1.0;  ///< in all of these: strength of the changes of objects' colours, see resurfaced
  double camera_share = 0.7;       ///< of these, in which another camera looks, see camera_variation.hpp
  double camera_variation = 1.0;   ///< how widely these cameras vary
  std::uint64_t seed = 1;
  int threads = 2;
};

}  // namespace houghstream::training
