#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/evaluate/metrics/average_recall.hpp"
#include "tools/evaluate/metrics/detection_metrics.hpp"
#include "tools/evaluate/metrics/followed_poses.hpp"
#include "tools/evaluate/metrics/pose_metrics.hpp"

namespace houghstream {

struct EvaluationRules {
  DetectionRules detection;
  double pose_min_visible = 0.5;  ///< poses of less visible objects do not enter the recall
  /// Precision, recall and false detections count detections from this score on, and candidates that have a pose.
  float operating_score = 0.0F;
  std::map<std::string, float> class_operating_scores{};  ///< of single classes, by name; of the others: the above
  /// Leaves skipped frames out; else their objects, and the poses of what was found there, count as missed.
  bool processed_only = false;
  /// Curves and AUC know detections from this score on; nothing where others decided.
  std::optional<float> ranked_from;
  std::optional<float> min_quality;   ///< poses of lower quality were withheld; nothing where others decided that
  std::optional<double> precision{};  ///< precision for which scores and qualities of the classes were chosen

  /// Returns the operating score of this class.
  float operating_score_of(const std::string& class_name) const {
    const auto known = class_operating_scores.find(class_name);
    return known != class_operating_scores.end() ? known->second : operating_score;
  }
};

/// Detections of one class at the operating score.
struct OperatingPoint {
  ReportedCount correct;  ///< objects that are there
  ReportedCount incorrect;
};

/// The poses that were published of listed classes with a model, but those of ignored detections.
struct PublishedPoses {
  int count = 0;
  int correct = 0;              ///< number of poses of true detections that are correct, by is_correct()
  int correct_up_to_shape = 0;  ///< number of poses of true detections with ADD-S below 10 % of the diameter
};

/// The figures of one scene, or of several ones together. NaN where there is nothing to measure.
struct Evaluation {
  int frames = 0;            ///< number of frames of the scenes
  int frames_processed = 0;  ///< number of frames with detections
  int frames_with_poses = 0;
  std::vector<ClassResult> classes;  ///< results in the order of the list
  std::map<std::string, OperatingPoint> operating;
  int false_detections = 0;  ///< reported, of all classes, listed or not
  /// Calibration of the scores of all detections of listed classes, however low, except ignored ones; its recall is
  /// over all required objects. Below the threshold with which they were found nothing is known.
  Calibration detection_calibration;
  /// Calibration of the quality of these detections' poses (pose_predictions()), with the rejected ones where they are
  /// known; its recall is over all correct poses.
  Calibration pose_calibration;
  Calibration pose_calibration_up_to_shape;  ///< calibration by ADD-S
  std::optional<PublishedPoses> published;   ///< nothing unless a listed class has a model to judge poses with
  std::vector<JudgedPose> poses;             ///< poses of true detections of listed classes that have a model
  std::map<std::string, double> strict_recall;
  std::map<std::string, double> add_s_recall;
  std::map<std::string, double> add_or_add_s_recall;
  /// Figures of all frames of the scenes, whether a detector inspected them or not; nothing unless objects were
  /// followed.
  std::optional<FollowedPoses> followed;
  std::optional<LocalisationScores> localisation;  ///< nothing unless poses were measured against depth too
  std::optional<LocalisationScores> localisation_nothing_withheld;  ///< nothing unless withheld poses are known
  std::map<std::string, double> stage_ms;                           ///< median by stage
};

/// Returns the frames that count under the rules.
std::vector<EvaluatedFrame> counted_frames(const std::vector<EvaluatedFrame>& frames, const EvaluationRules& rules);

/// Compares results with the truth for the listed classes; `models` by class name, may lack some.
Evaluation evaluate(const std::vector<EvaluatedFrame>& frames, const std::vector<std::string>& class_names,
                    const std::map<std::string, PoseModel>& models, const EvaluationRules& rules);

/// Returns the mean over the finite values; NaN without any.
double mean_of(const std::map<std::string, double>& values);

}  // namespace houghstream
