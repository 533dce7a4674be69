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
                                    const PatchLeaves& leaves, const WorkingFrame& frame, const Camera& camera,
                                    const DetectionSettings& settings) {
  const ObjectClass& object = forest.classes[static_cast<std::size_t>(class_index)];
  const HoughSpace space = cast_votes(forest, class_index, patches, leaves, frame.camera, settings);
  std::vector<Detection> detections;
  const auto to_full = static_cast<float>(camera.fx / frame.camera.fx);
  const float least_mass = settings.threshold * object.expected_mass;
  for (const Hypothesis& hypothesis : find_maxima(forest, space, patches, frame.camera, least_mass, settings)) {
    if (detections.size() >= static_cast<std::size_t>(settings.max_per_class)) break;
    const cv::Rect2f box = backprojected_box(forest, hypothesis, patches, frame.camera, settings.stride);
    const cv::Rect2f full((box.x + 0.5F) * to_full, (box.y + 0.5F) * to_full, box.width * to_full,
                          box.height * to_full);
    detections.push_back(to_detection(forest, object, hypothesis, full, settings.max_rotations));
  }
  return detections;
}

}  // namespace

Detections Detector::detect(const RgbdFrame& frame) const {
  const Forest& forest = state_->forest;
  const DetectionSettings& settings = state_->settings;
  check_frame(frame, "detector");
  StageClock clock;

  const WorkingFrame working = make_working_frame(frame, forest.features);  // Section 5.1.1
  clock.mark("detect.resize");
  const FeatureImage features = compute_features(working, forest.features);  // Section 3
  clock.mark("detect.features");
  const PatchGrid patches = make_patch_grid(working, forest.patch, settings.stride);  // Section 5.1.3
  PatchLeaves leaves;
  leaves.leaves = assign_leaves(forest, features, patches, settings.threads);
  leaves.probabilities = class_probabilities(forest, leaves.leaves, settings.threads);  // Section 5.1.2
  clock.mark("detect.forest");

  const int class_count = static_cast<int>(forest.classes.size());
  std::vector<std::vector<Detection>> by_class(forest.classes.size());
  parallel_for(settings.threads, class_count, [&](int c) {  // Section 2
    by_class[static_cast<std::size_t>(c)] = detect_class(forest, c, patches, leaves, working, frame.camera, settings);
  });
  clock.mark("detect.voting");

  Detections out;
  out.utime = frame.utime;
  for (std::vector<Detection>& detections : by_class) {
    std::move(detections.begin(), detections.end(), std::back_inserter(out.detections));
  }
  out.detections = suppress_overlaps(std::move(out.detections), settings.max_overlap);
  clock.mark("detect.hypotheses");
  out.stages = frame.stages;
  out.stages.insert(out.stages.end(), clock.times().begin(), clock.times().end());
  return out;
}

}  // namespace houghstream
