#include "detector/evidence/camera_chroma.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "pipeline/base/parallel.hpp"

namespace houghstream {
namespace {

/// The camera's rendering of the colours of each class of each group.
using GroupCameras = std::vector<std::vector<ChromaMap>>;

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

bool is_beside(const ScoredHypothesis& a, const ScoredHypothesis& b, float radius) {
  return (a.detection.centre_camera - b.detection.centre_camera).norm() < radius;
}

using SamplesByClass = std::map<std::string, std::vector<ChromaSample>>;

void add_samples(const Forest& forest, const std::vector<ScoredHypothesis>& candidates, SamplesByClass& by_class) {
  constexpr float kMinProbability = 0.05F;
  for (const ScoredHypothesis& candidate : candidates) {
    if (candidate.evidence.view == Evidence::kNoView || !candidate.evidence.fit.colours.is_known) continue;
    const ObjectClass& object = class_of(forest, candidate);
    const float probability = score_as_taught(object.score_model, candidate.evidence);
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
    std::vector<ChromaSample> kept;
    for (const ChromaSample& sample : samples) {
      const float radius = sample.object->radius;
      const bool is_known = std::any_of(kept.begin(), kept.end(), [&](const ChromaSample& other) {
        return is_beside(*sample.candidate, *other.candidate, radius);
      });
      if (!is_known && kept.size() < kMaxPerClass) kept.push_back(sample);
    }
    likeliest.insert(likeliest.end(), kept.begin(), kept.end());
  }
  return likeliest;
}

/// Divides certainty among the samples of one place: only one object stands there, of whichever class, or none, so
/// that the odds of all of them share it.
void normalise_overlapping(std::vector<ChromaSample>& samples) {
  std::vector<float> odds;
  odds.reserve(samples.size());
  for (const ChromaSample& sample : samples) odds.push_back(sample.probability / (1.0F - sample.probability));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const float radius = samples[i].object->radius;
    float all = 1.0F;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const float reach = 0.5F * (radius + samples[k].object->radius);
      if (is_beside(*samples[i].candidate, *samples[k].candidate, reach)) all += odds[k];
    }
    samples[i].probability = odds[i] / all;
  }
}

ChromaPair to_pair(const ChromaSample& sample) {
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
GroupCameras learn_cameras(const std::vector<GroupHypotheses>& groups, const std::vector<ChromaPair>& pairs) {
  GroupCameras cameras;
  for (const GroupHypotheses& searched : groups) {
    std::vector<ChromaMap>& by_class = cameras.emplace_back();
    for (const ObjectClass& object : searched.input.index.forest().classes)
      by_class.push_back(fit_chroma_map_without(object.name, pairs));
  }
  return cameras;
}

/// Returns the pairs of earlier frames and those of the frame's candidates.
std::vector<ChromaPair> all_pairs(const std::vector<GroupHypotheses>& groups, std::vector<ChromaPair> pairs,
                                  const GroupCandidates& candidates) {
  std::vector<ChromaSample> samples = find_likeliest(groups, candidates);
  normalise_overlapping(samples);
  std::transform(samples.begin(), samples.end(), std::back_inserter(pairs), to_pair);
  return pairs;
}

/// Returns whether views must be searched again in these colours, since more than the best of them may differ.
bool differ_strongly(const std::vector<ChromaMap>& cameras, const std::vector<ChromaMap>& before) {
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

/// Brings the groups' frames into the colours of their cameras. Returns whether views must be searched again, where a
/// camera is far from them.
bool apply_camera_maps(GroupCameras cameras, std::vector<LabFrame>& frames) {
  bool is_far = false;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    is_far = differ_strongly(cameras[i], frames[i].cameras) || is_far;
    frames[i].cameras = std::move(cameras[i]);
  }
  return is_far;
}

std::vector<ScoredHypothesis> concatenate(GroupCandidates by_group) {
  std::vector<ScoredHypothesis> all = std::move(by_group.front());
  for (std::size_t i = 1; i < by_group.size(); ++i)
    std::move(by_group[i].begin(), by_group[i].end(), std::back_inserter(all));
  return all;
}

/// Matches each candidate's best template again, at its place, in the camera's colours.
void rescore(const ScoringInput& input, int threads, std::vector<ScoredHypothesis>& candidates) {
  constexpr float kHopeless = 0.02F;  // score, if the colours were as usual
  const Forest& forest = input.index.forest();
  parallel_for(threads, static_cast<int>(candidates.size()), [&](int i) {
    ScoredHypothesis& candidate = candidates[static_cast<std::size_t>(i)];
    Evidence& evidence = candidate.evidence;
    if (evidence.view == Evidence::kNoView) return;
    if (!input.frame.cameras[class_index_of(forest, candidate)].is_learnt()) return;  // its colours are as taught
    const ScoreModel& model = class_of(forest, candidate).score_model;
    if (score_as_taught(model, evidence) < kHopeless) return;
    evidence.fit = match_template(forest.views[evidence.view], evidence.view_centre, input.frame);
    candidate.detection.score = score(model, evidence);
    const float threshold = input.settings.threshold_of(candidate.detection.class_name);
    const float minimum = std::min(threshold, input.settings.candidates_from);
    if (candidate.detection.score < minimum) candidate.detection.rotations.clear();
  });
}

}  // namespace

std::vector<ScoredHypothesis> score_groups(const std::vector<GroupHypotheses>& groups, int threads,
                                           ScoringWorkspace& workspace) {
  return concatenate(score_by_group(groups, threads, workspace));
}

std::vector<ScoredHypothesis> score_in_camera_colours(const std::vector<GroupHypotheses>& groups,
                                                      const std::vector<ChromaPair>& colours, int threads,
                                                      ScoringWorkspace& workspace) {
  std::vector<LabFrame> frames;
  frames.reserve(groups.size());  // the inputs refer to them
  std::vector<GroupHypotheses> in_camera;
  for (const auto& [input, hypotheses] : groups) {
    frames.push_back(input.frame);
    in_camera.push_back(
        {{input.index, frames.back(), input.patches, input.settings, input.excluded_views}, hypotheses});
  }
  const bool is_grey = is_colourless(frames.front().frame.colour);
  for (std::size_t i = 0; i < groups.size() && is_grey; ++i)
    frames[i].cameras.assign(groups[i].input.index.forest().classes.size(), colourless_camera());
  if (is_grey) return score_groups(in_camera, threads, workspace);
  if (!colours.empty()) apply_camera_maps(learn_cameras(groups, colours), frames);
  GroupCandidates candidates = score_by_group(in_camera, threads, workspace);
  if (apply_camera_maps(learn_cameras(groups, all_pairs(groups, colours, candidates)), frames))
    return score_groups(in_camera, threads, workspace);
  for (std::size_t i = 0; i < groups.size(); ++i) rescore(in_camera[i].input, threads, candidates[i]);
  return concatenate(std::move(candidates));
}

}  // namespace houghstream
