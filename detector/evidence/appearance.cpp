#include "detector/evidence/appearance.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "detector/evidence/relief_tilt.hpp"

namespace houghstream {
namespace {

constexpr int kSide = Appearance::kSide;

/// The cells beside the outline, each with the depth of the nearest cell of the object. Not below the object's upper
/// part: what it stands on may touch it there.
void mark_rim(Appearance& appearance) {
  constexpr int kUpper = Appearance::kRim + (Appearance::kBoxSide * 3) / 5;
  appearance.beside.fill(Appearance::kBeside);
  for (int j = 0; j < kUpper; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const auto cell = static_cast<std::size_t>(j * kSide + i);
      if (appearance.mm[cell] != Appearance::kBeside) continue;
      int nearest_sq = 2 * Appearance::kRim * Appearance::kRim + 1;
      for (int y = std::max(0, j - Appearance::kRim); y <= std::min(kUpper - 1, j + Appearance::kRim); ++y) {
        for (int x = std::max(0, i - Appearance::kRim); x <= std::min(kSide - 1, i + Appearance::kRim); ++x) {
          const std::int16_t other = appearance.mm[static_cast<std::size_t>(y * kSide + x)];
          const int distance_sq = (x - i) * (x - i) + (y - j) * (y - j);
          if (other <= Appearance::kNoDepth || distance_sq >= nearest_sq) continue;
          nearest_sq = distance_sq;
          appearance.beside[cell] = other;
        }
      }
    }
  }
}

}  // namespace

Appearance remember_appearance(const RgbdFrame& view, const cv::Mat& mask, const cv::Rect& box_px,
                               const Eigen::Vector3f& centre_camera) {
  const ReliefTilt tilt = relief_tilt(centre_camera);
  const Eigen::Vector2d centre_px = view.camera.project(centre_camera.cast<double>());
  const double metres_per_px = view.camera.metres_per_px(centre_camera.z());
  Appearance appearance;
  appearance.mm.fill(Appearance::kBeside);
  cv::Mat lab;
  cv::resize(view.colour(box_px), lab, cv::Size(Appearance::kBoxSide, Appearance::kBoxSide), 0, 0, cv::INTER_AREA);
  cv::cvtColor(lab, lab, cv::COLOR_BGR2Lab);
  for (int j = 0; j < Appearance::kBoxSide; ++j) {
    for (int i = 0; i < Appearance::kBoxSide; ++i) {
      const int x = box_px.x + static_cast<int>((i + 0.5) * box_px.width / Appearance::kBoxSide);
      const int y = box_px.y + static_cast<int>((j + 0.5) * box_px.height / Appearance::kBoxSide);
      if (mask.at<std::uint8_t>(y, x) == 0) continue;
      const double gained = metres_per_px * (tilt.right * (x - centre_px.x()) + tilt.down * (y - centre_px.y()));
      const double offset_mm = 1000.0 * (view.depth.at<float>(y, x) - centre_camera.z() - gained);
      const auto cell = static_cast<std::size_t>((j + Appearance::kRim) * kSide + i + Appearance::kRim);
      const auto& colour = lab.at<cv::Vec3b>(j, i);
      appearance.lab[cell] = {colour[0], colour[1], colour[2]};
      appearance.mm[cell] =
          std::abs(offset_mm) < 30000.0 ? static_cast<std::int16_t>(std::lround(offset_mm)) : Appearance::kNoDepth;
    }
  }
  mark_rim(appearance);
  return appearance;
}

}  // namespace houghstream
