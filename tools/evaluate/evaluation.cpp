#include "tools/evaluate/evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "pipeline/bus/percentiles.hpp"

namespace houghstream {
namespace {

int count_true(const std::vector<Prediction>& statements) {
  return static_cast<int>(
      std::count_if(statements.begin(), statements.end(), [](const Prediction& it) { return it.is_true; }));
}

Calibration calibrate_all(const std::vector<Prediction>& statements) {
  return calibrate(statements, count_true(statements));
}

std::set<std::string> detected_classes(const std::vector<EvaluatedFrame>& frames) {
  std::set<std::string> names;
  for (const EvaluatedFrame& frame : frames) {
    if (!frame.detections) continue;
    for (const Detection& detection : frame.detections->detections) names.insert(detection.class_name);
  }
  return names;
}

/// A pose carries the stages of the detections too; the frame's later message has them all.
std::map<std::string, double> stage_medians(const std::vector<EvaluatedFrame>& frames) {
  std::map<std::string, std::vector<double>> times_ms;
  for (const EvaluatedFrame& frame : frames) {
    if (!frame.detections) continue;
    const std::vector<StageTime>& stages = frame.poses ? frame.poses->stages : frame.detections->stages;
    for (const StageTime& stage : stages) {
      times_ms[stage.stage].push_back(static_cast<double>(stage.duration_us) * 1e-3);
    }
  }
  std::map<std::string, double> medians;
  for (const auto& [stage, times] : times_ms) medians[stage] = percentiles(times).p50;
  return medians;
}

/// Returns the poses that count. A frame that hs-pose passed over counts as the skipped frames do: its detections have
/// no poses, or are left out. So are candidates that no pose has confirmed.
std::vector<JudgedPose> counted_poses(std::vector<JudgedPose> judged, const std::vector<EvaluatedFrame>& frames,
                                      const EvaluationRules& rules) {
  const auto left_out = [&](const JudgedPose& pose) {
    return (rules.processed_only && !frames[pose.frame].poses) || !pose.reported;
  };
  judged.erase(std::remove_if(judged.begin(), judged.end(), left_out), judged.end());
  return judged;
}

/// Computes the calibration of the quality, and the number of published poses that are correct.
void score_qualities(const std::vector<EvaluatedFrame>& frames, const std::map<std::string, PoseModel>& models,
                     Evaluation& out) {
  const std::vector<EvaluatedFrame> all = with_unfiltered_poses(frames);
  std::vector<Prediction> of_right;
  std::vector<Prediction> of_shape;
  for (const ClassResult& result : out.classes) {
    const auto model = models.find(result.class_name);
    if (model == models.end()) continue;
    if (!out.published) out.published.emplace();
    for (const PosePrediction& published : pose_predictions(frames, result, model->second)) {
      ++out.published->count;
      out.published->correct += published.is_true ? 1 : 0;
      out.published->correct_up_to_shape += published.is_correct_up_to_shape ? 1 : 0;
    }
    for (const PosePrediction& known : pose_predictions(all, result, model->second)) {
      of_right.push_back(known);
      of_shape.push_back({known.confidence_up_to_shape, known.is_correct_up_to_shape});
    }
  }
  out.pose_calibration = calibrate_all(of_right);
  out.pose_calibration_up_to_shape = calibrate_all(of_shape);
}

void evaluate_poses(const std::vector<EvaluatedFrame>& frames, const std::map<std::string, PoseModel>& models,
                    const EvaluationRules& rules, Evaluation& out) {
  if (out.frames_with_poses == 0) return;  // no poses were estimated
  const double min_visible = rules.pose_min_visible;
  for (const ClassResult& result : out.classes) {
    const auto model = models.find(result.class_name);
    if (model == models.end()) continue;
    const std::vector<JudgedPose> judged = counted_poses(match_poses(frames, result, model->second), frames, rules);
    if (judged.empty()) continue;
    out.strict_recall[result.class_name] = strict_recall(judged, model->second.diameter, min_visible);
    out.add_s_recall[result.class_name] = add_s_recall(judged, model->second.diameter, min_visible);
    out.add_or_add_s_recall[result.class_name] = add_or_add_s_recall(judged, model->second, min_visible);
    out.poses.insert(out.poses.end(), judged.begin(), judged.end());
  }
}

}  // namespace

std::vector<EvaluatedFrame> counted_frames(const std::vector<EvaluatedFrame>& frames, const EvaluationRules& rules) {
  return rules.processed_only ? processed_frames(frames) : frames;
}

Evaluation evaluate(const std::vector<EvaluatedFrame>& all_frames, const std::vector<std::string>& class_names,
                    const std::map<std::string, PoseModel>& models, const EvaluationRules& rules) {
  const std::vector<EvaluatedFrame> processed = processed_frames(all_frames);
  const std::vector<EvaluatedFrame> frames = counted_frames(all_frames, rules);
  Evaluation out;
  out.frames = static_cast<int>(all_frames.size());
  out.frames_processed = static_cast<int>(processed.size());
  for (const EvaluatedFrame& frame : processed) out.frames_with_poses += frame.poses ? 1 : 0;
  int required = 0;
  for (const std::string& name : class_names) {
    out.classes.push_back(evaluate_class(frames, name, rules.detection));
    const float min_score = rules.operating_score_of(name);
    out.operating[name] = {count_reported(out.classes.back(), MatchOutcome::kTruePositive, min_score),
                           count_reported(out.classes.back(), MatchOutcome::kFalsePositive, min_score)};
    required += out.classes.back().required;
  }
  out.detection_calibration = calibrate(score_predictions(out.classes), required);
  for (const std::string& name : detected_classes(frames)) {
    const ClassResult result = evaluate_class(frames, name, rules.detection);
    out.false_detections += count_reported(result, MatchOutcome::kFalsePositive, rules.operating_score_of(name)).all();
  }
  evaluate_poses(frames, models, rules, out);
  score_qualities(frames, models, out);
  out.followed = count_followed_poses(all_frames, class_names, models, rules.detection.min_visible);
  out.stage_ms = stage_medians(frames);
  return out;
}

double mean_of(const std::map<std::string, double>& values) {
  double sum = 0.0;
  int count = 0;
  for (const auto& entry : values) {
    if (!std::isfinite(entry.second)) continue;
    sum += entry.second;
    ++count;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace houghstream
