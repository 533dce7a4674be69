#pragma once

#include <string>
#include <vector>

#include "detector/stages.hpp"
#include "pipeline/base/random.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream::training {

/// Distances, metres.
struct DistanceRange {
  double nearest = 0.0;
  double farthest = 0.0;
};

/// Pixel of a view that a pixel of a composed image shows.
struct ShownPoint {
  cv::Point2d view_px;
  float depth = 0.0F;  ///< depth in the view, metres
  double scale = 1.0;  ///< size in the image over size in the view
};

/// Handling of distances during training: ScaleHandling, and the features beyond the product's. The product has
/// depth_normalised_scales() only; the baseline passes others to the trainer.
class Scales {
 public:
  Scales() = default;
  Scales(const Scales&) = delete;
  Scales& operator=(const Scales&) = delete;
  virtual ~Scales() = default;

  /// Throws InputError in one line that names `source`, what it needs and who has it, where such a forest cannot be
  /// taught in this way.
  virtual void require_teachable(const FeatureSettings& settings, const std::string& source) const = 0;

  /// Returns the sizes at which the images of a camera are looked at.
  virtual std::vector<FeatureLevel> levels(const FeatureSettings& settings, const Camera& camera) const = 0;
  /// Returns the level that sees an object at this distance.
  virtual FeatureLevel level_for(double distance, const Camera& camera, const FeatureSettings& settings,
                                 Random& random) const = 0;
  /// Returns whether a level learns from a surface at this depth.
  virtual bool teaches(const FeatureLevel& level, float depth) const = 0;
  /// Returns the frame as a level works on it, its holes filled as far as holes reach.
  virtual WorkingFrame working_frame(const RgbdFrame& frame, const FeatureLevel& level,
                                     const FeatureSettings& settings) const = 0;
  /// Returns the planes that compute_features needs beside its own.
  virtual ExtraPlanes extra_planes(const WorkingFrame& frame, const FeatureSettings& settings) const = 0;

  /// Returns the distances for an object that was taught at `taught` metres; `wanted` are those of the settings.
  virtual DistanceRange distances(double taught, const DistanceRange& wanted) const = 0;
  /// Returns the distance at which areas and boxes count that are seen at this one.
  virtual double counted_distance(double distance) const = 0;
  /// Returns whether patches of an object need measured depth, and not depth filled into holes.
  virtual bool needs_measured_depth() const = 0;
  /// Adds what the other sizes of an image do to the depth of an object at this distance.
  virtual void vary_depth(double distance, const FeatureSettings& settings, cv::Mat& depth, Random& random) const = 0;
  /// Returns PatchView::scale of a patch whose centre lies at this depth.
  virtual std::int32_t scale_of_patch(const PatchSettings& patch, const Camera& camera, float depth) const = 0;
  /// Returns the offset from a surface point to the object's centre, as a leaf stores it.
  virtual Eigen::Vector3f centre_offset(const TrainingView& view, const ShownPoint& point) const = 0;

  /// Returns the scored hypotheses of the forest in a frame, by the stages of a search up to the evidence.
  virtual std::vector<ScoredHypothesis> search(const SearchContext& search, const RgbdFrame& frame,
                                               DetectorWorkspace& workspace) const = 0;
};

/// Depth normalisation (paper, Section 5.1.2).
class DepthNormalisedScales : public Scales {
 public:
  void require_teachable(const FeatureSettings& settings, const std::string& source) const override;
  std::vector<FeatureLevel> levels(const FeatureSettings& settings, const Camera& camera) const override;
  /// Returns either level near the limit between two.
  FeatureLevel level_for(double distance, const Camera& camera, const FeatureSettings& settings,
                         Random& random) const override;
  /// Returns true also a little beyond what the level holds, since detection decides by noisy depth.
  bool teaches(const FeatureLevel& level, float depth) const override;
  WorkingFrame working_frame(const RgbdFrame& frame, const FeatureLevel& level,
                             const FeatureSettings& settings) const override;
  ExtraPlanes extra_planes(const WorkingFrame& frame, const FeatureSettings& settings) const override;
  DistanceRange distances(double taught, const DistanceRange& wanted) const override;
  double counted_distance(double distance) const override;
  bool needs_measured_depth() const override;
  void vary_depth(double distance, const FeatureSettings& settings, cv::Mat& depth, Random& random) const override;
  std::int32_t scale_of_patch(const PatchSettings& patch, const Camera& camera, float depth) const override;
  /// Returns the offset in the ray frame of the pixel that shows the point.
  Eigen::Vector3f centre_offset(const TrainingView& view, const ShownPoint& point) const override;
  std::vector<ScoredHypothesis> search(const SearchContext& search, const RgbdFrame& frame,
                                       DetectorWorkspace& workspace) const override;
};

const Scales& depth_normalised_scales();

}  // namespace houghstream::training
