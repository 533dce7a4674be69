#include "tools/studies/pose/bench_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <opencv2/imgproc.hpp>
#include <tuple>

#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tools/studies/failures/failures.hpp"
#include "tools/studies/pose/pose_figures.hpp"
#include "tools/studies/recorded/pose_sheets.hpp"

namespace houghstream {
namespace {

/// Returns a key by which worse trials compare less.
std::tuple<bool, bool, double> order_of(const PoseTrial& trial) {
  const bool is_known = std::isfinite(trial.strict);
  return {trial.outcome == MatchOutcome::kTruePositive, is_known, is_known ? -trial.strict : 0.0};
}

std::string error_words(const PoseTrial& trial) {
  if (!std::isfinite(trial.add_s)) return "false: none of its kind is there";
  if (trial.outcome != MatchOutcome::kTruePositive)
    return fmt::format("false; the nearest: ADD-S {:.3f} diameters", trial.add_s);
  return fmt::format("{} {:.3f}, ADD-S {:.3f} diameters, {:.0f} mm, {:.0f} deg", trial.symmetric ? "MSSD" : "ADD",
                     trial.strict, trial.add_s, 1e3 * trial.shift_m, trial.angle_deg);
}

namespace fs = std::filesystem;

OrderedJson to_json(const VariantResult& result) {
  OrderedJson out = to_json(pose_figures(result.trials));
  const AverageRecall recall = average_recall(result.errors);
  out["bop_targets"] = recall.targets;
  out["bop_ar"] = finite_or_null(recall.mean);
  return out;
}

OrderedJson to_json(const std::map<std::string, VariantResult>& results) {
  OrderedJson out = OrderedJson::object();
  for (const auto& [name, result] : results) out[name] = to_json(result);
  return out;
}

fs::path worst_file(const fs::path& folder, std::size_t number) {
  return folder / fmt::format("worst_{}.png", number);
}

}  // namespace

std::vector<PoseTrial> worst_poses(const std::vector<PoseTrial>& trials, std::size_t count) {
  std::vector<PoseTrial> out;
  std::copy_if(trials.begin(), trials.end(), std::back_inserter(out),
               [](const PoseTrial& trial) { return trial.T_camera_object && trial.outcome != MatchOutcome::kIgnored; });
  std::stable_sort(out.begin(), out.end(),
                   [](const PoseTrial& a, const PoseTrial& b) { return order_of(a) < order_of(b); });
  out.resize(std::min(out.size(), count));
  return out;
}

cv::Mat draw_trial(const PoseTrial& trial, const RgbdFrame& frame, const Mesh& mesh) {
  constexpr int kWidth = 360;
  constexpr int kHeight = 270;
  constexpr int kLine = 17;
  cv::Mat image = frame.colour.clone();
  draw_outline(image, mesh, *trial.T_camera_object, frame.camera, view::class_colour(trial.class_id));
  cv::Mat tile(kHeight + 2 * kLine + 4, kWidth, CV_8UC3, cv::Scalar::all(0));
  cv::Mat surroundings_image = tile.rowRange(0, kHeight);
  cv::resize(image(surroundings(trial.box_px, image.size())), surroundings_image, surroundings_image.size(), 0, 0,
             cv::INTER_LINEAR);
  const std::string what =
      fmt::format("{} {:.2f}, {}, frame {}", trial.class_name, trial.score, trial.scene, trial.image);
  view::draw_text(tile, what, {4, kHeight + kLine - 2}, 0.4);
  view::draw_text(tile, error_words(trial), {4, kHeight + 2 * kLine - 2}, 0.4);
  return tile;
}

void write_bench(const PoseBench& bench, const fs::path& folder) {
  fs::create_directories(folder);
  OrderedJson json = {{"frames", bench.frames}, {"rival_frames", bench.baseline_frames}};
  json["variants"] = to_json(bench.each_frame);
  json["on_rival_frames"] = to_json(bench.on_baseline_frames);
  json["withheld"] = to_json(count_withheld(bench.each_frame.at(kOurs).trials, bench.each_frame.at(kUnchecked).trials));
  write_json(json, folder / "results.json");
  const fs::path file = folder / "poses.csv";
  std::ofstream table(file);
  table << pose_table_header();
  for (const auto& [name, result] : bench.each_frame) table << pose_table_rows(name, result.trials);
  for (const auto& [name, result] : bench.on_baseline_frames) {
    if (bench.each_frame.count(name) == 0) table << pose_table_rows(name, result.trials);
  }
  table.close();
  require(table.good(), "{}: cannot be written", file.string());
}

void write_worst(const std::vector<PoseTrial>& trials, const std::map<std::string, BopScene>& scenes,
                 const std::map<std::string, Mesh>& meshes, const fs::path& folder) {
  constexpr std::size_t kCount = 10;
  for (std::size_t number = 1; number <= kCount; ++number) fs::remove(worst_file(folder, number));
  std::size_t number = 0;
  for (const PoseTrial& trial : worst_poses(trials, kCount)) {
    const RgbdFrame frame = scenes.at(trial.scene).read_frame(trial.image);
    write_png(draw_trial(trial, frame, meshes.at(trial.class_name)), worst_file(folder, ++number));
  }
}

std::string bench_summary(const PoseBench& bench) {
  std::string text = fmt::format("{} frames, rivals {}\n{:<24}{:>8}{:>9}{:>9}{:>7}{:>7}{:>7}{:>10}{:>7}{:>7}{:>7}\n",
                                 bench.frames, bench.baseline_frames, "", "poses", "ms", "p99", "right", "ADD-S", "ADD",
                                 "published:", "ADD-S", "mm", "AR");
  const auto add = [&](const std::string& name, const VariantResult& result) {
    const PoseFigures figures = pose_figures(result.trials);
    text += fmt::format("{:<24}{:>8}{:>9.2f}{:>9.2f}{:>7.3f}{:>7.3f}{:>7.3f}{:>10.3f}{:>7.3f}{:>7.2f}{:>7.3f}\n", name,
                        figures.published, figures.ms_median, figures.ms_p99, figures.recall.correct,
                        figures.recall.add_s, figures.recall.add, figures.correct_fraction, figures.good_fraction,
                        figures.mm_median, average_recall(result.errors).mean);
  };
  for (const auto& [name, result] : bench.each_frame) add(name, result);
  for (const auto& [name, result] : bench.on_baseline_frames) add("rivals' frames: " + name, result);
  return text;
}

}  // namespace houghstream
