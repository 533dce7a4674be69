#include "tools/studies/baselines/linemod_tuning.hpp"

#include <algorithm>
#include <map>

#include "detector/training/augmentation/validation_frames.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/bus/percentiles.hpp"
#include "tools/evaluate/metrics/detection_metrics.hpp"
#include "tools/studies/baselines/linemod_detector.hpp"

namespace houghstream {
namespace {

EvaluatedFrame to_ground_truth(const training::ValidationFrame& composed,
                               const std::vector<const TrainingView*>& shown) {
  EvaluatedFrame truth;
  for (const training::ValidationFrame::Object& object : composed.objects) {
    NamedObject named;
    named.class_name = shown[object.view.value()]->class_name;
    named.truth.box_visible_px = object.box_visible_px;
    named.truth.visible_fraction = object.visible_fraction;
    truth.objects.push_back(named);
  }
  return truth;
}

/// Finds the best F1 over the detections of all classes together, strongest first.
void find_best_f1(const std::vector<ClassResult>& classes, LinemodTrial& trial) {
  std::vector<MatchedDetection> all;
  int required = 0;
  for (const ClassResult& result : classes) {
    all.insert(all.end(), result.judged.begin(), result.judged.end());
    required += result.required;
  }
  trial.best_f1 = 0.0;
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
  for (const CurvePoint& point : precision_recall_curve(all, required)) {
    const double sum = point.precision + point.recall;
    const double f1 = sum > 0.0 ? 2.0 * point.precision * point.recall / sum : 0.0;
    if (f1 <= trial.best_f1) continue;
    trial.best_f1 = f1;
    trial.best_score = point.score;
  }
}

using Matches = std::vector<std::vector<LinemodMatch>>;

void score_trial(const ComposedExamples& examples, const Matches& matches, LinemodTrial& trial) {
  std::vector<EvaluatedFrame> frames = examples.truth;
  std::vector<double> selection_ms;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    StageClock clock;
    frames[f].detections = Detections{};
    frames[f].detections->detections = select_detections(matches[f], examples.frames[f], trial.selection);
    clock.mark("");
    selection_ms.push_back(static_cast<double>(clock.times().back().duration_us) * 1e-3);
  }
  trial.selection_ms = percentiles(selection_ms).p50;
  std::vector<ClassResult> classes;
  for (const std::string& name : examples.class_names) classes.push_back(evaluate_class(frames, name, {}));
  trial.auc = mean_auc(classes);
  find_best_f1(classes, trial);
}

/// Settings that are applied after matching.
std::vector<LinemodSelection> selections(LinemodSelection selection) {
  selection.check_depth = false;
  std::vector<LinemodSelection> out = {selection};
  selection.check_depth = true;
  for (const float tolerance : {0.06F, 0.1F, 0.15F, 0.2F}) {
    selection.depth_tolerance = tolerance;
    out.push_back(selection);
  }
  return out;
}

std::vector<LinemodTemplateSettings> template_grid(const LinemodTemplateSettings& base) {
  std::vector<LinemodTemplateSettings> out;
  for (const int features : {31, 63}) {
    for (const float step : {1.1F, 1.15F, 1.3F}) {
      for (const float weak_gradient : {10.0F, 30.0F}) {
        out.push_back(base);
        out.back().features = features;
        out.back().distance_step = step;
        out.back().weak_gradient = weak_gradient;
      }
    }
  }
  return out;
}

Matches match_all(const LinemodTemplates& templates, const ComposedExamples& examples, LinemodTrial& trial) {
  Matches matches;
  std::vector<double> match_ms;
  for (const RgbdFrame& frame : examples.frames) {
    StageClock clock;
    matches.push_back(templates.match(frame, trial.selection.match_threshold));
    clock.mark("");
    match_ms.push_back(static_cast<double>(clock.times().back().duration_us) * 1e-3);
  }
  trial.match_ms = percentiles(match_ms).p50;
  return matches;
}

}  // namespace

ComposedExamples compose_examples(const std::vector<TrainingView>& views, float min_distance, float max_distance,
                                  int images) {
  constexpr int kShownOneIn = 4;
  constexpr std::uint64_t kSeed = 20110701;
  constexpr training::ComposedThings kThings = {4, 2, 0};
  ComposedExamples out;
  std::vector<const TrainingView*> shown;
  std::vector<const TrainingView*> backgrounds;
  std::map<int, int> seen;  // views by class id
  for (const TrainingView& view : views) {
    if (view.class_id == 0) {
      backgrounds.push_back(&view);
    } else if (seen[view.class_id]++ % kShownOneIn == kShownOneIn - 1) {
      shown.push_back(&view);
    } else {
      out.taught.push_back(view);
      out.class_names.insert(view.class_name);
    }
  }
  require(!shown.empty() && !backgrounds.empty(), "{} views to show in {} background views, expected some of each",
          shown.size(), backgrounds.size());
  training::AugmentationSettings settings;
  settings.min_distance = min_distance;
  settings.max_distance = max_distance;
  for (std::size_t f = 0; f < static_cast<std::size_t>(images); ++f) {
    Random random = Random::for_item(kSeed, f);
    const training::ValidationFrame composed =
        training::make_validation_frame(shown, backgrounds[f % backgrounds.size()]->frame, kThings, settings, random);
    out.frames.push_back(composed.frame);
    out.truth.push_back(to_ground_truth(composed, shown));
  }
  return out;
}

void tune_linemod(const std::vector<TrainingView>& views, const LinemodTemplateSettings& base,
                  const LinemodSelection& base_selection, int images,
                  const std::function<void(const LinemodTrial&)>& report) {
  const ComposedExamples examples = compose_examples(views, base.min_distance, base.max_distance, images);
  for (const LinemodTemplateSettings& settings : template_grid(base)) {
    const LinemodTemplates templates(examples.taught, settings);
    LinemodTrial trial;
    trial.templates = settings;
    trial.template_count = templates.training().templates;
    trial.selection = base_selection;
    const Matches matches = match_all(templates, examples, trial);
    for (const LinemodSelection& selection : selections(base_selection)) {
      trial.selection = selection;
      score_trial(examples, matches, trial);
      report(trial);
    }
  }
}

}  // namespace houghstream
