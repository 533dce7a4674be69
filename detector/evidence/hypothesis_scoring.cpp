#include "detector/evidence/hypothesis_scoring.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace houghstream {
namespace {

// Maximum number of attitudes that are refined, however many a class was taught in.
constexpr std::size_t kMaxAttitudes = 3;

/// Templates that are compared of a class that was taught in one attitude: the first that most votes remember.
constexpr std::size_t kTemplates = 8;

using WeightedViews = std::vector<std::pair<std::uint32_t, float>>;

/// Templates from which the best match is searched; it needs no memory of its own, as a frame has many of them.
struct SeedTemplates {
  std::array<PlacedTemplate, kMaxAttitudes> templates;
  std::size_t count = 0;

  const PlacedTemplate* begin() const { return templates.data(); }
  const PlacedTemplate* end() const { return templates.data() + count; }
};

/// Scores hypotheses one after another, in one thread. Its functions stand below in the order of their calls.
class HypothesisScorer {
 public:
  HypothesisScorer(const ScoringInput& input, ScoringWorkspace::Worker& workspace)
      : input_(input), forest_(input.index.forest()), views_(forest_.views), workspace_(workspace) {}

  ScoredHypothesis score_hypothesis(const Hypothesis& hypothesis, float spread);

 private:
  Evidence evidence_of_votes(const Hypothesis& hypothesis) const;
  void add_best_match(const Hypothesis& hypothesis, float spread, Evidence& evidence);
  void compare_templates(const Hypothesis& hypothesis, std::size_t count);
  void set_match(const PlacedTemplate& placed, Evidence& evidence) const;
  SeedTemplates find_seeds(std::size_t count);
  PlacedTemplate refine_over_neighbours(PlacedTemplate best);
  static cv::Rect2f visible_box_between(const cv::Rect2f& voted, const cv::Rect2f& fitted, const Camera& camera);
  const WeightedViews& weight_views(const Hypothesis& hypothesis, float spread);
  void add_rotations(const Hypothesis& hypothesis, const WeightedViews& views, std::vector<RotationVote>& rotations);

  bool is_excluded(std::uint32_t view) const {
    const std::vector<std::uint32_t>& excluded = input_.excluded_views;
    return std::find(excluded.begin(), excluded.end(), view) != excluded.end();
  }

  const ScoringInput& input_;
  const Forest& forest_;
  const std::vector<ViewTemplate>& views_;
  ScoringWorkspace::Worker& workspace_;
};

}  // namespace

std::vector<ScoredHypothesis> score_hypotheses(const ScoringInput& input, const std::vector<Hypothesis>& hypotheses,
                                               int threads, ScoringWorkspace& workspace) {
  std::vector<float> spreads(input.index.forest().classes.size(), 0.0F);
  for (const Hypothesis& hypothesis : hypotheses) {
    float& spread = spreads[hypothesis.class_index];
    if (spread == 0.0F)
      spread = attitude_spread(input.index.forest(), static_cast<std::uint32_t>(hypothesis.class_index));
  }
  workspace.workers.resize(threads);
  std::vector<ScoredHypothesis> scored(hypotheses.size());
  parallel_for_workers(threads, static_cast<int>(hypotheses.size()), [&](int worker, int i) {
    const Hypothesis& hypothesis = hypotheses[static_cast<std::size_t>(i)];
    HypothesisScorer scorer(input, workspace.workers[worker]);
    scored[static_cast<std::size_t>(i)] = scorer.score_hypothesis(hypothesis, spreads[hypothesis.class_index]);
  });
  return scored;
}

float attitude_spread(const Forest& forest, std::uint32_t class_index) {
  constexpr float kOneAttitude = 150.0F;  // views of a turntable
  const auto views = std::count_if(forest.views.begin(), forest.views.end(),
                                   [&](const ViewTemplate& view) { return view.class_index == class_index; });
  return std::clamp(static_cast<float>(views) / kOneAttitude, 1.0F, static_cast<float>(kMaxAttitudes));
}

ScoredHypothesis HypothesisScorer::score_hypothesis(const Hypothesis& hypothesis, float spread) {
  const ObjectClass& object = forest_.classes[hypothesis.class_index];
  const Camera& camera = input_.frame.frame.camera;
  workspace_.compared.clear();
  ScoredHypothesis scored;
  scored.evidence = evidence_of_votes(hypothesis);
  Detection& detection = scored.detection;
  detection.class_id = object.class_id;
  detection.class_name = object.name;
  detection.centre_camera = hypothesis.centre_camera;
  detection.vote_weight = hypothesis.weight;
  detection.vote_count = hypothesis.vote_count;
  detection.box_px = backproject_box(forest_, hypothesis, input_.patches, camera, workspace_.box);
  detection.score = vote_score(scored.evidence.relative_vote_mass);
  if (forest_.scoring == Scoring::kEvidence) {
    add_best_match(hypothesis, spread, scored.evidence);
    detection.score = score(object.score_model, scored.evidence);
    detection.box_px = visible_box_between(detection.box_px, scored.evidence.fit.visible_box_px, camera);
  }
  const float min_score = std::min(input_.settings.threshold, input_.settings.candidates_from);
  const float max_score = std::max(detection.score, score_as_taught(object.score_model, scored.evidence));
  if (max_score < min_score) return scored;  // most of them: nothing reads their rotations
  add_rotations(hypothesis, weight_views(hypothesis, spread), detection.rotations);
  return scored;
}

Evidence HypothesisScorer::evidence_of_votes(const Hypothesis& hypothesis) const {
  const ObjectClass& object = forest_.classes[hypothesis.class_index];
  const Camera& camera = input_.frame.frame.camera;
  Evidence evidence;
  evidence.relative_vote_mass = hypothesis.vote_mass / object.nominal_vote_mass;
  evidence.certainty = hypothesis.weight / static_cast<float>(std::max<std::size_t>(hypothesis.patches.size(), 1));
  evidence.distance = hypothesis.centre_camera.norm();
  evidence.radius_px = focal_octave_scale(camera) * static_cast<float>(camera.fx) * object.radius / evidence.distance;
  return evidence;
}

/// Completes the evidence by the template that matches the frame best, after refinement. Of templates of unlike
/// attitudes that one counts which most supports an object, by what all objects have in common: a template of a small
/// side easily matches a part of the object, and only what lies beyond its outline tells them apart. A hypothesis that
/// is hopeless is not refined: most maxima are, and refinement takes longer than everything else about them.
void HypothesisScorer::add_best_match(const Hypothesis& hypothesis, float spread, Evidence& evidence) {
  constexpr float kHopeless = 0.02F;  // score: votes bring occluded objects templates that hardly match
  constexpr ScoreModel kCommon;
  std::vector<PlacedTemplate>& compared = workspace_.compared;
  compare_templates(hypothesis, kTemplates);
  if (compared.empty()) return;
  set_match(best_match(compared), evidence);
  if (score(forest_.classes[hypothesis.class_index].score_model, evidence) < kHopeless) return;
  compare_templates(hypothesis, static_cast<std::size_t>(kTemplates * spread));
  const Evidence unrefined = evidence;
  workspace_.best_visited.clear();
  double max_log_odds = -std::numeric_limits<double>::infinity();
  for (const PlacedTemplate& seed : find_seeds(static_cast<std::size_t>(spread))) {
    const PlacedTemplate best = refine_over_neighbours(seed);
    Evidence refined = unrefined;
    set_match(best, refined);
    refined.alternative_scale_gain = alternative_scale_gain(views_[best.view], best, input_.frame);
    const double odds = score_logit(kCommon, score_terms(refined));
    if (odds <= max_log_odds) continue;
    max_log_odds = odds;
    evidence = refined;
    workspace_.visited.swap(workspace_.best_visited);
  }
  // Only the refinement that led to the best match supports rotations.
  compared.insert(compared.end(), workspace_.best_visited.begin(), workspace_.best_visited.end());
}

/// Compares the first `count` templates that most votes remember with the frame, but for those that stand in
/// `compared` already: they come first.
void HypothesisScorer::compare_templates(const Hypothesis& hypothesis, std::size_t count) {
  std::vector<PlacedTemplate>& compared = workspace_.compared;
  const Eigen::Vector3f& centre = hypothesis.centre_camera;
  std::size_t place = 0;
  for (const auto& [view, weight] : hypothesis.views) {
    if (place == count) break;
    if (is_excluded(view)) continue;
    if (place == compared.size())
      compared.push_back({view, centre, match_template(views_[view], centre, input_.frame)});
    ++place;
  }
}

/// Writes into the evidence how a template matches the frame, within its outline and across it.
void HypothesisScorer::set_match(const PlacedTemplate& placed, Evidence& evidence) const {
  evidence.view = placed.view;
  evidence.view_centre = placed.centre_camera;
  evidence.fit = placed.fit;
  evidence.outline = measure_boundary_continuation(views_[placed.view], placed.centre_camera, input_.frame);
}

/// Returns the template that matches best, and up to `count` in all of those that match next best in attitudes unlike
/// these; at most kMaxAttitudes. Sorts `compared` by how they match.
SeedTemplates HypothesisScorer::find_seeds(std::size_t count) {
  constexpr float kUnlike_rad = 0.6F;
  const auto rotation = [&](const PlacedTemplate& placed) {
    return Eigen::Quaternionf(views_[placed.view].R_ray_object);
  };
  SeedTemplates seeds;
  seeds.templates[seeds.count++] = align_best_templates(views_, input_.frame, workspace_.compared);
  for (const PlacedTemplate& next : workspace_.compared) {
    if (seeds.count == count) break;
    const auto is_like = [&](const PlacedTemplate& seed) {
      return rotation(seed).angularDistance(rotation(next)) <= kUnlike_rad;
    };
    if (std::none_of(seeds.begin(), seeds.end(), is_like)) seeds.templates[seeds.count++] = next;
  }
  return seeds;
}

/// Goes from a template to the best of its neighbours in viewing direction, and aligns it, as long as one matches
/// better: votes remember few of the templates that would match. Writes all that were compared into `way`.
PlacedTemplate HypothesisScorer::refine_over_neighbours(PlacedTemplate best) {
  constexpr int kSteps = 6;
  std::vector<PlacedTemplate>& visited = workspace_.visited;
  visited.clear();
  for (int step = 0; step < kSteps; ++step) {
    const std::uint32_t from = best.view;
    const Eigen::Vector3f centre = best.centre_camera;
    for (const std::uint32_t view : input_.index.view_neighbours()[from]) {
      if (view == from || is_excluded(view)) continue;
      visited.push_back({view, centre, match_template(views_[view], centre, input_.frame)});
      if (match_quality(visited.back().fit) > match_quality(best.fit)) best = visited.back();
    }
    if (best.view == from) break;
    best = align_template(views_, best, input_.frame);
  }
  return align_template(views_, best, input_.frame, 0.5F);
}

/// Returns the box that votes and template say. Votes tell which patches belong to the object, depth tells where the
/// template is not occluded: their errors are different ones, so the sides are taken midway.
cv::Rect2f HypothesisScorer::visible_box_between(const cv::Rect2f& voted, const cv::Rect2f& fitted,
                                                 const Camera& camera) {
  const cv::Rect2f inside =
      fitted & cv::Rect2f(0.0F, 0.0F, static_cast<float>(camera.width), static_cast<float>(camera.height));
  if (inside.empty()) return voted;
  return {0.5F * (voted.x + inside.x), 0.5F * (voted.y + inside.y), 0.5F * (voted.width + inside.width),
          0.5F * (voted.height + inside.height)};
}

/// Returns views with the weight of their rotation, heaviest first: the votes that remember them. Of a class that was
/// taught in many attitudes the views lie far apart, and how their templates match the frame says more.
const WeightedViews& HypothesisScorer::weight_views(const Hypothesis& hypothesis, float spread) {
  constexpr float kSharpness = 4.0F;
  if (spread == 1.0F || workspace_.compared.empty()) return hypothesis.views;
  WeightedViews& weighted = workspace_.weighted_views;
  weighted.clear();
  for (const PlacedTemplate& placed : workspace_.compared) {
    weighted.emplace_back(placed.view, std::exp(kSharpness * match_quality(placed.fit)));
  }
  std::stable_sort(weighted.begin(), weighted.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : a.second > b.second;
  });
  const auto is_same = [](const auto& a, const auto& b) { return a.first == b.first; };
  weighted.erase(std::unique(weighted.begin(), weighted.end(), is_same), weighted.end());  // some were compared twice
  std::stable_sort(weighted.begin(), weighted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return weighted;
}

void HypothesisScorer::add_rotations(const Hypothesis& hypothesis, const WeightedViews& views,
                                     std::vector<RotationVote>& rotations) {
  const Eigen::Quaternionf R_camera_ray(ray_rotation(hypothesis.centre_camera));
  const auto max_count = static_cast<std::size_t>(std::max(input_.settings.max_rotations, 0));
  rotations.reserve(std::min(max_count, hypothesis.views.size()));
  for (const auto& [view, weight] : views) {
    if (rotations.size() >= max_count) break;
    rotations.push_back({R_camera_ray * Eigen::Quaternionf(views_[view].R_ray_object), weight});
  }
}

}  // namespace houghstream
