#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "drivers/files/json_file.hpp"
#include "tools/evaluate/evaluation.hpp"
#include "tools/evaluate/latency.hpp"

namespace houghstream {

/// The summary: auc, pose_recall_add_s_10 and pose_recall_add_or_add_s_10 by object and as means, bop19 (average
/// recalls) where it was measured, counts, latency percentiles, and the rules by which it was measured. What could not
/// be measured is null.
OrderedJson summary_json(const Evaluation& evaluation, const EvaluationRules& rules,
                         const std::optional<Latencies>& latencies);

/// A table for people.
std::string summary_table(const Evaluation& evaluation, const EvaluationRules& rules);

/// Writes FOLDER/summary.json, curves.csv (object,score,precision,recall) and poses.csv
/// (frame,object,add,add_s,visible,status; metres, empty without a pose). Throws InputError.
void write_report(const Evaluation& evaluation, const OrderedJson& summary, const std::filesystem::path& folder);

}  // namespace houghstream
