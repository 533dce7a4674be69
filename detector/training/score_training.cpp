#include "detector/training/score_training.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "detector/stages.hpp"
#include "detector/training/augmentation/sensor_errors.hpp"
#include "detector/training/augmentation/validation_frames.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/logistic_regression.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream::training {
namespace {

/// Criterion of the paper's protocol for a detected object (Section 4).
constexpr float kMinIou = 0.5F;
constexpr double kMinVisible = 0.1;

/// Composes as many objects as make most of an image without hiding each other, and nearly twice as many that look like
/// them.
constexpr ComposedThings kThings = {6, 5, 0};
constexpr ComposedThings kHardNegativeObjects = {6, 5, 5};

/// Labels the hypotheses, strongest first; one that overlaps a stronger one of its class would not be reported, so it
/// is no example.
ScoreExamples label_hypotheses(const std::vector<ScoredHypothesis>& candidates, const ValidationFrame& truth) {
  ScoreExamples examples;
  std::vector<const Detection*> kept;
  for (const ScoredHypothesis& candidate : candidates) {
    const Detection& found = candidate.detection;
    const auto repeats = [&](const Detection* other) {
      return other->class_id == found.class_id && box_iou(other->box_px, found.box_px) > kMinIou;
    };
    if (std::any_of(kept.begin(), kept.end(), repeats)) continue;
    kept.push_back(&found);
    bool is_object = false;
    bool is_hidden = false;
    for (const ValidationFrame::Object& object : truth.objects) {
      if (object.class_id != found.class_id) continue;
      const bool meets = box_iou(found.box_px, cv::Rect2f(object.box_visible_px)) >= kMinIou;
      is_object = is_object || (meets && object.visible_fraction >= kMinVisible);
      is_hidden = is_hidden || (meets && object.visible_fraction < kMinVisible);
    }
    if (is_object || !is_hidden) examples[found.class_id].push_back({score_terms(candidate.evidence), is_object});
  }
  return examples;
}

/// Composes a background with objects, in which near surfaces may have lost their depth.
ValidationFrame compose(const std::vector<const TrainingView*>& objects, const RgbdFrame& background,
                        const ComposedThings& things, const TrainingSettings& settings, Random& random) {
  constexpr double kMin = 0.05;  // fraction of the depth that is kept
  constexpr double kMax = 0.6;
  ValidationFrame composed = make_validation_frame(objects, background, things, settings, random);
  if (random.uniform() >= settings.near_dropout_fraction) return composed;
  const double limit = random.uniform(settings.min_distance, settings.max_distance);
  const double kept = std::exp(random.uniform(std::log(kMin), std::log(kMax)));
  drop_near_depth(limit, kept, composed.frame.depth, random);
  return composed;
}

/// Returns as many frames as the settings say, numbered from `first` on. What is referred to must outlive it.
ValidationSource frames_from(int first, const ComposedThings& things, const std::vector<const TrainingView*>& objects,
                             const std::vector<const TrainingView*>& backgrounds, const TrainingSettings& settings) {
  return {settings.validation_frames, [first, things, &objects, &backgrounds, &settings](int index) {
            const auto item = static_cast<std::uint64_t>(first + index);
            Random random = Random::for_item(settings.seed ^ 0x73636F7265ULL, item);
            return compose(objects, backgrounds[item % backgrounds.size()]->frame, things, settings, random);
          }};
}

/// Merges the examples of all frames.
ScoreExamples joined(const std::vector<ScoreExamples>& by_frame) {
  ScoreExamples by_class;
  for (const ScoreExamples& part : by_frame) {
    for (const auto& [class_id, examples] : part) {
      std::vector<ScoreExample>& class_examples = by_class[class_id];
      class_examples.insert(class_examples.end(), examples.begin(), examples.end());
    }
  }
  return by_class;
}

/// Scale of the logits: (factor, offset).
using OddsScale = Eigen::Vector2d;
using OddsExamples = std::vector<LogisticExample<2>>;

OddsExamples odds_examples(const ScoreModel& model, const std::vector<ScoreExample>& examples) {
  OddsExamples out;
  for (const ScoreExample& example : examples)
    out.push_back({{score_logit(model, example.terms), 1.0}, example.is_object});
  return out;
}

OddsScale fit_scale(const OddsExamples& examples, const OddsScale& prior) {
  constexpr double kPriorPrecision = 1.0;
  return fit_logistic<2>(examples, {prior, kPriorPrecision});
}

void scale_odds(const OddsScale& scale, ScoreModel& model) {
  for (const auto term : kScoreTermList) model.weights.*term *= static_cast<float>(scale[0]);
  model.weights.constant += static_cast<float>(scale[1]);
}

std::string described(const ScoreTerms& weights) {
  std::string text;
  for (std::size_t i = 0; i < kScoreTerms; ++i)
    text += fmt::format(" {} {:.2f}", kScoreTermNames[i], weights.*kScoreTermList[i]);
  return text;
}

}  // namespace

ValidationSource composed_frames(const std::vector<const TrainingView*>& objects,
                                 const std::vector<const TrainingView*>& backgrounds,
                                 const TrainingSettings& settings) {
  return frames_from(0, kThings, objects, backgrounds, settings);
}

ValidationSource compose_hard_negative_frames(const std::vector<const TrainingView*>& objects,
                                              const std::vector<const TrainingView*>& backgrounds,
                                              const TrainingSettings& settings) {
  ValidationSource source =
      frames_from(settings.validation_frames, kHardNegativeObjects, objects, backgrounds, settings);
  source.count = (source.count + 1) / 2;  // half of them, for two numbers of each object
  return source;
}

std::vector<ScoreExamples> find_score_examples(const ValidationSource& source, std::uint32_t first_view,
                                               const Profile& profile, const Forest& forest, const Scales& scales) {
  DetectionSettings detection = profile.detection;
  detection.threads = 1;
  detection.evidence.learn_camera_colours = false;
  // Of what a frame has no time for, scores learn too.
  detection.evidence.max_compared = std::numeric_limits<int>::max();
  detection.evidence.max_sampled = std::numeric_limits<int>::max();
  detection.evidence.max_refined = std::numeric_limits<int>::max();
  detection.evidence.explains_from = 2.0F;
  const ForestIndex index(forest);
  const int threads = profile.training.threads;
  std::vector<ScoreExamples> by_frame(static_cast<std::size_t>(source.count));
  PerWorker<DetectorWorkspace> workspaces;
  workspaces.resize(threads);
  parallel_for_workers(threads, source.count, [&](int worker, int f) {
    const ValidationFrame validation = source.frame(f);
    std::vector<std::uint32_t> shown = validation.distractor_views;
    for (const ValidationFrame::Object& object : validation.objects) {
      if (object.view) shown.push_back(*object.view);
    }
    for (std::uint32_t& view : shown) view += first_view;
    SearchContext search{index, detection};
    search.excluded_views = std::move(shown);
    by_frame[static_cast<std::size_t>(f)] =
        label_hypotheses(scales.search(search, validation.frame, workspaces[worker]), validation);
  });
  return by_frame;
}

void fit_scores(const std::vector<ScoreExamples>& by_frame, const std::set<int>& class_ids, Forest& forest) {
  ScoreExamples by_class = joined(by_frame);
  std::vector<ScoreExample> all;
  for (const ScoreExamples& part : by_frame) {
    for (const auto& [class_id, examples] : part) all.insert(all.end(), examples.begin(), examples.end());
  }
  const ScoreModel common = fit_score_model(all, ScoreModel{});
  log_debug("scores of all objects together, {} examples:{}", all.size(), described(common.weights));
  for (ObjectClass& object : forest.classes) {
    if (class_ids.count(object.class_id) == 0) continue;  // an older object, judged before
    object.score_model = fit_score_model(by_class[object.class_id], common);
  }
}

void scale_log_odds(const std::vector<ScoreExamples>& by_frame, const std::set<int>& class_ids, Forest& forest) {
  ScoreExamples examples = joined(by_frame);
  OddsExamples all;
  std::map<int, OddsExamples> by_class;
  for (const ObjectClass& object : forest.classes) {
    if (class_ids.count(object.class_id) == 0) continue;
    OddsExamples& class_examples = by_class[object.class_id];
    class_examples = odds_examples(object.score_model, examples[object.class_id]);
    all.insert(all.end(), class_examples.begin(), class_examples.end());
  }
  const OddsScale common = fit_scale(all, OddsScale(1.0, 0.0));
  log_debug("log odds among strangers, {} examples: {:.2f} times, {:+.2f}", all.size(), common[0], common[1]);
  for (ObjectClass& object : forest.classes) {
    const auto class_examples = by_class.find(object.class_id);
    if (class_examples != by_class.end()) scale_odds(fit_scale(class_examples->second, common), object.score_model);
  }
}

}  // namespace houghstream::training
