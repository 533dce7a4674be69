#pragma once

#include <limits>

#include "detector/forest/forest.hpp"
#include "detector/training/augmentation/augmentation_settings.hpp"
#include "pipeline/base/settings_fields.hpp"

namespace houghstream::training {

/// Settings of the training of a forest: the images, and what is learnt from them.
struct TrainingSettings : AugmentationSettings {
  int trees = 15;
  int max_depth = 25;         ///< levels
  int min_samples = 20;       ///< a node with fewer becomes a leaf
  int tests_per_node = 2000;  ///< random pixel tests tried; where fewer samples choose, as many as these, or 64
  /// Fraction of the nodes that are split so that offsets agree; the others are split so that labels do (Gall et al.
  /// 2011 draw one or the other alike). It is always offsets where there is one label only, and labels where nearly all
  /// is background.
  double offset_fraction = 0.5;
  double single_pixel_fraction = 0.3;  ///< fraction of the tests that read one pixel alone, see PixelTest::kSinglePixel
  /// Smallest fraction of the tests on depth and on the surface, point histograms aside: these are the same in any
  /// light, without a comparison.
  double shape_single_pixel_fraction = 0.0;
  /// Fraction of the nodes that test point feature histograms only; the others never do. Background images contain
  /// nothing with the shape of an object, so point histograms would win nearly every node and the forest would not
  /// learn the object's colours.
  double histogram_fraction = 0.3;
  int node_samples = 1500;  ///< maximum number of samples that choose a node's test; all are then split by it
  /// The background weighs as much as all objects together, but at most as so many: what a patch is worth to an object
  /// does not depend on how many others were taught.
  float max_background_weight = 4.0F;
  double in_bag = 0.75;         ///< share of the images that a tree sees
  int max_leaf_votes = 12;      ///< offsets kept per leaf and class after merging
  int max_leaf_views = 12;      ///< maximum number of views per leaf and class that its votes support
  float merge_radius = 0.008F;  ///< offsets nearer than this to each other become one vote, metres
  Scoring scoring = Scoring::kEvidence;
  int validation_frames = 300;  ///< composed images on which the score learns what it is worth
};

template <typename Visit>
void fields(const TrainingSettings& settings, const Visit& visit) {
  using S = TrainingSettings;
  fields(static_cast<const AugmentationSettings&>(settings), visit);
  visit(number("trees", &S::trees, 1, 1000));
  visit(number("max_depth", &S::max_depth, 1, 60, "levels"));
  visit(number("min_samples", &S::min_samples, 1, 1000000));
  visit(number("tests_per_node", &S::tests_per_node, 1, 100000));
  visit(number("offset_fraction", &S::offset_fraction, 0, 1));
  visit(number("single_pixel_fraction", &S::single_pixel_fraction, 0, 1));
  visit(number("shape_single_pixel_fraction", &S::shape_single_pixel_fraction, 0, 1));
  visit(number("histogram_fraction", &S::histogram_fraction, 0, 1));
  visit(number("node_samples", &S::node_samples, 1, 1000000));
  visit(number("max_background_weight", &S::max_background_weight, 0, std::numeric_limits<double>::infinity()));
  visit(number("in_bag", &S::in_bag, 0, 1));
  visit(number("max_leaf_votes", &S::max_leaf_votes, 1, 255));
  visit(number("max_leaf_views", &S::max_leaf_views, 0, 255));
  visit(number("merge_radius", &S::merge_radius, 0, 10, "m"));
  visit(number("validation_frames", &S::validation_frames, 0, 100000));
}

}  // namespace houghstream::training
