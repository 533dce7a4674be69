#include "tools/studies/pose/pose_figures.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "pipeline/bus/percentiles.hpp"

namespace houghstream {
namespace {

constexpr double kMinVisible = 0.6;
constexpr float kStrong = 0.5F;

double ratio(int part, int whole) {
  return whole > 0 ? static_cast<double>(part) / whole : std::numeric_limits<double>::quiet_NaN();
}

std::string known(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : std::string();
}

const char* to_word(MatchOutcome outcome) {
  switch (outcome) {
    case MatchOutcome::kTruePositive: return "true";
    case MatchOutcome::kFalsePositive: return "false";
    case MatchOutcome::kIgnored: return "ignored";
  }
  return "invalid";
}

}  // namespace

PoseRecall pose_recall(const std::vector<PoseTrial>& trials, float min_score) {
  PoseRecall out;
  int correct = 0;
  int by_add_s = 0;
  int by_add = 0;
  for (const PoseTrial& trial : trials) {
    if (trial.outcome != MatchOutcome::kTruePositive || trial.score < min_score || trial.visible_fraction < kMinVisible)
      continue;
    ++out.detections;
    correct += trial.is_correct() ? 1 : 0;
    by_add_s += trial.is_correct_up_to_shape() ? 1 : 0;
    by_add += (trial.symmetric ? trial.add_s : trial.add) < kCorrectBelow ? 1 : 0;  // false for NaN
  }
  out.correct = ratio(correct, out.detections);
  out.add_s = ratio(by_add_s, out.detections);
  out.add = ratio(by_add, out.detections);
  return out;
}

PoseFigures pose_figures(const std::vector<PoseTrial>& trials) {
  std::vector<double> ms, mm, mm_per_m_sq, deg;
  int judged = 0;
  int correct = 0;
  int correct_up_to_shape = 0;
  for (const PoseTrial& trial : trials) {
    if (!trial.T_camera_object) continue;
    ms.push_back(trial.ms);
    judged += trial.outcome == MatchOutcome::kIgnored ? 0 : 1;
    if (trial.outcome != MatchOutcome::kTruePositive) continue;
    correct += trial.is_correct() ? 1 : 0;
    correct_up_to_shape += trial.is_correct_up_to_shape() ? 1 : 0;
    mm.push_back(1e3 * trial.shift_m);
    mm_per_m_sq.push_back(1e3 * trial.shift_m / (trial.distance_m * trial.distance_m));
    if (!trial.symmetric) deg.push_back(trial.angle_deg);
  }
  PoseFigures out;
  out.detections = static_cast<int>(trials.size());
  out.published = static_cast<int>(ms.size());
  const Percentiles times = percentiles(ms);
  out.ms_median = times.p50;
  out.ms_p99 = times.p99;
  out.mm_median = percentiles(mm).p50;
  out.mm_per_m_sq_median = percentiles(mm_per_m_sq).p50;
  out.deg_median = percentiles(deg).p50;
  out.correct_fraction = ratio(correct, judged);
  out.good_fraction = ratio(correct_up_to_shape, judged);
  out.recall = pose_recall(trials, 0.0F);
  out.recall_strong = pose_recall(trials, kStrong);
  return out;
}

std::map<std::string, WithheldPoses> count_withheld(const std::vector<PoseTrial>& trials,
                                                    const std::vector<PoseTrial>& unchecked) {
  if (trials.size() != unchecked.size()) throw std::logic_error("withheld poses: other detections than published");
  std::map<std::string, WithheldPoses> out;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (trials[i].T_camera_object) continue;
    WithheldPoses& counts = out[to_string(trials[i].status)];
    switch (trials[i].outcome) {
      case MatchOutcome::kTruePositive: ++counts.of_true; break;
      case MatchOutcome::kFalsePositive: ++counts.of_false; break;
      case MatchOutcome::kIgnored: ++counts.of_ignored; break;
    }
    counts.correct += unchecked[i].is_correct() ? 1 : 0;
    counts.correct_up_to_shape += unchecked[i].is_correct_up_to_shape() ? 1 : 0;
  }
  return out;
}

OrderedJson to_json(const PoseFigures& figures) {
  const auto recall = [](const PoseRecall& of) {
    return OrderedJson{{"detections", of.detections},
                       {"mssd", finite_or_null(of.correct)},
                       {"add_s", finite_or_null(of.add_s)},
                       {"add", finite_or_null(of.add)}};
  };
  return {{"detections", figures.detections},
          {"published", figures.published},
          {"ms_median", finite_or_null(figures.ms_median)},
          {"ms_p99", finite_or_null(figures.ms_p99)},
          {"mm_median", finite_or_null(figures.mm_median)},
          {"mm_per_m_sq_median", finite_or_null(figures.mm_per_m_sq_median)},
          {"deg_median", finite_or_null(figures.deg_median)},
          {"published_right_fraction", finite_or_null(figures.correct_fraction)},
          {"published_good_fraction", finite_or_null(figures.good_fraction)},
          {"recall", recall(figures.recall)},
          {"recall_from_0.5", recall(figures.recall_strong)}};
}

OrderedJson to_json(const std::map<std::string, WithheldPoses>& withheld) {
  OrderedJson out = OrderedJson::object();
  for (const auto& [reason, counts] : withheld) {
    out[reason] = {{"true", counts.of_true},
                   {"false", counts.of_false},
                   {"ignored", counts.of_ignored},
                   {"would_have_been_right", counts.correct_up_to_shape},
                   {"would_have_been_right_by_mssd", counts.correct}};
  }
  return out;
}

std::string pose_table_header() {
  return "variant,scene,frame,object,visible,verdict,score,status,quality,add,add_s,mm,deg,ms,strict\n";
}

std::string pose_table_rows(const std::string& variant, const std::vector<PoseTrial>& trials) {
  std::string text;
  for (const PoseTrial& trial : trials) {
    text += fmt::format("{},{},{},{},{},{},{:.4f},{},{:.4f},{},{},{},{},{},{}\n", variant, trial.scene, trial.image,
                        trial.class_name, known(trial.visible_fraction, 3), to_word(trial.outcome), trial.score,
                        to_string(trial.status), trial.quality, known(trial.add, 4), known(trial.add_s, 4),
                        known(1e3 * trial.shift_m, 2), known(trial.angle_deg, 2), known(trial.ms, 3),
                        known(trial.strict, 4));
  }
  return text;
}

}  // namespace houghstream
