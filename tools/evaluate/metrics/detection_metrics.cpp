#include "tools/evaluate/metrics/detection_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace houghstream {
namespace {

using ObjectKey = std::pair<std::size_t, std::size_t>;  // frame, object

/// Returns a detection of the class that has no verdict yet.
MatchedDetection unjudged(const EvaluatedFrame& frame, std::size_t f, std::size_t index) {
  const Detection& detection = frame.detections->detections[index];
  const ObjectPose* pose = frame.poses ? find_pose(*frame.poses, index) : nullptr;
  MatchedDetection unjudged;
  unjudged.frame = f;
  unjudged.index = index;
  unjudged.score = detection.score;
  unjudged.is_candidate = !detection.reported || (pose != nullptr && pose->status == PoseStatus::kRefuted);
  unjudged.has_pose = pose != nullptr && has_pose(pose->status);
  return unjudged;
}

/// Returns the class's detections over all frames, strongest first.
std::vector<MatchedDetection> ranked_detections(const std::vector<EvaluatedFrame>& frames,
                                                const std::string& class_name, int max_per_class) {
  const auto stronger = [](const MatchedDetection& a, const MatchedDetection& b) { return a.score > b.score; };
  std::vector<MatchedDetection> all;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    if (!frames[f].detections) continue;
    const std::vector<Detection>& detections = frames[f].detections->detections;
    std::vector<MatchedDetection> here;
    for (std::size_t i = 0; i < detections.size(); ++i) {
      if (detections[i].class_name != class_name) continue;
      here.push_back(unjudged(frames[f], f, i));
    }
    std::stable_sort(here.begin(), here.end(), stronger);
    if (here.size() > static_cast<std::size_t>(max_per_class)) here.resize(static_cast<std::size_t>(max_per_class));
    all.insert(all.end(), here.begin(), here.end());
  }
  std::stable_sort(all.begin(), all.end(), stronger);
  return all;
}

/// Gives the detection its verdict, and takes the object that it finds.
void match_detection(MatchedDetection& detection, const EvaluatedFrame& frame, const DetectionRules& rules,
                     std::set<ObjectKey>& taken) {
  const Detection& found = frame.detections->detections[detection.index];
  double best_iou = 0.0;
  for (std::size_t o = 0; o < frame.objects.size(); ++o) {
    const NamedObject& object = frame.objects[o];
    if (object.class_name != found.class_name) continue;
    const double iou = box_iou(found.box_px, cv::Rect2f(object.truth.box_visible_px));
    if (iou < rules.min_iou) continue;
    if (!is_required(object, rules)) {
      if (detection.outcome == MatchOutcome::kFalsePositive) detection.outcome = MatchOutcome::kIgnored;
    } else if (iou > best_iou && taken.count({detection.frame, o}) == 0) {
      detection.outcome = MatchOutcome::kTruePositive;
      detection.object = o;
      best_iou = iou;
    }
  }
  if (detection.outcome == MatchOutcome::kTruePositive) taken.insert({detection.frame, detection.object});
}

}  // namespace

bool is_required(const NamedObject& object, const DetectionRules& rules) {
  const bool is_target = object.is_target.value_or(object.truth.visible_fraction >= rules.min_visible);
  return is_target && !object.truth.box_visible_px.empty();
}

std::vector<MatchedDetection> match_detections(const std::vector<EvaluatedFrame>& frames, const std::string& class_name,
                                               const DetectionRules& rules) {
  std::vector<MatchedDetection> judged = ranked_detections(frames, class_name, rules.max_per_class);
  std::set<ObjectKey> taken;
  for (MatchedDetection& detection : judged) match_detection(detection, frames[detection.frame], rules, taken);
  return judged;
}

int count_required(const std::vector<EvaluatedFrame>& frames, const std::string& class_name,
                   const DetectionRules& rules) {
  int required = 0;
  for (const EvaluatedFrame& frame : frames) {
    for (const NamedObject& object : frame.objects) {
      required += object.class_name == class_name && is_required(object, rules) ? 1 : 0;
    }
  }
  return required;
}

std::vector<CurvePoint> precision_recall_curve(const std::vector<MatchedDetection>& judged, int required) {
  std::vector<CurvePoint> curve;
  int true_count = 0;
  for (const MatchedDetection& detection : judged) {
    if (detection.outcome == MatchOutcome::kIgnored) continue;
    true_count += detection.outcome == MatchOutcome::kTruePositive ? 1 : 0;
    const double precision = static_cast<double>(true_count) / static_cast<double>(curve.size() + 1);
    curve.push_back({detection.score, precision, required > 0 ? static_cast<double>(true_count) / required : 0.0});
  }
  return curve;
}

double average_precision(const std::vector<MatchedDetection>& judged, int required) {
  double sum = 0.0;
  int true_count = 0;
  int counted = 0;
  for (const MatchedDetection& detection : judged) {
    if (detection.outcome == MatchOutcome::kIgnored) continue;
    ++counted;
    if (detection.outcome == MatchOutcome::kTruePositive) sum += static_cast<double>(++true_count) / counted;
  }
  return sum / required;
}

ClassResult evaluate_class(const std::vector<EvaluatedFrame>& frames, const std::string& class_name,
                           const DetectionRules& rules) {
  ClassResult result;
  result.class_name = class_name;
  result.required = count_required(frames, class_name, rules);
  result.judged = match_detections(frames, class_name, rules);
  result.auc = std::numeric_limits<double>::quiet_NaN();
  result.curve = precision_recall_curve(result.judged, result.required);
  if (result.required > 0) result.auc = average_precision(result.judged, result.required);
  return result;
}

std::vector<Prediction> score_predictions(const std::vector<ClassResult>& classes) {
  std::vector<Prediction> statements;
  for (const ClassResult& result : classes) {
    for (const MatchedDetection& detection : result.judged) {
      if (detection.outcome == MatchOutcome::kIgnored) continue;
      statements.push_back({static_cast<double>(detection.score), detection.outcome == MatchOutcome::kTruePositive});
    }
  }
  return statements;
}

double mean_auc(const std::vector<ClassResult>& classes) {
  double sum = 0.0;
  int count = 0;
  for (const ClassResult& result : classes) {
    if (result.required == 0) continue;
    sum += result.auc;
    ++count;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

double weighted_auc(const std::vector<ClassResult>& classes) {
  double sum = 0.0;
  int count = 0;
  for (const ClassResult& result : classes) {
    if (result.required == 0) continue;
    sum += result.auc * result.required;
    count += result.required;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

ReportedCount count_reported(const ClassResult& result, MatchOutcome outcome, float min_score) {
  ReportedCount count;
  for (const MatchedDetection& it : result.judged) {
    if (it.outcome != outcome) continue;
    count.detections += !it.is_candidate && it.score >= min_score ? 1 : 0;
    count.confirmed += it.is_candidate && it.has_pose ? 1 : 0;
  }
  return count;
}

}  // namespace houghstream
