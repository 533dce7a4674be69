#include "detector/detection_candidates.hpp"

#include <algorithm>
#include <utility>

#include "detector/evidence/view_alignment.hpp"
#include "detector/hypotheses.hpp"
#include "detector/scale_space_search.hpp"
#include "detector/seen_patches.hpp"
#include "detector/voting.hpp"
#include "pipeline/parallel.hpp"

namespace houghstream {
namespace {

/// The remembered view that agrees best with the frame, of those that most votes remember.
ViewFit best_fit(const Forest& forest, const Hypothesis& hypothesis, const LabFrame& frame,
                 const std::vector<std::uint32_t>& forgotten) {
  constexpr int kViews = 8;
  ViewFit best;
  std::uint32_t best_view = 0;
  int compared = 0;
  for (const auto& [view, weight] : hypothesis.views) {
    if (compared == kViews) break;
    if (std::find(forgotten.begin(), forgotten.end(), view) != forgotten.end()) continue;
    const ViewFit fit = fit_view(forest.views[view], hypothesis.centre_camera, frame);
    if (compared++ != 0 && agreement(fit) <= agreement(best)) continue;
    best = fit;
    best_view = view;
  }
  return compared == 0 ? best : align_view(forest.views[best_view], hypothesis.centre_camera, best, frame);
}

/// Votes say which patches belong to the object, depth says where the remembered view is not hidden: their errors are
/// different ones, so the sides are taken midway.
cv::Rect2f visible_box(const cv::Rect2f& voted, const cv::Rect2f& fitted, const Camera& camera) {
  const cv::Rect2f inside =
      fitted & cv::Rect2f(0.0F, 0.0F, static_cast<float>(camera.width), static_cast<float>(camera.height));
  if (inside.empty()) return voted;
  return {0.5F * (voted.x + inside.x), 0.5F * (voted.y + inside.y), 0.5F * (voted.width + inside.width),
          0.5F * (voted.height + inside.height)};
}

Candidate to_candidate(const Forest& forest, const ObjectClass& object, const Hypothesis& hypothesis,
                       const SeenPatches& seen, const LabFrame& frame, int max_rotations,
                       const std::vector<std::uint32_t>& forgotten) {
  Candidate candidate;
  Detection& detection = candidate.detection;
  candidate.evidence.mass_share = hypothesis.mass / object.expected_mass;
  detection.box_px = backprojected_box(forest, hypothesis, seen.grid, frame.frame.camera);
  detection.score = vote_score(candidate.evidence.mass_share);
  if (forest.scoring == Scoring::kEvidence) {
    ViewFit& fit = candidate.evidence.fit;
    fit = best_fit(forest, hypothesis, frame, forgotten);
    detection.score = score(object.score_model, candidate.evidence);
    detection.box_px = visible_box(detection.box_px, fit.visible_box_px, frame.frame.camera);
  }
  detection.class_id = object.class_id;
  detection.class_name = object.name;
  detection.centre_camera = hypothesis.centre_camera;
  detection.vote_weight = hypothesis.weight;
  detection.vote_count = hypothesis.vote_count;
  const Eigen::Quaternionf R_camera_ray(ray_rotation(hypothesis.centre_camera));
  for (const auto& [view, weight] : hypothesis.views) {
    if (detection.rotations.size() >= static_cast<std::size_t>(max_rotations)) break;
    detection.rotations.push_back({R_camera_ray * Eigen::Quaternionf(forest.views[view].R_ray_object), weight});
  }
  return candidate;
}

std::vector<Candidate> class_candidates(const Forest& forest, int class_index, const SeenPatches& seen,
                                        const LabFrame& frame, const DetectionSettings& settings,
                                        const std::vector<std::uint32_t>& forgotten) {
  const ObjectClass& object = forest.classes[static_cast<std::size_t>(class_index)];
  const HoughSpace space = cast_votes(forest, class_index, seen.grid, seen.beliefs, seen.hough_camera, settings);
  const float least_mass = settings.min_mass_share * object.expected_mass;
  std::vector<Candidate> candidates;
  for (const Hypothesis& hypothesis : find_maxima(forest, space, seen.grid, seen.hough_camera, least_mass, settings)) {
    if (candidates.size() >= static_cast<std::size_t>(settings.max_per_class)) break;
    candidates.push_back(to_candidate(forest, object, hypothesis, seen, frame, settings.max_rotations, forgotten));
  }
  return candidates;
}

}  // namespace

std::vector<Candidate> find_candidates(const Forest& forest, const RgbdFrame& frame, const DetectionSettings& settings,
                                       StageClock& clock, const std::vector<std::uint32_t>& forgotten) {
  if (forest.features.handling == ScaleHandling::kScaleSpace) {
    return search_scale_space(forest, frame, settings, clock);
  }
  const SeenPatches seen = classify_patches(forest, frame, settings, clock);
  const LabFrame in_lab = make_lab_frame(frame, seen.colour, forest.features.image_scale);
  std::vector<std::vector<Candidate>> by_class(forest.classes.size());
  parallel_for(settings.threads, static_cast<int>(by_class.size()), [&](int c) {  // Section 2
    by_class[static_cast<std::size_t>(c)] = class_candidates(forest, c, seen, in_lab, settings, forgotten);
  });
  std::vector<Candidate> all;
  for (std::vector<Candidate>& candidates : by_class) {
    std::move(candidates.begin(), candidates.end(), std::back_inserter(all));
  }
  clock.mark("detect.voting");
  return all;
}

}  // namespace houghstream
