#include "detector/training/augmentation/scales.hpp"

namespace houghstream::training {

void DepthNormalisedScales::require_teachable(const FeatureSettings& settings, const std::string& source) const {
  require_searchable(settings, source);
}

std::vector<FeatureLevel> DepthNormalisedScales::levels(const FeatureSettings& settings, const Camera& camera) const {
  return feature_levels(settings, camera);
}

FeatureLevel DepthNormalisedScales::level_for(double distance, const Camera& camera, const FeatureSettings& settings,
                                              Random& random) const {
  const std::vector<FeatureLevel> all = feature_levels(settings, camera);
  return distance * random.uniform(0.9, 1.1) > all[0].max_distance ? all.back() : all[0];
}

bool DepthNormalisedScales::teaches(const FeatureLevel& level, float depth) const {
  return depth > 0.85F * level.min_distance && depth <= 1.15F * level.max_distance;
}

WorkingFrame DepthNormalisedScales::working_frame(const RgbdFrame& frame, const FeatureLevel& level,
                                                  const FeatureSettings& settings) const {
  return make_working_frame(frame, level, settings);
}

ExtraPlanes DepthNormalisedScales::extra_planes(const WorkingFrame&, const FeatureSettings&) const {
  return {};
}

DistanceRange DepthNormalisedScales::distances(double, const DistanceRange& wanted) const {
  return wanted;
}

double DepthNormalisedScales::counted_distance(double distance) const {
  return distance;
}

bool DepthNormalisedScales::needs_measured_depth() const {
  return true;
}

void DepthNormalisedScales::vary_depth(double, const FeatureSettings&, cv::Mat&, Random&) const {}

std::int32_t DepthNormalisedScales::scale_of_patch(const PatchSettings& patch, const Camera& camera,
                                                   float depth) const {
  return patch_scale(patch, camera.fx, depth);
}

Eigen::Vector3f DepthNormalisedScales::centre_offset(const TrainingView& view, const ShownPoint& point) const {
  const Eigen::Vector3d surface = view.frame.camera.backproject(point.view_px.x, point.view_px.y, point.depth);
  const Eigen::Vector3d offset = view.T_camera_object.translation() - surface;
  return ray_rotation(surface.cast<float>()).transpose() * offset.cast<float>();
}

std::vector<ScoredHypothesis> DepthNormalisedScales::search(const SearchContext& search, const RgbdFrame& frame,
                                                            DetectorWorkspace& workspace) const {
  make_working_images(search, frame, workspace);
  compute_features(search, workspace);
  find_posteriors(search, workspace);
  const std::vector<Hypothesis> hypotheses = find_hypotheses(search, workspace);
  return score_hypotheses(search, frame, hypotheses, workspace);
}

const Scales& depth_normalised_scales() {
  static const DepthNormalisedScales scales;
  return scales;
}

}  // namespace houghstream::training
