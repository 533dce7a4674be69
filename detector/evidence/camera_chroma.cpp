#include "detector/evidence/camera_chroma.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "pipeline/base/parallel.hpp"

namespace houghstream {
namespace {

/// A candidate that says something of the camera's colours.
struct Witness {
  const ScoredHypothesis* candidate = nullptr;
  float probability = 0.0F;  ///< that it is an object of its class, whatever the camera's colours
};

/// Of a candidate that has a view.
std::size_t class_index_of(const Forest& forest, const ScoredHypothesis& candidate) {
  return forest.views[candidate.evidence.view].class_index;
}

const ObjectClass& class_of(const Forest& forest, const ScoredHypothesis& candidate) {
  return forest.classes[class_index_of(forest, candidate)];
}

bool is_beside(const ScoredHypothesis& a, const ScoredHypothesis& b, float radius) {
  return (a.detection.centre_camera - b.detection.centre_camera).norm() < radius;
}

/// Of each class the likeliest; of maxima that lie within one object the likeliest alone.
std::vector<Witness> find_likeliest(const Forest& forest, const std::vector<ScoredHypothesis>& candidates) {
  constexpr float kMinProbability = 0.05F;
  constexpr std::size_t kMaxPerClass = 3;
  std::map<std::string, std::vector<Witness>> by_class;
  for (const ScoredHypothesis& candidate : candidates) {
    if (candidate.evidence.view == Evidence::kNoView || !candidate.evidence.fit.colours.is_known) continue;
    const float probability = score_as_taught(class_of(forest, candidate).score_model, candidate.evidence);
    if (probability >= kMinProbability) by_class[candidate.detection.class_name].push_back({&candidate, probability});
  }
  std::vector<Witness> likeliest;
  for (auto& [name, witnesses] : by_class) {
    std::stable_sort(witnesses.begin(), witnesses.end(),
                     [](const Witness& a, const Witness& b) { return a.probability > b.probability; });
    std::vector<Witness> kept;
    for (const Witness& witness : witnesses) {
      const float radius = class_of(forest, *witness.candidate).radius;
      const bool is_known = std::any_of(kept.begin(), kept.end(), [&](const Witness& other) {
        return is_beside(*witness.candidate, *other.candidate, radius);
      });
      if (!is_known && kept.size() < kMaxPerClass) kept.push_back(witness);
    }
    likeliest.insert(likeliest.end(), kept.begin(), kept.end());
  }
  return likeliest;
}

/// In one place stands one object, whichever class it is of, or none of them: the odds of all that are taken to stand
/// there share what is certain.
void share_places(const Forest& forest, std::vector<Witness>& witnesses) {
  std::vector<float> odds;
  odds.reserve(witnesses.size());
  for (const Witness& witness : witnesses) odds.push_back(witness.probability / (1.0F - witness.probability));
  for (std::size_t i = 0; i < witnesses.size(); ++i) {
    const float radius = class_of(forest, *witnesses[i].candidate).radius;
    float all = 1.0F;
    for (std::size_t k = 0; k < witnesses.size(); ++k) {
      const float reach = 0.5F * (radius + class_of(forest, *witnesses[k].candidate).radius);
      if (is_beside(*witnesses[i].candidate, *witnesses[k].candidate, reach)) all += odds[k];
    }
    witnesses[i].probability = odds[i] / all;
  }
}

ChromaPair to_pair(const Witness& witness) {
  const MeanColours& colours = witness.candidate->evidence.fit.colours;
  ChromaPair pair;
  pair.class_name = witness.candidate->detection.class_name;
  pair.model = {colours.remembered_ab[0], colours.remembered_ab[1]};
  pair.measured = {colours.measured_ab[0], colours.measured_ab[1]};
  pair.lightness = colours.measured_lightness;
  pair.probability = witness.probability;
  return pair;
}

/// For each class how the camera renders its colours, learnt of the pairs of the others.
std::vector<ChromaMap> learn_cameras(const Forest& forest, const std::vector<ChromaPair>& pairs) {
  std::vector<ChromaMap> cameras;
  cameras.reserve(forest.classes.size());
  for (const ObjectClass& object : forest.classes) cameras.push_back(fit_chroma_map_without(object.name, pairs));
  return cameras;
}

/// The pairs that are remembered, and those of the frame's candidates.
std::vector<ChromaPair> all_pairs(const Forest& forest, std::vector<ChromaPair> pairs,
                                  const std::vector<ScoredHypothesis>& candidates) {
  std::vector<Witness> witnesses = find_likeliest(forest, candidates);
  share_places(forest, witnesses);
  std::transform(witnesses.begin(), witnesses.end(), std::back_inserter(pairs), to_pair);
  return pairs;
}

/// Whether views have to be looked for anew in these colours: more than the best of them may be another one.
bool are_far(const std::vector<ChromaMap>& cameras, const std::vector<ChromaMap>& before) {
  constexpr double kFar = 12.0;  // CIE a*b*, of a colour of medium strength; chosen: about what light changes by itself
  constexpr double kLightness = 60.0;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    for (const Eigen::Vector2d& colour : {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(25.0, 25.0)}) {
      const Eigen::Vector2d was = before.empty() ? colour : before[i].apply(colour, kLightness);
      if ((cameras[i].apply(colour, kLightness) - was).norm() > kFar) return true;
    }
  }
  return false;
}

/// Compares the views where they stand once more.
void judge_again(const ScoringInput& input, int threads, std::vector<ScoredHypothesis>& candidates) {
  constexpr float kHopeless = 0.02F;  // score, if the colours were as usual
  const Forest& forest = input.index.forest();
  const float minimum = std::min(input.settings.threshold, input.settings.candidates_from);
  parallel_for(threads, static_cast<int>(candidates.size()), [&](int i) {
    ScoredHypothesis& candidate = candidates[static_cast<std::size_t>(i)];
    Evidence& evidence = candidate.evidence;
    if (evidence.view == Evidence::kNoView) return;
    if (!input.frame.cameras[class_index_of(forest, candidate)].is_learnt()) return;  // its colours are as taught
    const ScoreModel& model = class_of(forest, candidate).score_model;
    if (score_as_taught(model, evidence) < kHopeless) return;
    evidence.fit = match_template(forest.views[evidence.view], evidence.view_centre, input.frame);
    candidate.detection.score = score(model, evidence);
    if (candidate.detection.score < minimum) candidate.detection.rotations.clear();
  });
}

}  // namespace

std::vector<ScoredHypothesis> weigh_in_camera_colours(const ScoringInput& input, const std::vector<ChromaPair>& colours,
                                                      const std::vector<Hypothesis>& hypotheses, int threads,
                                                      ScoringWorkspace& workspace) {
  const Forest& forest = input.index.forest();
  LabFrame frame = input.frame;
  const ScoringInput in_camera{input.index, frame, input.patches, input.settings, input.excluded_views};
  const bool is_grey = is_colourless(frame.frame.colour);
  if (is_grey) frame.cameras.assign(forest.classes.size(), colourless_camera());
  if (!is_grey && !colours.empty()) frame.cameras = learn_cameras(forest, colours);
  std::vector<ScoredHypothesis> candidates = score_hypotheses(in_camera, hypotheses, threads, workspace);
  if (is_grey) return candidates;
  std::vector<ChromaMap> cameras = learn_cameras(forest, all_pairs(forest, colours, candidates));
  const bool is_new = are_far(cameras, frame.cameras);
  frame.cameras = std::move(cameras);
  if (is_new) return score_hypotheses(in_camera, hypotheses, threads, workspace);
  judge_again(in_camera, threads, candidates);
  return candidates;
}

}  // namespace houghstream
