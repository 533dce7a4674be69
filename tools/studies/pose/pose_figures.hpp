#pragma once

#include <map>
#include <string>
#include <vector>

#include "drivers/files/json_file.hpp"
#include "tools/studies/pose/pose_trials.hpp"

namespace houghstream {

/// Shares of the true detections of objects visible enough; one without a pose has none that is right. NaN where there
/// is no such detection.
struct PoseRecall {
  int detections = 0;
  double correct = 0.0;  ///< PoseTrial::is_correct()
  double add_s = 0.0;    ///< correct up to the symmetries of the shape: ADD-S below 10 % of the diameter
  double add = 0.0;      ///< ADD below it, ADD-S for objects that are symmetric
};
PoseRecall pose_recall(const std::vector<PoseTrial>& trials, float min_score);

/// Holds figures over all scenes and classes; NaN without anything to measure.
struct PoseFigures {
  int detections = 0;
  int published = 0;       ///< poses
  double ms_median = 0.0;  ///< median over published poses, like all below
  double ms_p99 = 0.0;
  double mm_median = 0.0;           ///< translation error of true detections
  double mm_per_m_sq_median = 0.0;  ///< the same over the square of the distance, since depth's noise grows with it
  double deg_median = 0.0;          ///< rotation error of true detections of objects without symmetries
  double correct_fraction = 0.0;    ///< right ones of those of true and false detections; ignored ones are left out
  double good_fraction = 0.0;       ///< the same, correct up to the symmetries of the shape
  PoseRecall recall;                ///< recall of all detections
  PoseRecall recall_strong;         ///< recall of detections from score 0.5 on, which are published by default
};
PoseFigures pose_figures(const std::vector<PoseTrial>& trials);

/// Detections that were given no pose for one reason.
struct WithheldPoses {
  int of_true = 0;
  int of_false = 0;
  int of_ignored = 0;
  int correct = 0;              ///< those of `of_true` whose pose would have been correct
  int correct_up_to_shape = 0;  ///< the same, up to the symmetries of the shape
};

/// Counts the rejected poses by status in words. `unchecked` holds the same detections in the same order with the poses
/// that a verification that accepts everything would have published; throws std::logic_error where it does not.
std::map<std::string, WithheldPoses> count_withheld(const std::vector<PoseTrial>& trials,
                                                    const std::vector<PoseTrial>& unchecked);

/// Converts to JSON; non-finite numbers become null (finite_or_null).
OrderedJson to_json(const PoseFigures& figures);
OrderedJson to_json(const std::map<std::string, WithheldPoses>& withheld);

/// Returns the first line of poses.csv.
std::string pose_table_header();

/// Returns a line for each trial; `variant` names the estimator. Unknown values are left empty.
std::string pose_table_rows(const std::string& variant, const std::vector<PoseTrial>& trials);

}  // namespace houghstream
