#pragma once

#include <string>
#include <vector>

#include "tools/evaluate/metrics/calibration.hpp"
#include "tools/evaluate/metrics/evaluated_frame.hpp"

namespace houghstream {

/// Criteria of a match (Haensch et al. 2017, Section 4, after Everingham et al. 2010).
struct DetectionRules {
  double min_iou = 0.5;      ///< overlap of the detected with the true visible box
  double min_visible = 0.1;  ///< objects less visible than this are neither required nor false, unless they are targets
  int max_per_class = 250;   ///< strongest detections of a class in a frame that count
};

enum class MatchOutcome { kTruePositive, kFalsePositive, kIgnored };

/// One detection of one class, judged.
struct MatchedDetection {
  std::size_t frame = 0;  ///< index into the evaluated frames
  std::size_t index = 0;  ///< index into the frame's detections
  float score = 0.0F;
  MatchOutcome outcome = MatchOutcome::kFalsePositive;
  std::size_t object = 0;     ///< index into the frame's objects; only meaningful where true
  bool is_candidate = false;  ///< not Detection::reported, or refuted by its pose
  bool has_pose = false;      ///< whether its pose was published
};

/// Judges all detections of a class, strongest first over all frames (ties by frame, then index). A detection is true
/// when it overlaps a required object that no stronger detection has taken (the one of largest overlap); repeated
/// detections are false; one that overlaps only an object that is not required is ignored.
std::vector<MatchedDetection> match_detections(const std::vector<EvaluatedFrame>& frames, const std::string& class_name,
                                               const DetectionRules& rules);

/// Returns whether an object is visible enough to be required, or a target.
bool is_required(const NamedObject& object, const DetectionRules& rules);

/// Counts the objects of the class that are visible enough to be required, or targets.
int count_required(const std::vector<EvaluatedFrame>& frames, const std::string& class_name,
                   const DetectionRules& rules);

struct CurvePoint {
  float score = 0.0F;
  double precision = 0.0;
  double recall = 0.0;
};

/// Returns one point per detection that counts. All detections of an absent class are false: precision and recall are
/// 0, so that they count where several scenes are pooled.
std::vector<CurvePoint> precision_recall_curve(const std::vector<MatchedDetection>& judged, int required);

/// Returns the area under the precision/recall curve, un-interpolated: the sum of the precision at each true positive
/// over the number of required objects, so that missed recall counts 0 (average precision as in Buckley & Voorhees
/// 2000). `required` > 0.
double average_precision(const std::vector<MatchedDetection>& judged, int required);

/// Detection result of one class.
struct ClassResult {
  std::string class_name;
  int required = 0;
  double auc = 0.0;  ///< NaN where no object is required
  std::vector<MatchedDetection> judged;
  std::vector<CurvePoint> curve;
};
ClassResult evaluate_class(const std::vector<EvaluatedFrame>& frames, const std::string& class_name,
                           const DetectionRules& rules);

/// Returns the scores of all detections that are true or false positives, as predictions.
std::vector<Prediction> score_predictions(const std::vector<ClassResult>& classes);

/// Returns the mean AUC over the classes that appear, each counting once; NaN where none appears.
double mean_auc(const std::vector<ClassResult>& classes);

/// Returns the mean AUC weighted by the number of required objects; NaN where none appears.
double weighted_auc(const std::vector<ClassResult>& classes);

/// Detections of a class at a score, matched with the ground truth.
struct ReportedCount {
  int detections = 0;  ///< number of detections by their score
  int confirmed = 0;   ///< number of candidates by their pose
  int all() const { return detections + confirmed; }
};

/// Counts detections of verdict `outcome` with at least `min_score`, and candidates with a pose whatever their score.
ReportedCount count_reported(const ClassResult& result, MatchOutcome outcome, float min_score);

}  // namespace houghstream
