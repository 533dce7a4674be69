#include "detector/detection_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "detector/baseline/scale_space_search.hpp"
#include "detector/evidence/attitude_spread.hpp"
#include "detector/evidence/view_alignment.hpp"
#include "detector/forest/seen_patches.hpp"
#include "detector/voting/boxes.hpp"
#include "detector/voting/maxima.hpp"
#include "detector/voting/voting.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream {
namespace {

using WeighedViews = std::vector<std::pair<std::uint32_t, float>>;

/// Appends the first views that most votes remember, compared with the frame; more where a class was taught in many
/// attitudes.
void compare_views(const Forest& forest, const Hypothesis& hypothesis, const LabFrame& frame, float spread,
                   const std::vector<std::uint32_t>& forgotten, std::vector<PlacedView>& compared) {
  constexpr float kViews = 8.0F;
  const auto wanted = static_cast<std::size_t>(kViews * spread);
  for (const auto& [view, weight] : hypothesis.views) {
    if (compared.size() == wanted) break;
    if (std::find(forgotten.begin(), forgotten.end(), view) != forgotten.end()) continue;
    const Eigen::Vector3f& centre = hypothesis.centre_camera;
    compared.push_back({view, centre, fit_view(forest.views[view], centre, frame)});
  }
}

/// A hypothesis and whose it is.
struct ClassHypothesis {
  std::size_t class_index = 0;
  float spread = 1.0F;  // attitude_spread of the class
  Hypothesis hypothesis;
};

/// Completes the evidence by the view that agrees best with the frame, aligned with it. What is hopeless where it
/// stands is left there: most maxima are of that kind, and aligning takes longer than all else about them.
void add_best_fit(const Forest& forest, const ScoreModel& model, const LabFrame& frame,
                  const std::vector<PlacedView>& compared, Evidence& evidence) {
  constexpr float kHopeless = 0.05F;  // score
  if (compared.empty()) return;
  evidence.fit = best_unaligned(compared).fit;
  if (score(model, evidence) < kHopeless) return;
  const PlacedView best = best_aligned(forest.views, compared, frame);
  evidence.fit = best.fit;
  evidence.other_size = gain_of_other_size(forest.views[best.view], best, frame);
}

/// Views and how much they speak for their rotation, heaviest first: the votes that remember them. Of a class that was
/// taught in many attitudes the views lie far apart, and how they agree with the frame says more; `weighed` holds them.
const WeighedViews& weighed_views(const Hypothesis& hypothesis, float spread, const std::vector<PlacedView>& compared,
                                  WeighedViews& weighed) {
  constexpr float kSharpness = 4.0F;
  if (spread == 1.0F || compared.empty()) return hypothesis.views;
  weighed.clear();
  for (const PlacedView& seen : compared) weighed.emplace_back(seen.view, std::exp(kSharpness * agreement(seen.fit)));
  std::stable_sort(weighed.begin(), weighed.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return weighed;
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

Candidate to_candidate(const Forest& forest, const ClassHypothesis& found, const SeenPatches& seen,
                       const LabFrame& frame, const DetectionSettings& settings,
                       const std::vector<std::uint32_t>& forgotten) {
  const ObjectClass& object = forest.classes[found.class_index];
  const Hypothesis& hypothesis = found.hypothesis;
  const float spread = found.spread;
  static thread_local std::vector<PlacedView> compared;  // both kept from candidate to candidate
  static thread_local WeighedViews weighed;
  compared.clear();
  Candidate candidate;
  Detection& detection = candidate.detection;
  candidate.evidence.mass_share = hypothesis.mass / object.expected_mass;
  candidate.evidence.certainty =
      hypothesis.weight / static_cast<float>(std::max<std::size_t>(hypothesis.patches.size(), 1));
  candidate.evidence.distance = hypothesis.centre_camera.norm();
  detection.box_px = backprojected_box(forest, hypothesis, seen.grid, frame.frame.camera);
  detection.score = vote_score(candidate.evidence.mass_share);
  if (forest.scoring == Scoring::kEvidence) {
    compare_views(forest, hypothesis, frame, spread, forgotten, compared);
    add_best_fit(forest, object.score_model, frame, compared, candidate.evidence);
    detection.score = score(object.score_model, candidate.evidence);
    detection.box_px = visible_box(detection.box_px, candidate.evidence.fit.visible_box_px, frame.frame.camera);
  }
  detection.class_id = object.class_id;
  detection.class_name = object.name;
  detection.centre_camera = hypothesis.centre_camera;
  detection.vote_weight = hypothesis.weight;
  detection.vote_count = hypothesis.vote_count;
  if (detection.score < settings.threshold) return candidate;  // most, whose rotations nobody will ask for
  const Eigen::Quaternionf R_camera_ray(ray_rotation(hypothesis.centre_camera));
  const auto room = static_cast<std::size_t>(std::max(settings.max_rotations, 0));
  detection.rotations.reserve(std::min(room, hypothesis.views.size()));
  for (const auto& [view, weight] : weighed_views(hypothesis, spread, compared, weighed)) {
    if (detection.rotations.size() >= room) break;
    detection.rotations.push_back({R_camera_ray * Eigen::Quaternionf(forest.views[view].R_ray_object), weight});
  }
  return candidate;
}

std::vector<Hypothesis> class_hypotheses(const Forest& forest, std::size_t class_index, const SeenPatches& seen,
                                         const DetectionSettings& settings) {
  static thread_local HoughSpace space;  // its memory is kept from class to class
  cast_votes(forest, static_cast<int>(class_index), seen.grid, seen.beliefs, seen.hough_camera, settings, space);
  const float least_mass = settings.min_mass_share * forest.classes[class_index].expected_mass;
  std::vector<Hypothesis> hypotheses =
      find_hypotheses(forest, space, seen.grid, seen.hough_camera, least_mass, settings);
  if (hypotheses.size() > static_cast<std::size_t>(settings.max_per_class)) {
    hypotheses.resize(static_cast<std::size_t>(settings.max_per_class));
  }
  return hypotheses;
}

/// The classes, those with the most to do first, so that no thread starts with one when the others have ended.
std::vector<std::size_t> by_work(const Forest& forest, const PatchBeliefs& beliefs) {
  std::vector<std::size_t> work(forest.classes.size(), 0);
  std::vector<std::size_t> order(work.size());
  for (std::size_t c = 0; c < work.size(); ++c) {
    order[c] = c;
    beliefs.for_believers(static_cast<int>(c),
                          [&](std::uint32_t, const std::uint32_t*, std::uint32_t count) { work[c] += count; });
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return work[a] > work[b]; });
  return order;
}

/// Of all classes, class by class; `meanwhile` is done by a thread that finds no class left.
std::vector<ClassHypothesis> all_hypotheses(const Forest& forest, const SeenPatches& seen,
                                            const DetectionSettings& settings, const std::function<void()>& meanwhile) {
  DetectionSettings each = settings;
  each.candidates_per_class = candidates_of_each(settings, forest.classes.size());
  const std::vector<std::size_t> order = by_work(forest, seen.beliefs);
  std::vector<std::vector<Hypothesis>> by_class(order.size());
  const auto classes = static_cast<int>(order.size());
  parallel_for(settings.threads, classes + 1, [&](int i) {
    if (i == classes) return meanwhile();
    const std::size_t c = order[static_cast<std::size_t>(i)];
    by_class[c] = class_hypotheses(forest, c, seen, each);
  });
  std::vector<ClassHypothesis> all;
  std::size_t count = 0;
  for (const std::vector<Hypothesis>& own : by_class) count += own.size();
  all.reserve(count);
  for (std::size_t c = 0; c < by_class.size(); ++c) {
    if (by_class[c].empty()) continue;
    const float spread = attitude_spread(forest, static_cast<std::uint32_t>(c));
    for (Hypothesis& hypothesis : by_class[c]) all.push_back({c, spread, std::move(hypothesis)});
  }
  return all;
}

}  // namespace

std::vector<Candidate> find_candidates(const Forest& forest, const RgbdFrame& frame, const DetectionSettings& settings,
                                       StageClock& clock, const std::vector<std::uint32_t>& forgotten) {
  if (forest.features.handling == ScaleHandling::kScaleSpace) {
    return search_scale_space(forest, frame, settings, clock);
  }
  static thread_local SeenPatches seen_here;  // its memory is kept from frame to frame
  const SeenPatches& seen = seen_here;        // the same for the threads below
  classify_patches(forest, frame, settings, clock, seen_here);
  std::optional<LabFrame> in_lab;
  const std::vector<ClassHypothesis> found = all_hypotheses(forest, seen, settings, [&] {  // Section 2
    in_lab.emplace(make_lab_frame(frame, seen.colour, forest.features.image_scale));
  });
  std::vector<Candidate> all(found.size());
  parallel_for(settings.threads, static_cast<int>(found.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    all[at] = to_candidate(forest, found[at], seen, *in_lab, settings, forgotten);
  });
  clock.mark("detect.voting");
  return all;
}

}  // namespace houghstream
