#include "detector/baseline/baseline_scales.hpp"

#include <algorithm>
#include <cmath>

#include "detector/baseline/scale_space_search.hpp"
#include "detector/baseline/surface_planes.hpp"
#include "detector/training/augmentation/sensor_errors.hpp"

namespace houghstream::baseline {
namespace {

using training::DistanceRange;
using training::ShownPoint;

/// Depth normalisation, with surface features too.
class SurfaceScales : public training::DepthNormalisedScales {
 public:
  void require_teachable(const FeatureSettings&, const std::string&) const override {}

  ExtraPlanes extra_planes(const WorkingFrame& frame, const FeatureSettings& settings) const override {
    return baseline::extra_planes(frame, settings, 1);
  }

  std::vector<ScoredHypothesis> search(const SearchContext& search, const RgbdFrame& frame,
                                       DetectorWorkspace& workspace) const override {
    make_working_images(search, frame, workspace);
    compute_features_by(Way::kFast, search, workspace);
    find_posteriors(search, workspace);
    const std::vector<Hypothesis> hypotheses = find_hypotheses(search, workspace);
    return score_hypotheses(search, frame, hypotheses, workspace);
  }
};

/// Several sizes of the image (Gall et al. 2011), see ScaleHandling::kScaleSpace.
class ScaleSpaceScales : public training::Scales {
 public:
  void require_teachable(const FeatureSettings&, const std::string&) const override {}

  std::vector<FeatureLevel> levels(const FeatureSettings& settings, const Camera&) const override {
    return scale_space_levels(settings);
  }

  FeatureLevel level_for(double, const Camera&, const FeatureSettings& settings, Random&) const override {
    return {settings.image_scale, 1.0F, 0.0F, 0.0F};
  }

  bool teaches(const FeatureLevel&, float) const override { return true; }

  WorkingFrame working_frame(const RgbdFrame& frame, const FeatureLevel& level,
                             const FeatureSettings& settings) const override {
    return scale_space_frame(frame, level, settings);
  }

  ExtraPlanes extra_planes(const WorkingFrame& frame, const FeatureSettings& settings) const override {
    return baseline::extra_planes(frame, settings, 1);
  }

  /// Returns distances about that at which it was taught, since sizes between those that are searched must be known
  /// too.
  DistanceRange distances(double taught, const DistanceRange&) const override {
    constexpr double kHalfStep = 1.25;  // half a step of the searched scales
    return {taught / kHalfStep, taught * kHalfStep};
  }

  double counted_distance(double) const override { return 1.0; }

  bool needs_measured_depth() const override { return false; }

  /// Changes depth as the enlarged images show it where features read it, see add_far_noise.
  void vary_depth(double distance, const FeatureSettings& settings, cv::Mat& depth, Random& random) const override {
    if (settings.families == kIntensity) return;
    const double farthest = *std::max_element(settings.scales.begin(), settings.scales.end());
    training::add_far_noise(distance, std::exp(random.uniform(0.0, std::log(farthest))), depth, random);
  }

  std::int32_t scale_of_patch(const PatchSettings& patch, const Camera&, float) const override {
    return limited_scale(patch, patch.unit);
  }

  /// Returns the offset from pixel to pixel, as if 1 m away.
  Eigen::Vector3f centre_offset(const TrainingView& view, const ShownPoint& point) const override {
    const Camera& camera = view.frame.camera;
    const Eigen::Vector2d centre_px = camera.project(view.T_camera_object.translation());
    const Eigen::Vector2d offset = (centre_px - Eigen::Vector2d(point.view_px.x, point.view_px.y)) * point.scale;
    return {static_cast<float>(offset.x() / camera.fx), static_cast<float>(offset.y() / camera.fy), 0.0F};
  }

  std::vector<ScoredHypothesis> search(const SearchContext& search, const RgbdFrame& frame,
                                       DetectorWorkspace&) const override {
    StageClock clock;
    return search_scale_space(search, Way::kFast, frame, clock);
  }
};

}  // namespace

const training::Scales& scales_of(const FeatureSettings& settings) {
  static const SurfaceScales surfaces;
  static const ScaleSpaceScales scale_space;
  if (settings.handling == ScaleHandling::kScaleSpace) return scale_space;
  return surfaces;
}

}  // namespace houghstream::baseline
