#include "detector/evidence/candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace houghstream {
namespace {

using WeighedViews = std::vector<std::pair<std::uint32_t, float>>;

constexpr std::size_t kMaxAttitudes = 3;  // that are looked into, however many a class was taught in

/// Views that are compared of a class that was taught in one attitude: the first that most votes remember.
constexpr std::size_t kViews = 8;

/// Compares the first `count` views that most votes remember with the frame; those that are compared already come
/// first.
void compare_views(const EvidenceInput& input, const Hypothesis& hypothesis, std::size_t count,
                   std::vector<PlacedTemplate>& compared) {
  const std::vector<std::uint32_t>& excluded = input.excluded_views;
  const Eigen::Vector3f& centre = hypothesis.centre_camera;
  std::size_t place = 0;
  for (const auto& [view, weight] : hypothesis.views) {
    if (place == count) break;
    if (std::find(excluded.begin(), excluded.end(), view) != excluded.end()) continue;
    if (place == compared.size()) {
      compared.push_back({view, centre, match_template(input.index.forest().views[view], centre, input.frame)});
    }
    ++place;
  }
}

/// From the view that agrees best to those that look from beside it, as long as one of them agrees better: votes
/// remember few of the views that would fit. All that were looked at are added to `way`.
PlacedTemplate climb(const EvidenceInput& input, PlacedTemplate best, std::vector<PlacedTemplate>& way) {
  constexpr int kSteps = 6;
  const std::vector<std::uint32_t>& excluded = input.excluded_views;
  for (int step = 0; step < kSteps; ++step) {
    const std::uint32_t from = best.view;
    const Eigen::Vector3f centre = best.centre_camera;
    for (const std::uint32_t view : input.index.view_neighbours()[from]) {
      if (view == from || std::find(excluded.begin(), excluded.end(), view) != excluded.end()) continue;
      way.push_back({view, centre, match_template(input.index.forest().views[view], centre, input.frame)});
      if (agreement(way.back().fit) > agreement(best.fit)) best = way.back();
    }
    if (best.view == from) break;
    best = align_template(input.index.forest().views, best, input.frame);
  }
  return align_template(input.index.forest().views, best, input.frame, 0.5F);
}

/// Where to climb from: the view that agrees best, and those that agree next best of attitudes unlike these, up to
/// `count`, at most kMaxAttitudes.
class SeedTemplates {
 public:
  SeedTemplates(const EvidenceInput& input, std::size_t count, std::vector<PlacedTemplate>& compared) {
    constexpr float kUnlike = 0.6F;  // radians
    const auto rotation = [&](const PlacedTemplate& placed) {
      return Eigen::Quaternionf(input.index.forest().views[placed.view].R_ray_object);
    };
    starts_[count_++] = align_best_templates(input.index.forest().views, input.frame, compared);
    for (const PlacedTemplate& next : compared) {
      if (count_ == count) break;
      const auto is_like = [&](const PlacedTemplate& start) {
        return rotation(start).angularDistance(rotation(next)) <= kUnlike;
      };
      if (std::none_of(begin(), end(), is_like)) starts_[count_++] = next;
    }
  }
  const PlacedTemplate* begin() const { return starts_.data(); }
  const PlacedTemplate* end() const { return starts_.data() + count_; }

 private:
  std::array<PlacedTemplate, kMaxAttitudes> starts_;
  std::size_t count_ = 0;
};

/// What a view says where it stands, `evidence` otherwise.
void look_at_view(const EvidenceInput& input, const PlacedTemplate& placed, Evidence& evidence) {
  evidence.view = placed.view;
  evidence.view_centre = placed.centre_camera;
  evidence.fit = placed.fit;
  evidence.outline =
      measure_boundary_continuation(input.index.forest().views[placed.view], placed.centre_camera, input.frame);
}

/// Completes the evidence by the view that agrees best with the frame, aligned with it; of views of unlike attitudes by
/// that which speaks most for an object, as all objects have it in common: a view of a small side agrees easily with a
/// part of the object, and only what lies beyond its outline tells. What is hopeless where it stands is left there:
/// most maxima are of that kind, and looking further takes longer than all else about them.
void add_best_fit(const EvidenceInput& input, const Hypothesis& hypothesis, float spread, EvidenceMemory::Worker& own,
                  Evidence& evidence) {
  constexpr float kHopeless = 0.02F;  // score: votes bring hidden objects views that hardly fit
  constexpr ScoreModel kCommon;
  std::vector<PlacedTemplate>& compared = own.compared;
  compare_views(input, hypothesis, kViews, compared);
  if (compared.empty()) return;
  look_at_view(input, best_match(compared), evidence);
  if (score(input.index.forest().classes[hypothesis.class_index].score_model, evidence) < kHopeless) return;
  compare_views(input, hypothesis, static_cast<std::size_t>(kViews * spread), compared);
  const Evidence unaligned = evidence;
  const auto attitudes = static_cast<std::size_t>(spread);
  own.best_way.clear();
  double most = -std::numeric_limits<double>::infinity();
  for (const PlacedTemplate& start : SeedTemplates(input, attitudes, compared)) {
    own.way.clear();
    const PlacedTemplate best = climb(input, start, own.way);
    Evidence seen = unaligned;
    look_at_view(input, best, seen);
    seen.other_size = alternative_scale_gain(input.index.forest().views[best.view], best, input.frame);
    const double odds = log_odds(kCommon, score_terms(seen));
    if (odds <= most) continue;
    most = odds;
    evidence = seen;
    own.way.swap(own.best_way);
  }
  // Only what the best was climbed through speaks for a rotation.
  compared.insert(compared.end(), own.best_way.begin(), own.best_way.end());
}

/// Views and how much they speak for their rotation, heaviest first: the votes that remember them. Of a class that was
/// taught in many attitudes the views lie far apart, and how they agree with the frame says more.
const WeighedViews& weighed_views(const Hypothesis& hypothesis, float spread, EvidenceMemory::Worker& own) {
  constexpr float kSharpness = 4.0F;
  if (spread == 1.0F || own.compared.empty()) return hypothesis.views;
  WeighedViews& weighed = own.weighed;
  weighed.clear();
  for (const PlacedTemplate& seen : own.compared) {
    weighed.emplace_back(seen.view, std::exp(kSharpness * agreement(seen.fit)));
  }
  std::stable_sort(weighed.begin(), weighed.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : a.second > b.second;
  });
  const auto is_same = [](const auto& a, const auto& b) { return a.first == b.first; };
  weighed.erase(std::unique(weighed.begin(), weighed.end(), is_same), weighed.end());  // some were compared twice
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
    rotations.push_back({R_camera_ray * Eigen::Quaternionf(input.index.forest().views[view].R_ray_object), weight});
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
  const ObjectClass& object = input.index.forest().classes[hypothesis.class_index];
  const Camera& camera = input.frame.frame.camera;
  own.compared.clear();
  Candidate candidate;
  Detection& detection = candidate.detection;
  candidate.evidence.relative_vote_mass = hypothesis.mass / object.nominal_vote_mass;
  candidate.evidence.certainty =
      hypothesis.weight / static_cast<float>(std::max<std::size_t>(hypothesis.patches.size(), 1));
  candidate.evidence.distance = hypothesis.centre_camera.norm();
  candidate.evidence.radius_px =
      focal_octave_scale(camera) * static_cast<float>(camera.fx) * object.radius / candidate.evidence.distance;
  detection.box_px = backproject_box(input.index.forest(), hypothesis, input.patches, camera, own.box);
  detection.score = vote_score(candidate.evidence.relative_vote_mass);
  if (input.index.forest().scoring == Scoring::kEvidence) {
    add_best_fit(input, hypothesis, spread, own, candidate.evidence);
    detection.score = score(object.score_model, candidate.evidence);
    detection.box_px = visible_box(detection.box_px, candidate.evidence.fit.visible_box_px, camera);
  }
  detection.class_id = object.class_id;
  detection.class_name = object.name;
  detection.centre_camera = hypothesis.centre_camera;
  detection.vote_weight = hypothesis.weight;
  detection.vote_count = hypothesis.vote_count;
  const float least = std::min(input.settings.threshold, input.settings.candidates_from);
  const float most = std::max(detection.score, score_as_taught(object.score_model, candidate.evidence));
  if (most < least) return candidate;  // most, whose rotations nobody will ask for
  add_rotations(input, hypothesis, weighed_views(hypothesis, spread, own), detection.rotations);
  return candidate;
}

}  // namespace

std::vector<Candidate> weigh_evidence(const EvidenceInput& input, const std::vector<Hypothesis>& hypotheses,
                                      int threads, EvidenceMemory& memory) {
  std::vector<float> spreads(input.index.forest().classes.size(), 0.0F);
  for (const Hypothesis& hypothesis : hypotheses) {
    float& spread = spreads[hypothesis.class_index];
    if (spread == 0.0F)
      spread = attitude_spread(input.index.forest(), static_cast<std::uint32_t>(hypothesis.class_index));
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
  constexpr float kOneAttitude = 150.0F;  // views of a turntable
  const auto views = std::count_if(forest.views.begin(), forest.views.end(),
                                   [&](const ViewTemplate& view) { return view.class_index == class_index; });
  return std::clamp(static_cast<float>(views) / kOneAttitude, 1.0F, static_cast<float>(kMaxAttitudes));
}

}  // namespace houghstream
