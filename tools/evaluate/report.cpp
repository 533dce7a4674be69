#include "tools/evaluate/report.hpp"

#include <cmath>

#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/bus/percentiles.hpp"
#include "tools/common/rounded.hpp"
#include "tools/evaluate/reliability_image.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

OrderedJson number(double value) {
  return finite_or_null(rounded(value, 4));
}

OrderedJson ratio(int part, int whole) {
  return whole > 0 ? number(static_cast<double>(part) / whole) : OrderedJson(nullptr);
}

OrderedJson to_json(const std::vector<double>& values_ms) {
  const Percentiles p = percentiles(values_ms);
  return {{"p50", number(p.p50)}, {"p95", number(p.p95)}, {"p99", number(p.p99)}};
}

OrderedJson number_or_null(const std::optional<float>& value) {
  return value ? number(static_cast<double>(*value)) : OrderedJson(nullptr);
}

OrderedJson rules_json(const EvaluationRules& rules) {
  OrderedJson json = {{"min_iou", rules.detection.min_iou},
                      {"min_visible", rules.detection.min_visible},
                      {"max_per_class", rules.detection.max_per_class},
                      {"operating_score", number(static_cast<double>(rules.operating_score))},
                      {"pose_min_visible", rules.pose_min_visible},
                      {"ranked_from", number_or_null(rules.ranked_from)},
                      {"min_quality", number_or_null(rules.min_quality)},
                      {"skipped_frames", rules.processed_only ? "left out" : "missed"}};
  if (!rules.precision) return json;
  json["precision"] = number(*rules.precision);
  for (const auto& [name, score] : rules.class_operating_scores)
    json["operating_scores"][name] = number(static_cast<double>(score));
  return json;
}

void add_detection_figures(const Evaluation& evaluation, OrderedJson& json) {
  for (const ClassResult& result : evaluation.classes) {
    const OperatingPoint& point = evaluation.operating.at(result.class_name);
    json["auc"][result.class_name] = number(result.auc);
    json["required"][result.class_name] = result.required;
    json["precision"][result.class_name] = ratio(point.correct.all(), point.correct.all() + point.incorrect.all());
    json["recall"][result.class_name] = ratio(point.correct.all(), result.required);
  }
  json["auc"]["mean"] = number(mean_auc(evaluation.classes));
  json["auc"]["weighted"] = number(weighted_auc(evaluation.classes));
}

OrderedJson operating_json(const Evaluation& evaluation) {
  OperatingPoint all;
  int required = 0;
  const auto add = [](const ReportedCount& some, ReportedCount& sum) {
    sum.detections += some.detections;
    sum.confirmed += some.confirmed;
  };
  for (const ClassResult& result : evaluation.classes) {
    add(evaluation.operating.at(result.class_name).correct, all.correct);
    add(evaluation.operating.at(result.class_name).incorrect, all.incorrect);
    required += result.required;
  }
  return {{"precision", ratio(all.correct.all(), all.correct.all() + all.incorrect.all())},
          {"recall", ratio(all.correct.all(), required)},
          {"true", all.correct.all()},
          {"false", all.incorrect.all()},
          {"confirmed", {{"true", all.correct.confirmed}, {"false", all.incorrect.confirmed}}},
          {"required", required}};
}

OrderedJson calibration_json(const Calibration& calibration) {
  OrderedJson json = {{"ece", number(calibration.ece)},
                      {"count", calibration.count},
                      {"bins", OrderedJson::array()},
                      {"proposed", OrderedJson::array()}};
  for (const ReliabilityBin& bin : calibration.bins) {
    json["bins"].push_back({{"from", bin.from},
                            {"to", bin.to},
                            {"count", bin.count},
                            {"mean_score", number(bin.mean_score)},
                            {"true_fraction", number(bin.true_fraction)}});
  }
  for (const ProposedThreshold& proposed : calibration.proposed) {
    // The score is written in full: a rounded one would leave out the very detection that it comes from, or let in
    // others.
    json["proposed"].push_back({{"precision", proposed.precision},
                                {"score", proposed.score ? OrderedJson(*proposed.score) : OrderedJson(nullptr)},
                                {"recall", number(proposed.recall)}});
  }
  return json;
}

OrderedJson recall_json(const std::map<std::string, double>& recalls) {
  OrderedJson json = OrderedJson::object();
  for (const auto& [name, recall] : recalls) json[name] = number(recall);
  json["mean"] = number(mean_of(recalls));
  return json;
}

OrderedJson followed_json(const FollowedPoses& followed) {
  OrderedJson json = {{"frames", followed.frames}, {"frames_missed", followed.frames_missed}};
  const auto add = [&](const std::string& name, const FollowedCount& count) {
    json["required"][name] = count.required;
    json["published"][name] = count.published;
    json["right_fraction"][name] = ratio(count.correct, count.published);
    json["right_up_to_shape_fraction"][name] = ratio(count.correct_up_to_shape, count.published);
    json["recall"][name] = ratio(count.correct, count.required);
    json["recall_up_to_shape"][name] = ratio(count.correct_up_to_shape, count.required);
  };
  for (const auto& [name, count] : followed.by_class) add(name, count);
  add("all", followed.all());
  return json;
}

OrderedJson localisation_json(const LocalisationScores& scores) {
  OrderedJson json;
  json["variant"] =
      "6D localisation as in the BOP challenge since 2019 (Hodan et al. 2020): targets visible by 10 % or more, what "
      "is "
      "missed counts as wrong; VSD with delta 15 mm, tau 0.05 to 0.5 diameters, errors below 0.05 to 0.5; MSSD below "
      "0.05 to 0.5 diameters; MSPD below 5 to 50 px of an image 640 wide; ar is the mean of the three";
  const auto add = [&](const std::string& name, const AverageRecall& recall) {
    json["targets"][name] = recall.targets;
    json["ar"][name] = number(recall.mean);
    json["ar_vsd"][name] = number(recall.vsd);
    json["ar_mssd"][name] = number(recall.mssd);
    json["ar_mspd"][name] = number(recall.mspd);
  };
  for (const auto& [name, recall] : scores.by_class) add(name, recall);
  add("all", scores.all);
  return json;
}

void write_text(const fs::path& file, const std::string& text) {
  write_file_atomically(file, text);
}

std::string curves_csv(const Evaluation& evaluation) {
  std::string text = "object,score,precision,recall\n";
  for (const ClassResult& result : evaluation.classes) {
    for (const CurvePoint& point : result.curve) {
      text += fmt::format("{},{},{:.6f},{:.6f}\n", result.class_name, point.score, point.precision, point.recall);
    }
  }
  return text;
}

std::string poses_csv(const Evaluation& evaluation) {
  const auto metres = [](double value) { return std::isfinite(value) ? fmt::format("{:.6f}", value) : std::string(); };
  std::string text = "frame,object,add,add_s,visible,status,score,quality,scene,image,strict\n";
  for (const JudgedPose& pose : evaluation.poses) {
    text += fmt::format("{},{},{},{},{:.3f},{},{:.4f},{:.4f},{},{},{}\n", pose.frame, pose.class_name, metres(pose.add),
                        metres(pose.add_s), pose.visible_fraction, to_string(pose.status), pose.score, pose.quality,
                        pose.scene, pose.image_id, metres(pose.strict));
  }
  return text;
}

}  // namespace

OrderedJson summary_json(const Evaluation& evaluation, const EvaluationRules& rules,
                         const std::optional<Latencies>& latencies) {
  const int counted = rules.processed_only ? evaluation.frames_processed : evaluation.frames;
  OrderedJson json;
  json["frames"] = evaluation.frames;
  json["frames_processed"] = evaluation.frames_processed;
  json["frames_with_poses"] = evaluation.frames_with_poses;
  add_detection_figures(evaluation, json);
  json["operating"] = operating_json(evaluation);
  json["detection_calibration"] = calibration_json(evaluation.detection_calibration);
  json["false_detections"] = evaluation.false_detections;
  // Only a processed frame can have a false detection.
  json["false_per_frame"] = ratio(evaluation.false_detections, evaluation.frames_processed);
  json["frames_counted"] = counted;
  json["mssd_recall"] = recall_json(evaluation.strict_recall);
  json["pose_recall_add_s_10"] = recall_json(evaluation.add_s_recall);
  json["pose_recall_add_or_add_s_10"] = recall_json(evaluation.add_or_add_s_recall);
  json["pose_calibration"] = calibration_json(evaluation.pose_calibration);
  json["pose_calibration_up_to_shape"] = calibration_json(evaluation.pose_calibration_up_to_shape);
  const std::optional<PublishedPoses>& published = evaluation.published;
  json["published"] = published ? OrderedJson(published->count) : OrderedJson(nullptr);
  json["published_right_fraction"] = published ? ratio(published->correct, published->count) : OrderedJson(nullptr);
  json["published_good_fraction"] =
      published ? ratio(published->correct_up_to_shape, published->count) : OrderedJson(nullptr);
  if (evaluation.followed) json["followed"] = followed_json(*evaluation.followed);
  if (evaluation.localisation) json["bop19"] = localisation_json(*evaluation.localisation);
  if (evaluation.localisation_nothing_withheld)
    json["bop19_nothing_withheld"] = localisation_json(*evaluation.localisation_nothing_withheld);
  if (latencies) {
    json["latency_ms"] = {{"detect", to_json(latencies->detect_ms)},
                          {"pose", to_json(latencies->pose_ms)},
                          {"total", to_json(latencies->total_ms)}};
  }
  json["stage_ms_median"] = OrderedJson::object();
  for (const auto& [stage, median] : evaluation.stage_ms) json["stage_ms_median"][stage] = number(median);
  json["rules"] = rules_json(rules);
  return json;
}

OrderedJson summary_json(const Evaluation& evaluation, const std::vector<SceneEvaluation>& scenes,
                         const EvaluationRules& rules, const std::optional<Latencies>& latencies) {
  OrderedJson json = summary_json(evaluation, rules, latencies);
  json["scenes"] = OrderedJson::object();
  for (const SceneEvaluation& scene : scenes) {
    OrderedJson figures = summary_json(scene.evaluation, rules, std::nullopt);
    figures.erase("rules");
    json["scenes"][scene.name] = std::move(figures);
  }
  return json;
}

std::string summary_table(const Evaluation& evaluation, const EvaluationRules& rules) {
  std::string text = fmt::format("{} frames, {} processed, {} with poses; skipped frames {}\n", evaluation.frames,
                                 evaluation.frames_processed, evaluation.frames_with_poses,
                                 rules.processed_only ? "left out" : "count as missed");
  const auto show = [](const std::map<std::string, double>& recalls, const std::string& name) {
    const auto recall = recalls.find(name);
    return recall != recalls.end() ? fmt::format("{:.3f}", recall->second) : std::string("-");
  };
  text += fmt::format("{:<20}{:>8}{:>8}{:>8}{:>8}{:>12}{:>12}\n", "object", "there", "AUC", "true", "false", "right",
                      "ADD-S<10%");
  for (const ClassResult& result : evaluation.classes) {
    const OperatingPoint& point = evaluation.operating.at(result.class_name);
    text += fmt::format("{:<20}{:>8}{:>8.3f}{:>8}{:>8}{:>12}{:>12}\n", result.class_name, result.required, result.auc,
                        point.correct.all(), point.incorrect.all(), show(evaluation.strict_recall, result.class_name),
                        show(evaluation.add_s_recall, result.class_name));
  }
  text += fmt::format("{:<28}{:>8.3f}{:>28.3f}{:>12.3f}\n", "mean", mean_auc(evaluation.classes),
                      mean_of(evaluation.strict_recall), mean_of(evaluation.add_s_recall));
  text += fmt::format("{:<28}{:>8.3f}\n", "weighted by objects", weighted_auc(evaluation.classes));
  if (rules.ranked_from)
    text += fmt::format("AUC of detections from score {} on, what scores less is missed (--threshold)\n",
                        *rules.ranked_from);
  if (evaluation.localisation) {
    const AverageRecall& all = evaluation.localisation->all;
    text += fmt::format("{:<28}{:>8.3f} of {} targets (VSD {:.3f}, MSSD {:.3f}, MSPD {:.3f})\n", "AR (BOP 2019)",
                        all.mean, all.targets, all.vsd, all.mssd, all.mspd);
  }
  if (evaluation.localisation_nothing_withheld) {
    const AverageRecall& all = evaluation.localisation_nothing_withheld->all;
    text += fmt::format("{:<28}{:>8.3f}\n", "AR, nothing withheld", all.mean);
  }
  text += fmt::format("{:<28}{:>8.3f} score, {:.3f} quality, {:.3f} up to shape\n", "calibration error",
                      evaluation.detection_calibration.ece, evaluation.pose_calibration.ece,
                      evaluation.pose_calibration_up_to_shape.ece);
  if (evaluation.frames_with_poses > 0) {
    text += evaluation.published
                ? fmt::format("poses published {}, right {}, right up to what the shape cannot tell {}\n",
                              evaluation.published->count, evaluation.published->correct,
                              evaluation.published->correct_up_to_shape)
                : "poses not judged: no models of these objects (--models)\n";
  }
  if (evaluation.followed) {
    const FollowedCount all = evaluation.followed->all();
    text += fmt::format("followed in {} frames, {} missed: {} poses, {} right, {} right up to shape, of {} objects\n",
                        evaluation.followed->frames, evaluation.followed->frames_missed, all.published, all.correct,
                        all.correct_up_to_shape, all.required);
  }
  const std::string from = rules.precision ? fmt::format("the scores for precision {}", *rules.precision)
                                           : fmt::format("score {}", rules.operating_score);
  text += fmt::format("false detections {} from {} on, or confirmed by a pose\n", evaluation.false_detections, from);
  for (const auto& [stage, median] : evaluation.stage_ms) text += fmt::format("{:<28}{:>8.2f} ms\n", stage, median);
  return text;
}

void write_report(const Evaluation& evaluation, const OrderedJson& summary, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  require(!error, "{}: cannot make this folder: {}", folder.string(), error.message());
  write_json(summary, folder / "summary.json");
  write_text(folder / "curves.csv", curves_csv(evaluation));
  write_text(folder / "poses.csv", poses_csv(evaluation));
  if (evaluation.detection_calibration.count == 0) return;
  write_png(reliability_image(evaluation.detection_calibration, evaluation.pose_calibration),
            folder / "reliability.png");
}

}  // namespace houghstream
