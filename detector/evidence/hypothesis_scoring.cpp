#include "detector/evidence/hypothesis_scoring.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace houghstream {
namespace {

/// An attitude is a way in which an object stands or lies (stable pose).
constexpr auto kMaxAttitudes = static_cast<std::size_t>(ForestIndex::kMaxAttitudeFactor);

/// At most this many templates are compared of a class with one attitude: those that most votes support. More attitudes
/// have proportionally more.
constexpr std::size_t kTemplatesPerAttitude = 8;

using WeightedViews = std::vector<std::pair<std::uint32_t, float>>;

/// Number of templates kept of those sampled from all attitudes.
constexpr std::size_t kBestSampled = 3;

/// Templates from which the best match is searched.
using SeedTemplates = BestTemplates<kMaxAttitudes + 1>;

/// Holds a hypothesis with all that its scoring reads and writes.
struct ScoringTask {
  const ScoringInput* input = nullptr;
  const Hypothesis* hypothesis = nullptr;
  /// Number of attitudes that are searched, 1 to kMaxAttitudeFactor; it may be a fraction. 1: the class was taught in
  /// one (ForestIndex::attitude_factor()).
  float attitude_factor = 1.0F;
  std::size_t group = 0;
  ScoredHypothesis scored;
  std::optional<PlacedTemplate> sampled_best;  ///< see compare_sampled_views()
};

/// Indices of tasks, in ascending order.
using TaskIndices = std::vector<std::size_t>;

/// Does one step of the scoring of a hypothesis, in one thread. A scorer is made anew for each step: what one step
/// leaves to the next stands in the task and in `compared`.
class HypothesisScorer {
 public:
  HypothesisScorer(ScoringTask& task, std::vector<PlacedTemplate>& compared, ScoringWorkspace::Worker& workspace)
      : input_(*task.input),
        hypothesis_(*task.hypothesis),
        attitude_factor_(task.attitude_factor),
        forest_(input_.index.forest()),
        object_(forest_.classes[hypothesis_.class_index]),
        views_(forest_.views),
        scored_(task.scored),
        sampled_best_(task.sampled_best),
        compared_(compared),
        workspace_(workspace) {}

  void compare();
  void compare_sampled_views();
  void refine();
  /// Adds the box, and the rotations of a candidate.
  void complete();

 private:
  void compare_templates(std::size_t count);
  void set_match(const PlacedTemplate& placed, Evidence& evidence) const;
  const PlacedTemplate* best_match_so_far() const;
  SeedTemplates find_seeds();
  BestTemplates<kBestSampled> match_beside_centre() const;
  template <typename Places>
  BestTemplates<kBestSampled> match_sampled_views(const Places& places) const;
  PlacedTemplate refine_over_neighbours(PlacedTemplate best);
  static cv::Rect2f visible_box_between(const cv::Rect2f& voted, const cv::Rect2f& fitted, const Camera& camera);
  const WeightedViews& weight_views();
  void add_rotations(const WeightedViews& views, std::vector<RotationVote>& rotations);

  bool is_excluded(std::uint32_t view) const {
    const std::vector<std::uint32_t>& excluded = input_.excluded_views;
    return std::find(excluded.begin(), excluded.end(), view) != excluded.end();
  }

  const ScoringInput& input_;
  const Hypothesis& hypothesis_;
  float attitude_factor_;
  const Forest& forest_;
  const ObjectClass& object_;
  const std::vector<ViewTemplate>& views_;
  ScoredHypothesis& scored_;
  std::optional<PlacedTemplate>& sampled_best_;
  std::vector<PlacedTemplate>& compared_;
  ScoringWorkspace::Worker& workspace_;
};

// The steps of score_by_group(); they and the scorer's functions stand behind it in the order of their calls.
std::vector<ScoringTask> list_tasks(const std::vector<GroupHypotheses>& groups);
Evidence evidence_of_votes(const Forest& forest, const Hypothesis& hypothesis, const Camera& camera);
void keep_most_promising(const EvidenceSettings& settings, std::vector<ScoringTask>& tasks);
TaskIndices all_tasks(const std::vector<ScoringTask>& tasks);
TaskIndices find_likely(const std::vector<ScoringTask>& tasks, const TaskIndices& all);
TaskIndices choose_sampled(const std::vector<ScoringTask>& tasks, const TaskIndices& subset, int maximum);
TaskIndices choose_refined(const std::vector<ScoringTask>& tasks, const TaskIndices& subset, int maximum);
TaskIndices find_unexplained(const std::vector<ScoringTask>& tasks, const TaskIndices& all, const TaskIndices& likely,
                             float explains_from);
bool may_touch(const ScoringTask& a, const ScoringTask& b);

}  // namespace

GroupCandidates score_by_group(const std::vector<GroupHypotheses>& groups, int threads, ScoringWorkspace& workspace) {
  const EvidenceSettings& settings = groups.front().input.settings;
  std::vector<ScoringTask> tasks = list_tasks(groups);
  keep_most_promising(settings, tasks);
  workspace.workers.resize(threads);
  workspace.compared.resize(std::max(workspace.compared.size(), tasks.size()));
  const auto for_each = [&](const TaskIndices& subset, void (HypothesisScorer::*step)()) {
    parallel_for_workers(threads, static_cast<int>(subset.size()), [&](int worker, int i) {
      const std::size_t task = subset[static_cast<std::size_t>(i)];
      HypothesisScorer scorer(tasks[task], workspace.compared[task], workspace.workers[worker]);
      (scorer.*step)();
    });
  };
  const TaskIndices all = all_tasks(tasks);
  for_each(all, &HypothesisScorer::compare);
  const TaskIndices likely = find_likely(tasks, all);
  const auto likely_count = static_cast<int>(likely.size());
  const auto search = [&](const TaskIndices& subset, int max_sampled, int max_refined) {
    for_each(choose_sampled(tasks, subset, max_sampled), &HypothesisScorer::compare_sampled_views);
    for_each(choose_refined(tasks, subset, max_refined), &HypothesisScorer::refine);
    for_each(subset, &HypothesisScorer::complete);
  };
  search(likely, likely_count, settings.max_refined);
  TaskIndices searched = find_unexplained(tasks, all, likely, settings.explains_from);
  search(searched, settings.max_sampled, std::max(0, settings.max_refined - likely_count));
  searched.insert(searched.end(), likely.begin(), likely.end());
  std::sort(searched.begin(), searched.end());
  GroupCandidates candidates(groups.size());
  for (const std::size_t i : searched) candidates[tasks[i].group].push_back(std::move(tasks[i].scored));
  return candidates;
}

namespace {

/// Lists the hypotheses of all groups with the evidence of their votes.
std::vector<ScoringTask> list_tasks(const std::vector<GroupHypotheses>& groups) {
  std::size_t count = 0;
  for (const GroupHypotheses& searched : groups) count += searched.hypotheses.size();
  std::vector<ScoringTask> tasks;
  tasks.reserve(count);
  for (std::size_t group = 0; group < groups.size(); ++group) {
    const auto& [input, hypotheses] = groups[group];
    const Forest& forest = input.index.forest();
    for (const Hypothesis& hypothesis : hypotheses) {
      ScoringTask& task = tasks.emplace_back();
      task.input = &input;
      task.hypothesis = &hypothesis;
      task.attitude_factor = input.index.attitude_factor(hypothesis.class_index);
      task.group = group;
      task.scored.evidence = evidence_of_votes(forest, hypothesis, input.frame.frame.camera);
    }
  }
  return tasks;
}

Evidence evidence_of_votes(const Forest& forest, const Hypothesis& hypothesis, const Camera& camera) {
  const ObjectClass& object = forest.classes[hypothesis.class_index];
  Evidence evidence;
  evidence.relative_vote_mass = hypothesis.vote_mass / object.nominal_vote_mass;
  evidence.certainty = hypothesis.weight / static_cast<float>(std::max<std::size_t>(hypothesis.patches.size(), 1));
  evidence.distance = hypothesis.centre_camera.norm();
  evidence.radius_px = focal_octave_scale(camera) * static_cast<float>(camera.fx) * object.radius / evidence.distance;
  return evidence;
}

/// Returns the tasks of the subset for which `is_wanted` holds.
template <typename IsWanted>
TaskIndices select(const TaskIndices& subset, const IsWanted& is_wanted) {
  TaskIndices selected;
  selected.reserve(subset.size());
  std::copy_if(subset.begin(), subset.end(), std::back_inserter(selected), is_wanted);
  return selected;
}

/// Returns the tasks with the `count` largest values; of equal values the first.
template <typename ValueOf>
TaskIndices largest(TaskIndices subset, int count, const ValueOf& value_of) {
  if (subset.size() <= static_cast<std::size_t>(count)) return subset;
  std::stable_sort(subset.begin(), subset.end(),
                   [&](std::size_t a, std::size_t b) { return value_of(a) > value_of(b); });
  subset.resize(static_cast<std::size_t>(count));
  std::sort(subset.begin(), subset.end());
  return subset;
}

/// Drops the hypotheses that are not compared with the frame.
void keep_most_promising(const EvidenceSettings& settings, std::vector<ScoringTask>& tasks) {
  if (tasks.size() <= static_cast<std::size_t>(settings.max_compared)) return;
  std::vector<ScoringTask> kept;
  const auto vote_logit_of = [&](std::size_t i) { return vote_logit(tasks[i].scored.evidence); };
  for (const std::size_t i : largest(all_tasks(tasks), settings.max_compared, vote_logit_of))
    kept.push_back(std::move(tasks[i]));
  tasks.swap(kept);
}

TaskIndices all_tasks(const std::vector<ScoringTask>& tasks) {
  TaskIndices all(tasks.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

/// Compares the templates that most votes support with the frame.
void HypothesisScorer::compare() {
  Detection& detection = scored_.detection;
  detection.class_id = object_.class_id;
  detection.class_name = object_.name;
  detection.centre_camera = hypothesis_.centre_camera;
  detection.vote_weight = hypothesis_.weight;
  detection.vote_count = hypothesis_.vote_count;
  detection.score = vote_score(scored_.evidence.relative_vote_mass);
  compared_.clear();
  if (forest_.scoring != Scoring::kEvidence) return;
  compare_templates(kTemplatesPerAttitude);
  if (const PlacedTemplate* best = best_match_so_far()) set_match(*best, scored_.evidence);
  detection.score = score(object_.score_model, scored_.evidence);
}

/// Compares the `count` templates that most votes support with the frame, but for those that stand in `compared_`
/// already: they come first.
void HypothesisScorer::compare_templates(std::size_t count) {
  const Eigen::Vector3f& centre = hypothesis_.centre_camera;
  std::size_t rank = 0;
  for (const auto& [view, weight] : hypothesis_.views) {
    if (rank == count) break;
    if (is_excluded(view)) continue;
    if (rank == compared_.size())
      compared_.push_back({view, centre, match_template(views_[view], centre, input_.frame)});
    ++rank;
  }
}

/// Returns the best match of all compared templates, from compare_sampled_views() on with the best sampled one; null
/// where none was compared.
const PlacedTemplate* HypothesisScorer::best_match_so_far() const {
  const PlacedTemplate* best = compared_.empty() ? nullptr : &best_match(compared_);
  if (sampled_best_ && (best == nullptr || matches_better(*sampled_best_, *best))) return &*sampled_best_;
  return best;
}

/// Writes into the evidence how a template matches the frame, within its outline and across it.
void HypothesisScorer::set_match(const PlacedTemplate& placed, Evidence& evidence) const {
  evidence.view = placed.view;
  evidence.view_centre = placed.centre_camera;
  evidence.fit = placed.fit;
  evidence.outline = measure_boundary_continuation(views_[placed.view], placed.centre_camera, input_.frame);
}

/// Returns the tasks whose score after the first comparison is at least kLikely.
TaskIndices find_likely(const std::vector<ScoringTask>& tasks, const TaskIndices& all) {
  constexpr float kLikely = 0.5F;  // score
  return select(all, [&](std::size_t i) {
    const ScoredHypothesis& scored = tasks[i].scored;
    return scored.evidence.view != Evidence::kNoView && scored.detection.score >= kLikely;
  });
}

/// Chooses the tasks of the subset that are compared with views of all attitudes: of classes that were taught in
/// several (`attitude_factor` above 1) and with many votes, the `maximum` with the highest vote_logit().
TaskIndices choose_sampled(const std::vector<ScoringTask>& tasks, const TaskIndices& subset, int maximum) {
  // This is a fraction of the nominal vote mass: a third of the object, seen as well as in training.
  constexpr float kManyVotes = 0.3F;
  TaskIndices eligible = select(subset, [&](std::size_t i) {
    const ScoringTask& task = tasks[i];
    const bool has_templates = task.input->index.forest().scoring == Scoring::kEvidence;
    return has_templates && task.attitude_factor != 1.0F && task.scored.evidence.relative_vote_mass >= kManyVotes;
  });
  return largest(std::move(eligible), maximum, [&](std::size_t i) { return vote_logit(tasks[i].scored.evidence); });
}

/// Compares templates sampled from all attitudes at the centre: in real images votes support other
/// views than in rendered ones, and those of a plain or symmetric object are often not of its attitude.
void HypothesisScorer::compare_sampled_views() {
  const BestTemplates<kBestSampled> best = match_sampled_views(std::array{hypothesis_.centre_camera});
  if (best.size() == 0) return;
  sampled_best_ = best.front();
  set_match(*best_match_so_far(), scored_.evidence);
  scored_.detection.score = score(object_.score_model, scored_.evidence);
}

/// Returns the sampled templates of all attitudes (ForestIndex::sampled_views) that match best at some places, aligned:
/// coarse views first, and then those around the best of these. Comparing all of them found no more in 88 development
/// images.
template <typename Places>
BestTemplates<kBestSampled> HypothesisScorer::match_sampled_views(const Places& places) const {
  constexpr std::size_t kBestCoarse = 8;  // coarse views whose surroundings are compared too
  constexpr std::size_t kRowStep = 3;  // every third row is enough to decide which templates deserve a full comparison
  const SampledViews& sampled = input_.index.sampled_views(hypothesis_.class_index);
  const std::size_t coarse = std::min(sampled.views.size(), SampledViews::kCoarse);
  const auto match = [&](std::uint32_t view, const Eigen::Vector3f& centre, auto& best) {
    if (!is_excluded(view))
      best.add({view, centre, match_template(views_[view], centre, input_.frame, {1.0F, kRowStep})});
  };
  BestTemplates<kBestCoarse> best_coarse;
  for (const Eigen::Vector3f& place : places) {
    for (std::size_t i = 0; i < coarse; ++i) match(sampled.views[i], place, best_coarse);
  }
  BestTemplates<kBestSampled> best;
  for (const PlacedTemplate& placed : best_coarse) {
    best.add(placed);
    for (std::size_t i = coarse; i < sampled.views.size(); ++i) {
      if (sampled.views[sampled.nearest[i]] == placed.view) match(sampled.views[i], placed.centre_camera, best);
    }
  }
  BestTemplates<kBestSampled> aligned;
  for (const auto& [view, centre, fit] : best)
    aligned.add(
        align_template(views_, {view, centre, match_template(views_[view], centre, input_.frame)}, input_.frame));
  return aligned;
}

/// Chooses the tasks of the subset that are refined: the `maximum` with the highest scores. Hopeless ones are left out:
/// many maxima are hopeless, and refinement is the most expensive step.
TaskIndices choose_refined(const std::vector<ScoringTask>& tasks, const TaskIndices& subset, int maximum) {
  // The limit is this low because votes bring occluded objects templates that hardly match: half hidden boxes of
  // YCB-V's scene 50 that end at 0.6 have 0.02 here.
  constexpr float kHopeless = 0.005F;
  TaskIndices eligible = select(subset, [&](std::size_t i) {
    const ScoredHypothesis& scored = tasks[i].scored;
    return scored.evidence.view != Evidence::kNoView && scored.detection.score >= kHopeless;
  });
  return largest(std::move(eligible), maximum, [&](std::size_t i) { return tasks[i].scored.detection.score; });
}

/// Refines the best templates and keeps the one whose evidence most supports an object, by the weights common to all
/// objects. Match quality does not suffice: a template of a small side matches a part of the object well, and only what
/// lies beyond its outline tells them apart.
void HypothesisScorer::refine() {
  constexpr ScoreModel kCommon;
  compare_templates(static_cast<std::size_t>(kTemplatesPerAttitude * attitude_factor_));  // compare() began them
  const Evidence unrefined = scored_.evidence;
  workspace_.best_visited.clear();
  double max_log_odds = -std::numeric_limits<double>::infinity();
  for (const PlacedTemplate& seed : find_seeds()) {
    const PlacedTemplate best = refine_over_neighbours(seed);
    Evidence refined = unrefined;
    set_match(best, refined);
    refined.alternative_scale_gain = alternative_scale_gain(views_[best.view], best, input_.frame);
    const double odds = score_logit(kCommon, score_terms(refined));
    if (odds <= max_log_odds) continue;
    max_log_odds = odds;
    scored_.evidence = refined;
    workspace_.visited.swap(workspace_.best_visited);  // best_visited: what the best refinement so far has compared
  }
  // Only the refinement that led to the best match supports rotations.
  compared_.insert(compared_.end(), workspace_.best_visited.begin(), workspace_.best_visited.end());
  scored_.detection.score = score(object_.score_model, scored_.evidence);
}

/// Returns the best matching templates of unlike rotations, one more than attitudes are searched where these are
/// several. They come from the templates that votes support, the sampled ones, and those sampled beside the centre. Of
/// `compared_` the best are aligned, in place.
SeedTemplates HypothesisScorer::find_seeds() {
  constexpr float kUnlike_rad = 0.3F;
  // all compared, the best sampled one, and those beside the centre
  BestTemplates<kTemplatesPerAttitude * kMaxAttitudes + 1 + kBestSampled> all;
  if (!compared_.empty()) align_best_templates(views_, input_.frame, compared_);
  for (const PlacedTemplate& placed : compared_) all.add(placed);
  if (sampled_best_) all.add(*sampled_best_);
  for (const PlacedTemplate& placed : match_beside_centre()) all.add(placed);
  const auto rotation = [&](const PlacedTemplate& placed) {
    return Eigen::Quaternionf(views_[placed.view].R_ray_object);
  };
  const std::size_t count = attitude_factor_ > 1.0F ? static_cast<std::size_t>(attitude_factor_) + 1 : 1;
  SeedTemplates seeds;
  for (const PlacedTemplate& next : all) {
    if (seeds.size() == count) break;
    const auto is_like = [&](const PlacedTemplate& seed) {
      return rotation(seed).angularDistance(rotation(next)) <= kUnlike_rad;
    };
    if (std::none_of(seeds.begin(), seeds.end(), is_like)) seeds.add(next);
  }
  return seeds;
}

/// Returns the templates sampled from all attitudes that match best at places beside the centre, aligned. Where votes
/// meet beside the middle of the object, as those of plain ones do, the right view matches no better there than others:
/// on YCB-V a foam brick got scores of 0.14 to 0.22 in three of five images, and 0.9 from 1.5 cm beside. None for a
/// class that was taught in one attitude.
BestTemplates<kBestSampled> HypothesisScorer::match_beside_centre() const {
  constexpr float kDisplacement = 0.25F;  // fraction of the object's radius
  constexpr float kEnough = 0.9F;         // score from which no other place is tried
  if (attitude_factor_ == 1.0F || scored_.detection.score >= kEnough) return {};
  const Eigen::Vector3f& centre = hypothesis_.centre_camera;
  const Eigen::Vector3f right = kDisplacement * object_.radius * Eigen::Vector3f::UnitX();
  const Eigen::Vector3f down = kDisplacement * object_.radius * Eigen::Vector3f::UnitY();
  const std::array<Eigen::Vector3f, 4> beside = {centre + right, centre - right, centre + down, centre - down};
  return match_sampled_views(beside);
}

/// Goes from a template to the best of its neighbours in viewing direction, and aligns it, as long as one matches
/// better: votes support few of the templates that would match. Writes all compared templates to workspace_.visited.
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
      if (matches_better(visited.back(), best)) best = visited.back();
    }
    if (best.view == from) break;
    best = align_template(views_, best, input_.frame);
  }
  return align_template(views_, best, input_.frame, 0.5F);
}

void HypothesisScorer::complete() {
  const Camera& camera = input_.frame.frame.camera;
  Detection& detection = scored_.detection;
  detection.box_px = backproject_box(forest_, hypothesis_, input_.patches, camera, workspace_.box);
  if (forest_.scoring == Scoring::kEvidence)
    detection.box_px = visible_box_between(detection.box_px, scored_.evidence.fit.visible_box_px, camera);
  // Matched again in the camera's colours (camera_chroma), the score may still rise so far.
  const float max_score = std::max(detection.score, score_with_typical_chroma(object_.score_model, scored_.evidence));
  if (max_score < input_.settings.min_kept_score(object_.name)) return;  // most of them: nothing reads their rotations
  add_rotations(weight_views(), detection.rotations);
}

/// Returns the box midway between that of the votes and that of the template: votes tell which patches belong to the
/// object, depth tells where the template is visible, and their errors differ.
cv::Rect2f HypothesisScorer::visible_box_between(const cv::Rect2f& voted, const cv::Rect2f& fitted,
                                                 const Camera& camera) {
  const cv::Rect2f inside =
      fitted & cv::Rect2f(0.0F, 0.0F, static_cast<float>(camera.width), static_cast<float>(camera.height));
  if (inside.empty()) return voted;
  return {0.5F * (voted.x + inside.x), 0.5F * (voted.y + inside.y), 0.5F * (voted.width + inside.width),
          0.5F * (voted.height + inside.height)};
}

/// Returns views with the weight of their rotation, heaviest first: that of the votes that support them. Of a class
/// that was taught in many attitudes the views lie far apart, and how their templates match the frame says more.
const WeightedViews& HypothesisScorer::weight_views() {
  constexpr float kSharpness = 4.0F;  // inverse temperature of the softmax over match_quality()
  if (attitude_factor_ == 1.0F || compared_.empty()) return hypothesis_.views;
  WeightedViews& weighted = workspace_.weighted_views;
  weighted.clear();
  for (const PlacedTemplate& placed : compared_) {
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

void HypothesisScorer::add_rotations(const WeightedViews& views, std::vector<RotationVote>& rotations) {
  const Eigen::Quaternionf R_camera_ray(ray_rotation(hypothesis_.centre_camera));
  const auto max_count = static_cast<std::size_t>(std::max(input_.settings.max_rotations, 0));
  rotations.reserve(std::min(max_count, hypothesis_.views.size()));
  for (const auto& [view, weight] : views) {
    if (rotations.size() >= max_count) break;
    rotations.push_back({R_camera_ray * Eigen::Quaternionf(views_[view].R_ray_object), weight});
  }
}

/// Returns the tasks that are not likely, without those on the surface of a likely one whose score is `explains_from`
/// or more.
TaskIndices find_unexplained(const std::vector<ScoringTask>& tasks, const TaskIndices& all, const TaskIndices& likely,
                             float explains_from) {
  constexpr float kExplained = 0.6F;  // fraction of the surface that is seen
  const auto cells_of = [&](std::size_t i) {
    const Evidence& evidence = tasks[i].scored.evidence;
    const ScoringInput& input = *tasks[i].input;
    return UnoccludedCells(input.index.forest().views[evidence.view], evidence.view_centre, input.frame.frame);
  };
  std::vector<std::pair<std::size_t, UnoccludedCells>> explaining;
  for (const std::size_t i : likely) {
    if (tasks[i].scored.detection.score >= explains_from) explaining.emplace_back(i, cells_of(i));
  }
  const auto is_explained = [&](std::size_t i) {
    if (tasks[i].scored.evidence.view == Evidence::kNoView) return false;
    std::optional<UnoccludedCells> cells;
    return std::any_of(explaining.begin(), explaining.end(), [&](const auto& other) {
      if (!may_touch(tasks[i], tasks[other.first])) return false;
      if (!cells) cells = cells_of(i);
      return cells->fraction_in(other.second) > kExplained;
    });
  };
  return select(
      all, [&](std::size_t i) { return !std::binary_search(likely.begin(), likely.end(), i) && !is_explained(i); });
}

/// Returns whether the spheres about two objects meet.
bool may_touch(const ScoringTask& a, const ScoringTask& b) {
  const auto radius = [](const ScoringTask& task) {
    return task.input->index.forest().classes[task.hypothesis->class_index].radius;
  };
  return (a.hypothesis->centre_camera - b.hypothesis->centre_camera).norm() < radius(a) + radius(b);
}

}  // namespace

}  // namespace houghstream
