#pragma once

#include <array>
#include <cstdint>

namespace houghstream {

/// How one object is known at every distance.
enum class ScaleHandling : std::uint32_t {
  kDepthNormalised = 0,  ///< tests and offsets are divided by the measured depth (paper, Section 5.1.2)
  /// The image is searched in several sizes (Gall et al. 2011). Nothing is known of depth: lengths on the object count
  /// as if it stood 1 m away, metres = working pixels / (image_scale * focal length), and centres have no depth.
  kScaleSpace = 1,
};

/// What a detection's score is.
enum class Scoring : std::uint32_t {
  kEvidence = 0,  ///< a calibrated probability from votes and from how remembered views fit, see score.hpp
  kVotes = 1,     ///< vote mass over that of a wholly visible object, at most 1 (the paper's confidence)
};

constexpr int kMaxScales = 5;

/// How a frame becomes feature planes. Stored in the forest file: training and detection must agree.
struct FeatureSettings {
  std::uint32_t families = 15;  ///< see FeatureFamily; default: the paper's final features (Section 4, end)
  ScaleHandling handling = ScaleHandling::kDepthNormalised;
  std::array<float, kMaxScales> scales{};  ///< of a scale space: sizes of the image searched, 0 = unused
  float image_scale = 0.5F;                ///< working size over frame size for near surfaces (paper, Section 5.1.1)
  float far_distance = 1.2F;       ///< surfaces beyond are looked at in twice that size, metres: see feature_levels
  float max_distance = 2.8F;       ///< surfaces beyond belong to no object that was taught, metres
  int depth_sobel_px = 7;          ///< kernel of the depth derivatives, working pixels (paper, Section 4.3)
  int min_max_px = 5;              ///< neighbourhood of minimum and maximum, working pixels (paper, Section 3)
  float fill_distance_px = 24.0F;  ///< how far from measured depth a pixel may borrow it, working pixels
  /// ... or metres on the surface that it borrows from, if those are more pixels, see HoleReach. 0, and in a scale
  /// space: the nearest pixel lends, whatever its depth.
  float fill_distance = 0.06F;
};

/// How patches are tested. Stored in the forest file.
struct PatchSettings {
  /// Metres per step of a test offset on the object (depth normalisation, Section 5.1.2); in a scale space, working
  /// pixels per step.
  float unit = 0.002F;
  int radius = 10;  ///< test offsets reach from -radius to +radius steps
};

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
  int patches_per_view = 250;   ///< per training view, and per background frame
  int composites_per_view = 3;  ///< pictures made of one view: other background, distance and light
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
  int max_leaf_votes = 12;       ///< offsets kept per leaf and class after merging
  int max_leaf_views = 12;       ///< remembered training views per leaf and class
  float merge_radius = 0.008F;   ///< offsets nearer than this to each other become one vote, metres
  Scoring scoring = Scoring::kEvidence;
  int validation_frames = 300;  ///< composed pictures on which the score learns what it is worth
  double dazzled_share = 0.5;   ///< of these, in which what is near has lost most of its depth, see lose_near_depth
  double misfit = 1.0;          ///< in all of these: how much depth strays from colour and views, see misfits.hpp
  std::uint64_t seed = 1;
  int threads = 2;
};

/// How a frame is searched.
struct DetectionSettings {
  int threads = 2;
  bool readable = false;  ///< patch by patch, tree by tree: the same leaves, but slowly
  int stride = 2;         ///< patch offset, working pixels (paper, Section 5.1.3)
  /// Metres between patches: where the stride puts them nearer to each other, some are left out, see PatchSpacing;
  /// 0 = none are. With depth normalisation only.
  float patch_spacing = 0.022F;
  /// A patch walks down so many trees first, and down the rest only if the mean of what their leaves are most certain
  /// of reaches min_first_share; 0 = every patch walks down all trees.
  int first_trees = 3;
  float min_first_share = 0.1F;
  /// Smallest score that is reported: in development_world_20 to 67 95 % of the detections from 0.72 on are true.
  float threshold = 0.75F;
  float min_mass_share = 0.02F;     ///< of a class's expected mass, for a maximum to be looked at
  int max_per_class = 250;          ///< at most so many detections of one class (paper, Section 4)
  float min_class_share = 0.1F;     ///< of its leaves, from which a patch votes for a class
  int candidates_per_class = 24;    ///< maxima of the Hough image that are looked at in 3-D, see candidates_of_each
  float min_relative_peak = 0.05F;  ///< of the Hough image's highest value, for a maximum to be looked at
  float hough_sigma_px = 3.0F;      ///< smoothing of the Hough image, working pixels
  float vote_sigma = 0.016F;        ///< bandwidth of the 3-D maximum, metres
  float max_overlap = 0.5F;         ///< a weaker box of another object may overlap a stronger one by this IoU
  float dominance =
      2.0F;  ///< ... if that one is more likely than not and so many times as likely; of its own class always
  int max_rotations = 48;  ///< rotations handed to the pose process
};

}  // namespace houghstream
