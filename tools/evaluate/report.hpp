#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "drivers/files/json_file.hpp"
#include "tools/evaluate/evaluation.hpp"
#include "tools/evaluate/metrics/latency.hpp"

namespace houghstream {

/// A scene among several with its figures.
struct SceneEvaluation {
  std::string name;
  Evaluation evaluation;
};

/// Returns the summary: auc; mssd_recall (poses that are correct), pose_recall_add_s_10 (correct up to what the shape
/// cannot tell) and pose_recall_add_or_add_s_10 by object and as means; bop19 and bop19_nothing_withheld (average
/// recalls) where they were measured; operating (precision and recall of all classes together); detection_calibration,
/// pose_calibration and pose_calibration_up_to_shape (ece, bins, proposed thresholds, as Calibration names them);
/// published (poses), published_right_fraction and published_good_fraction (by ADD-S); counts, latency percentiles, and
/// the rules by which it was measured. What could not be measured is null.
OrderedJson summary_json(const Evaluation& evaluation, const EvaluationRules& rules,
                         const std::optional<Latencies>& latencies);

/// Returns the summary of several scenes together, with the figures of each by its name under "scenes".
OrderedJson summary_json(const Evaluation& evaluation, const std::vector<SceneEvaluation>& scenes,
                         const EvaluationRules& rules, const std::optional<Latencies>& latencies);

/// Returns a table for people.
std::string summary_table(const Evaluation& evaluation, const EvaluationRules& rules);

/// Writes FOLDER/summary.json, curves.csv (object,score,precision,recall), poses.csv
/// (frame,object,add,add_s,visible,status,score,quality,scene,image,strict; frame is the position among the evaluated
/// ones; metres, empty without a published pose) and, where anything was judged, reliability.png. Throws InputError.
void write_report(const Evaluation& evaluation, const OrderedJson& summary, const std::filesystem::path& folder);

}  // namespace houghstream
