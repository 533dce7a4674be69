#include "tools/studies/pose/worst_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <tuple>

#include "tools/studies/failures/failures.hpp"
#include "tools/studies/recorded/pose_sheets.hpp"

namespace houghstream {
namespace {

/// Worse ones compare less.
std::tuple<bool, bool, double> order_of(const PoseTrial& trial) {
  const bool is_known = std::isfinite(trial.strict);
  return {trial.verdict == Verdict::kTrue, is_known, is_known ? -trial.strict : 0.0};
}

std::string error_words(const PoseTrial& trial) {
  if (!std::isfinite(trial.add_s)) return "false: none of its kind is there";
  if (trial.verdict != Verdict::kTrue) return fmt::format("false; the nearest: ADD-S {:.3f} diameters", trial.add_s);
  return fmt::format("{} {:.3f}, ADD-S {:.3f} diameters, {:.0f} mm, {:.0f} deg", trial.symmetric ? "MSSD" : "ADD",
                     trial.strict, trial.add_s, 1e3 * trial.shift_m, trial.turn_deg);
}

}  // namespace

std::vector<PoseTrial> worst_poses(const std::vector<PoseTrial>& trials, std::size_t count) {
  std::vector<PoseTrial> out;
  std::copy_if(trials.begin(), trials.end(), std::back_inserter(out),
               [](const PoseTrial& trial) { return trial.T_camera_object && trial.verdict != Verdict::kIgnored; });
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
  cv::Mat picture = tile.rowRange(0, kHeight);
  cv::resize(image(surroundings(trial.box_px, image.size())), picture, picture.size(), 0, 0, cv::INTER_LINEAR);
  const std::string what =
      fmt::format("{} {:.2f}, {}, frame {}", trial.class_name, trial.score, trial.scene, trial.image);
  view::draw_text(tile, what, {4, kHeight + kLine - 2}, 0.4);
  view::draw_text(tile, error_words(trial), {4, kHeight + 2 * kLine - 2}, 0.4);
  return tile;
}

}  // namespace houghstream
