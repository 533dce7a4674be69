#include "detector/detector.hpp"

#include <algorithm>
#include <utility>

#include "detector/features.hpp"
#include "detector/hypotheses.hpp"
#include "detector/traversal.hpp"
#include "detector/voting.hpp"
#include "detector/working_frame.hpp"
#include "pipeline/parallel.hpp"

namespace houghstream {

struct Detector::State {
  Forest forest;
  DetectionSettings settings;
};

Detector::Detector(Forest forest, DetectionSettings settings)
    : state_(std::make_unique<State>(State{std::move(forest), settings})) {}
Detector::~Detector() = default;
Detector::Detector(Detector&&) noexcept = default;

const Forest& Detector::forest() const {
  return state_->forest;
}

namespace {

Detection to_detection(const Forest& forest, const ObjectClass& object, const Hypothesis& hypothesis,
                       const cv::Rect2f& box_px, int max_rotations) {
  Detection detection;
  detection.class_id = object.class_id;
  detection.class_name = object.name;
  detection.score = hypothesis.mass / object.expected_mass;
  detection.box_px = box_px;
  detection.centre_camera = hypothesis.centre_camera;
  detection.vote_weight = hypothesis.weight;
  detection.vote_count = hypothesis.vote_count;
  const Eigen::Quaternionf R_camera_ray(ray_rotation(hypothesis.centre_camera));
  for (const auto& [view, weight] : hypothesis.views) {
    if (detection.rotations.size() >= static_cast<std::size_t>(max_rotations)) break;
    detection.rotations.push_back({R_camera_ray * Eigen::Quaternionf(forest.views[view].R_ray_object), weight});
  }
  return detection;
}

/// All detections of one class in full-size pixels.
std::vector<Detection> detect_class(const Forest& forest, int class_index, const PatchGrid& patches,
                                    const PatchLeaves& leaves, const Camera& hough_camera, const Camera& camera,
                                    const DetectionSettings& settings) {
  const ObjectClass& object = forest.classes[static_cast<std::size_t>(class_index)];
  const HoughSpace space = cast_votes(forest, class_index, patches, leaves, hough_camera, settings);
  std::vector<Detection> detections;
  const float least_mass = settings.threshold * object.expected_mass;
  for (const Hypothesis& hypothesis : find_maxima(forest, space, patches, hough_camera, least_mass, settings)) {
    if (detections.size() >= static_cast<std::size_t>(settings.max_per_class)) break;
    const cv::Rect2f box_px = backprojected_box(forest, hypothesis, patches, camera);
    detections.push_back(to_detection(forest, object, hypothesis, box_px, settings.max_rotations));
  }
  return detections;
}

}  // namespace

Detections Detector::detect(const RgbdFrame& frame) const {
  const Forest& forest = state_->forest;
  const DetectionSettings& settings = state_->settings;
  check_frame(frame, "detector");
  StageClock clock;

  const auto levels = feature_levels(forest.features);
  std::vector<WorkingFrame> working;
  for (const FeatureLevel& level : levels) {  // Section 5.1.1
    working.push_back(make_working_frame(frame, level.scale, forest.features));
  }
  clock.mark("detect.resize");
  std::vector<FeatureImage> features;
  for (const WorkingFrame& view : working) {  // Section 3
    features.push_back(compute_features(view, forest.features, settings.threads));
  }
  clock.mark("detect.features");
  PatchGrid patches;
  for (std::size_t l = 0; l < levels.size(); ++l) {  // Section 5.1.3
    add_patches(working[l], levels[l], static_cast<std::uint8_t>(l), forest.patch, settings.stride, patches);
  }
  PatchLeaves leaves;
  leaves.leaves = assign_leaves(forest, features, patches, settings.threads);  // Section 5.1.2
  leaves.probabilities = class_probabilities(forest, leaves.leaves, settings.threads);
  clock.mark("detect.forest");

  const int class_count = static_cast<int>(forest.classes.size());
  std::vector<std::vector<Detection>> by_class(forest.classes.size());
  parallel_for(settings.threads, class_count, [&](int c) {  // Section 2
    by_class[static_cast<std::size_t>(c)] =
        detect_class(forest, c, patches, leaves, working[0].camera, frame.camera, settings);
  });
  clock.mark("detect.voting");

  Detections out;
  out.utime = frame.utime;
  for (std::vector<Detection>& detections : by_class) {
    std::move(detections.begin(), detections.end(), std::back_inserter(out.detections));
  }
  out.detections = suppress_overlaps(std::move(out.detections), settings);
  clock.mark("detect.hypotheses");
  out.stages = frame.stages;
  out.stages.insert(out.stages.end(), clock.times().begin(), clock.times().end());
  return out;
}

}  // namespace houghstream
