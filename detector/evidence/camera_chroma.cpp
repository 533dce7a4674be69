#include "detector/evidence/camera_chroma.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "pipeline/base/parallel.hpp"

namespace houghstream {
namespace {

/// Holds the camera's chroma map for each class of each group: [group][class].
using GroupChromaMaps = std::vector<std::vector<ChromaMap>>;

/// A candidate from whose colours the camera's chroma map is learnt.
struct ChromaSample {
  const ScoredHypothesis* candidate = nullptr;
  const ObjectClass* object = nullptr;
  float probability = 0.0F;  ///< probability that it is an object of its class, whatever the camera's colours
};

/// Returns the class index of a candidate that has a view.
std::size_t class_index_of(const Forest& forest, const ScoredHypothesis& candidate) {
  return forest.views[candidate.evidence.view].class_index;
}

const ObjectClass& class_of(const Forest& forest, const ScoredHypothesis& candidate) {
  return forest.classes[class_index_of(forest, candidate)];
}

bool is_near(const ScoredHypothesis& a, const ScoredHypothesis& b, float radius) {
  return (a.detection.centre_camera - b.detection.centre_camera).norm() < radius;
}

using SamplesByClass = std::map<std::string, std::vector<ChromaSample>>;

void add_samples(const Forest& forest, const std::vector<ScoredHypothesis>& candidates, SamplesByClass& by_class) {
  constexpr float kMinProbability = 0.05F;
  for (const ScoredHypothesis& candidate : candidates) {
    if (candidate.evidence.view == Evidence::kNoView || !candidate.evidence.fit.colours.is_known) continue;
    const ObjectClass& object = class_of(forest, candidate);
    const float probability = score_with_typical_chroma(object.score_model, candidate.evidence);
    if (probability >= kMinProbability)
      by_class[candidate.detection.class_name].push_back({&candidate, &object, probability});
  }
}

/// Returns the likeliest candidate of each class, and of maxima that lie within one object the likeliest alone.
std::vector<ChromaSample> find_likeliest(const std::vector<GroupHypotheses>& groups,
                                         const GroupCandidates& candidates) {
  constexpr std::size_t kMaxPerClass = 3;
  SamplesByClass by_class;
  for (std::size_t i = 0; i < groups.size(); ++i) add_samples(groups[i].input.index.forest(), candidates[i], by_class);
  std::vector<ChromaSample> likeliest;
  for (auto& [name, samples] : by_class) {
    std::stable_sort(samples.begin(), samples.end(),
                     [](const ChromaSample& a, const ChromaSample& b) { return a.probability > b.probability; });
    std::vector<ChromaSample> distinct;
    for (const ChromaSample& sample : samples) {
      const float radius = sample.object->radius;
      const bool is_duplicate = std::any_of(distinct.begin(), distinct.end(), [&](const ChromaSample& other) {
        return is_near(*sample.candidate, *other.candidate, radius);
      });
      if (!is_duplicate && distinct.size() < kMaxPerClass) distinct.push_back(sample);
    }
    likeliest.insert(likeliest.end(), distinct.begin(), distinct.end());
  }
  return likeliest;
}

/// Normalises the probabilities of overlapping samples: one object at most is there, so that their odds and those of
/// none sum to 1.
void normalise_overlapping(std::vector<ChromaSample>& samples) {
  std::vector<float> odds;
  odds.reserve(samples.size());
  for (const ChromaSample& sample : samples) odds.push_back(sample.probability / (1.0F - sample.probability));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const float radius = samples[i].object->radius;
    float odds_sum = 1.0F;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const float max_distance = 0.5F * (radius + samples[k].object->radius);
      if (is_near(*samples[i].candidate, *samples[k].candidate, max_distance)) odds_sum += odds[k];
    }
    samples[i].probability = odds[i] / odds_sum;
  }
}

ChromaPair to_chroma_pair(const ChromaSample& sample) {
  const MeanColours& colours = sample.candidate->evidence.fit.colours;
  ChromaPair pair;
  pair.class_name = sample.candidate->detection.class_name;
  pair.model = {colours.template_ab[0], colours.template_ab[1]};
  pair.measured = {colours.measured_ab[0], colours.measured_ab[1]};
  pair.lightness = colours.measured_lightness;
  pair.probability = sample.probability;
  return pair;
}

/// Learns for each class how the camera renders its colours, from the pairs of the others.
GroupChromaMaps fit_group_maps(const std::vector<GroupHypotheses>& groups, const std::vector<ChromaPair>& pairs) {
  GroupChromaMaps chroma_maps;
  for (const GroupHypotheses& searched : groups) {
    std::vector<ChromaMap>& by_class = chroma_maps.emplace_back();
    for (const ObjectClass& object : searched.input.index.forest().classes)
      by_class.push_back(fit_chroma_map_without(object.name, pairs));
  }
  return chroma_maps;
}

/// Returns the pairs of earlier frames and those of the frame's candidates.
std::vector<ChromaPair> collect_pairs(const std::vector<GroupHypotheses>& groups, std::vector<ChromaPair> pairs,
                                      const GroupCandidates& candidates) {
  std::vector<ChromaSample> samples = find_likeliest(groups, candidates);
  normalise_overlapping(samples);
  std::transform(samples.begin(), samples.end(), std::back_inserter(pairs), to_chroma_pair);
  return pairs;
}

/// Returns whether views must be searched again in these colours, since more than the best of them may differ.
bool differ_strongly(const std::vector<ChromaMap>& chroma_maps, const std::vector<ChromaMap>& before) {
  // Distance in a*b* for a colour of medium chroma. It was chosen as about what light alone changes.
  constexpr double kMaxDifference_ab = 12.0;
  constexpr double kLightness = 60.0;
  for (std::size_t i = 0; i < chroma_maps.size(); ++i) {
    for (const Eigen::Vector2d& colour : {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(25.0, 25.0)}) {
      const Eigen::Vector2d before_ab = before.empty() ? colour : before[i].apply(colour, kLightness);
      if ((chroma_maps[i].apply(colour, kLightness) - before_ab).norm() > kMaxDifference_ab) return true;
    }
  }
  return false;
}

/// Sets the chroma maps of the groups' frames. Returns whether views must be searched again, since the new maps differ
/// strongly from those that were set before.
bool set_chroma_maps(GroupChromaMaps chroma_maps, std::vector<LabFrame>& frames) {
  bool differs = false;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    differs = differ_strongly(chroma_maps[i], frames[i].chroma_maps) || differs;
    frames[i].chroma_maps = std::move(chroma_maps[i]);
  }
  return differs;
}

std::vector<ScoredHypothesis> concatenate(GroupCandidates by_group) {
  std::vector<ScoredHypothesis> all = std::move(by_group.front());
  for (std::size_t i = 1; i < by_group.size(); ++i)
    std::move(by_group[i].begin(), by_group[i].end(), std::back_inserter(all));
  return all;
}

/// Matches each candidate's best template again, at its place, in the camera's colours.
void rescore(const ScoringInput& input, int threads, std::vector<ScoredHypothesis>& candidates) {
  constexpr float kMinScore = 0.02F;  // score, if the colours were as usual
  const Forest& forest = input.index.forest();
  parallel_for(threads, static_cast<int>(candidates.size()), [&](int i) {
    ScoredHypothesis& candidate = candidates[static_cast<std::size_t>(i)];
    Evidence& evidence = candidate.evidence;
    if (evidence.view == Evidence::kNoView) return;
    if (!input.frame.chroma_maps[class_index_of(forest, candidate)].is_learnt()) return;  // its colours are as taught
    const ScoreModel& model = class_of(forest, candidate).score_model;
    if (score_with_typical_chroma(model, evidence) < kMinScore) return;
    evidence.fit = match_template(forest.views[evidence.view], evidence.view_centre, input.frame);
    candidate.detection.score = score(model, evidence);
    if (candidate.detection.score < input.settings.min_kept_score(candidate.detection.class_name))
      candidate.detection.rotations.clear();
  });
}

}  // namespace

std::vector<ScoredHypothesis> score_in_taught_colours(const std::vector<GroupHypotheses>& groups, int threads,
                                                      ScoringWorkspace& workspace) {
  return concatenate(score_by_group(groups, threads, workspace));
}

std::vector<ScoredHypothesis> score_in_camera_colours(const std::vector<GroupHypotheses>& groups,
                                                      const std::vector<ChromaPair>& colours, int threads,
                                                      ScoringWorkspace& workspace) {
  std::vector<LabFrame> frames;
  frames.reserve(groups.size());  // the inputs refer to them
  std::vector<GroupHypotheses> mapped;
  for (const auto& [input, hypotheses] : groups) {
    frames.push_back(input.frame);
    mapped.push_back({{input.index, frames.back(), input.patches, input.settings, input.excluded_views}, hypotheses});
  }
  const bool is_grey = is_colourless(frames.front().frame.colour);
  for (std::size_t i = 0; i < groups.size() && is_grey; ++i)
    frames[i].chroma_maps.assign(groups[i].input.index.forest().classes.size(), colourless_camera());
  if (is_grey) return concatenate(score_by_group(mapped, threads, workspace));
  if (!colours.empty()) set_chroma_maps(fit_group_maps(groups, colours), frames);
  GroupCandidates candidates = score_by_group(mapped, threads, workspace);
  // `mapped` refers to these frames: the maps that are set here are those of the next scoring.
  if (set_chroma_maps(fit_group_maps(groups, collect_pairs(groups, colours, candidates)), frames))
    return concatenate(score_by_group(mapped, threads, workspace));
  for (std::size_t i = 0; i < groups.size(); ++i) rescore(mapped[i].input, threads, candidates[i]);
  return concatenate(std::move(candidates));
}

}  // namespace houghstream
