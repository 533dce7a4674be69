#include "detector/evidence/candidates.hpp"

#include <algorithm>
#include <cmath>

namespace houghstream {
namespace {

using WeighedViews = std::vector<std::pair<std::uint32_t, float>>;

/// Compares the first views that most votes remember with the frame; more where a class was taught in many attitudes.
void compare_views(const EvidenceInput& input, const Hypothesis& hypothesis, float spread,
                   std::vector<PlacedView>& compared) {
  constexpr float kViews = 8.0F;
  const auto wanted = static_cast<std::size_t>(kViews * spread);
  const std::vector<std::uint32_t>& excluded = input.excluded_views;
  for (const auto& [view, weight] : hypothesis.views) {
    if (compared.size() == wanted) break;
    if (std::find(excluded.begin(), excluded.end(), view) != excluded.end()) continue;
    const Eigen::Vector3f& centre = hypothesis.centre_camera;
    compared.push_back({view, centre, fit_view(input.forest.views[view], centre, input.frame)});
  }
}

/// Completes the evidence by the view that agrees best with the frame, aligned with it. What is hopeless where it
/// stands is left there: most maxima are of that kind, and aligning takes longer than all else about them.
void add_best_fit(const EvidenceInput& input, const ScoreModel& model, const std::vector<PlacedView>& compared,
                  Evidence& evidence) {
  constexpr float kHopeless = 0.05F;  // score
  if (compared.empty()) return;
  const std::vector<TrainedView>& views = input.forest.views;
  evidence.fit = best_unaligned(compared).fit;
  if (score(model, evidence) < kHopeless) return;
  const PlacedView best = best_aligned(views, compared, input.frame);
  evidence.fit = best.fit;
  evidence.other_size = gain_of_other_size(views[best.view], best, input.frame);
}

/// Views and how much they speak for their rotation, heaviest first: the votes that remember them. Of a class that was
/// taught in many attitudes the views lie far apart, and how they agree with the frame says more.
const WeighedViews& weighed_views(const Hypothesis& hypothesis, float spread, EvidenceMemory::Worker& own) {
  constexpr float kSharpness = 4.0F;
  if (spread == 1.0F || own.compared.empty()) return hypothesis.views;
  WeighedViews& weighed = own.weighed;
  weighed.clear();
  for (const PlacedView& seen : own.compared) {
    weighed.emplace_back(seen.view, std::exp(kSharpness * agreement(seen.fit)));
  }
  std::stable_sort(weighed.begin(), weighed.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return weighed;
}

void add_rotations(const EvidenceInput& input, const Hypothesis& hypothesis, const WeighedViews& views,
                   std::vector<RotationVote>& rotations) {
  const Eigen::Quaternionf R_camera_ray(ray_rotation(hypothesis.centre_camera));
  const auto room = static_cast<std::size_t>(std::max(input.settings.max_rotations, 0));
  rotations.reserve(std::min(room, hypothesis.views.size()));
  for (const auto& [view, weight] : views) {
    if (rotations.size() >= room) break;
    rotations.push_back({R_camera_ray * Eigen::Quaternionf(input.forest.views[view].R_ray_object), weight});
  }
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

Candidate weigh(const EvidenceInput& input, const Hypothesis& hypothesis, float spread, EvidenceMemory::Worker& own) {
  const ObjectClass& object = input.forest.classes[hypothesis.class_index];
  const Camera& camera = input.frame.frame.camera;
  own.compared.clear();
  Candidate candidate;
  Detection& detection = candidate.detection;
  candidate.evidence.mass_share = hypothesis.mass / object.expected_mass;
  candidate.evidence.certainty =
      hypothesis.weight / static_cast<float>(std::max<std::size_t>(hypothesis.patches.size(), 1));
  candidate.evidence.distance = hypothesis.centre_camera.norm();
  detection.box_px = backprojected_box(input.forest, hypothesis, input.patches, camera, own.box);
  detection.score = vote_score(candidate.evidence.mass_share);
  if (input.forest.scoring == Scoring::kEvidence) {
    compare_views(input, hypothesis, spread, own.compared);
    add_best_fit(input, object.score_model, own.compared, candidate.evidence);
    detection.score = score(object.score_model, candidate.evidence);
    detection.box_px = visible_box(detection.box_px, candidate.evidence.fit.visible_box_px, camera);
  }
  detection.class_id = object.class_id;
  detection.class_name = object.name;
  detection.centre_camera = hypothesis.centre_camera;
  detection.vote_weight = hypothesis.weight;
  detection.vote_count = hypothesis.vote_count;
  if (detection.score < input.settings.threshold) return candidate;  // most, whose rotations nobody will ask for
  add_rotations(input, hypothesis, weighed_views(hypothesis, spread, own), detection.rotations);
  return candidate;
}

bool looks_upright(const TrainedView& view) {
  constexpr float kMostAside = 0.35F;     // 20 degrees of roll
  constexpr float kMostDownwards = 0.2F;  // from straight above the axis has no direction in the picture
  const Eigen::Vector3f up_ray = view.R_ray_object * Eigen::Vector3f::UnitZ();
  return std::abs(up_ray.x()) < kMostAside && up_ray.y() < kMostDownwards;
}

}  // namespace

std::vector<Candidate> weigh_evidence(const EvidenceInput& input, const std::vector<Hypothesis>& hypotheses,
                                      int threads, EvidenceMemory& memory) {
  std::vector<float> spreads(input.forest.classes.size(), 0.0F);
  for (const Hypothesis& hypothesis : hypotheses) {
    float& spread = spreads[hypothesis.class_index];
    if (spread == 0.0F) spread = attitude_spread(input.forest, static_cast<std::uint32_t>(hypothesis.class_index));
  }
  memory.workers.make_room(threads);
  std::vector<Candidate> candidates(hypotheses.size());
  parallel_for_workers(threads, static_cast<int>(hypotheses.size()), [&](int worker, int i) {
    const Hypothesis& hypothesis = hypotheses[static_cast<std::size_t>(i)];
    candidates[static_cast<std::size_t>(i)] =
        weigh(input, hypothesis, spreads[hypothesis.class_index], memory.workers[worker]);
  });
  return candidates;
}

float attitude_spread(const Forest& forest, std::uint32_t class_index) {
  constexpr float kMost = 4.0F;
  constexpr float kNearlyAll = 0.98F;  // measured turntables have an odd view
  float all = 0.0F;
  float upright = 0.0F;
  for (const TrainedView& view : forest.views) {
    if (view.class_index != class_index) continue;
    all += 1.0F;
    upright += looks_upright(view) ? 1.0F : 0.0F;
  }
  if (upright >= kNearlyAll * all) return 1.0F;
  return upright > 0.0F ? std::min(kMost, all / upright) : kMost;
}

}  // namespace houghstream
