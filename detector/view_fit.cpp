#include "detector/view_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace houghstream {
namespace {

constexpr int kSide = Appearance::kSide;

/// Where the cells of a relief are seen, and how much farther than remembered the frame's surface is there.
struct Comparison {
  std::array<float, kSide * kSide>
      excess{};  // on the object, metres; NaN where depth is not measured or not remembered
  std::array<float, kSide * kSide> excess_beside{};  // beside its outline
  std::array<bool, kSide * kSide> on_object{};
  std::array<bool, kSide * kSide> beside{};
  float left = 0.0F;  // of the first cell, frame pixels
  float top = 0.0F;
  float cell_width = 0.0F;
  float cell_height = 0.0F;

  /// Frame pixels from the left upper edge of the first pixel.
  cv::Point2f cell_centre(std::size_t cell) const {
    const auto i = static_cast<float>(cell % kSide);
    const auto j = static_cast<float>(cell / kSide);
    return {left + (i + 0.5F) * cell_width, top + (j + 0.5F) * cell_height};
  }
};

Comparison compare(const TrainedView& view, const Eigen::Vector3f& centre, const RgbdFrame& frame) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  Comparison out;
  const Eigen::Vector2d centre_px = frame.camera.project(centre.cast<double>());
  const auto px_per_metre = static_cast<float>(1.0 / frame.camera.metres_per_px(centre.z()));
  out.cell_width = px_per_metre * (view.box[2] - view.box[0]) / Appearance::kBoxSide;
  out.cell_height = px_per_metre * (view.box[3] - view.box[1]) / Appearance::kBoxSide;
  // pixel centres are whole numbers to the camera, while a box counts from the first pixel's edge
  out.left = static_cast<float>(centre_px.x()) + 0.5F + px_per_metre * view.box[0] - Appearance::kRim * out.cell_width;
  out.top = static_cast<float>(centre_px.y()) + 0.5F + px_per_metre * view.box[1] - Appearance::kRim * out.cell_height;
  for (std::size_t cell = 0; cell < out.excess.size(); ++cell) {
    const cv::Point2f px = out.cell_centre(cell);
    const int x = static_cast<int>(std::floor(px.x));
    const int y = static_cast<int>(std::floor(px.y));
    if (x < 0 || y < 0 || x >= frame.depth.cols || y >= frame.depth.rows) continue;
    const float beyond_centre = frame.depth.at<float>(y, x) - centre.z();
    const std::int16_t remembered = view.appearance.mm[cell];
    const std::int16_t neighbour = view.appearance.beside[cell];
    out.on_object[cell] = remembered != Appearance::kBeside;
    out.beside[cell] = neighbour != Appearance::kBeside;
    out.excess[cell] = remembered > Appearance::kNoDepth ? beyond_centre - 0.001F * remembered : kNone;
    out.excess_beside[cell] = neighbour > Appearance::kNoDepth ? beyond_centre - 0.001F * neighbour : kNone;
  }
  return out;
}

/// Correlation of the remembered colours with the frame's over the visible cells, all three channels together, each
/// about its own mean.
class Likeness {
 public:
  void add(const std::array<std::uint8_t, 3>& remembered, const cv::Vec3b& seen) {
    ++count_;
    for (std::size_t c = 0; c < 3; ++c) {
      const double a = remembered[c];
      const double b = seen[static_cast<int>(c)];
      sums_[c] += Eigen::Matrix<double, 5, 1>(a, b, a * a, b * b, a * b);
    }
  }

  float correlation() const {
    constexpr int kFewest = 12;
    constexpr double kNoise = 9.0;  // variance that a plain surface's pixels have
    if (count_ < kFewest) return 0.0F;
    double covariance = 0.0;
    double remembered = 3.0 * kNoise;
    double seen = 3.0 * kNoise;
    for (const auto& s : sums_) {
      covariance += s(4) / count_ - s(0) / count_ * s(1) / count_;
      remembered += s(2) / count_ - s(0) / count_ * s(0) / count_;
      seen += s(3) / count_ - s(1) / count_ * s(1) / count_;
    }
    return static_cast<float>(covariance / std::sqrt(remembered * seen));
  }

 private:
  int count_ = 0;
  std::array<Eigen::Matrix<double, 5, 1>, 3> sums_ = {
      Eigen::Matrix<double, 5, 1>::Zero(), Eigen::Matrix<double, 5, 1>::Zero(), Eigen::Matrix<double, 5, 1>::Zero()};
};

/// Median of what lies within reach of the expected depth.
float common_shift(const Comparison& comparison) {
  constexpr float kReach = 0.03F;
  std::vector<float> near;
  for (const float e : comparison.excess) {
    if (std::abs(e) < kReach) near.push_back(e);
  }
  if (near.empty()) return 0.0F;
  const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
  std::nth_element(near.begin(), middle, near.end());
  return *middle;
}

/// First and one past the last line in which enough of the object's cells are seen.
std::pair<int, int> seen_range(const std::array<int, kSide>& seen, const std::array<int, kSide>& whole) {
  constexpr int kOneIn = 5;
  int first = kSide;
  int last = 0;
  for (int i = 0; i < kSide; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (seen[at] == 0 || seen[at] * kOneIn < whole[at]) continue;
    first = std::min(first, i);
    last = i + 1;
  }
  return {first, last};
}

}  // namespace

ViewFit fit_view(const TrainedView& view, const Eigen::Vector3f& centre_camera, const LabFrame& frame) {
  const Comparison comparison = compare(view, centre_camera, frame.frame);
  const float shift = common_shift(comparison);
  const float z = centre_camera.z();
  const float tolerance = 0.010F + 0.003F * z * z;  // alignment, and a structured-light camera's noise
  ViewFit fit;
  std::array<int, kSide> rows{};
  std::array<int, kSide> columns{};
  std::array<int, kSide> whole_rows{};
  std::array<int, kSide> whole_columns{};
  Likeness likeness;
  int cells = 0;
  int beside = 0;
  for (std::size_t cell = 0; cell < comparison.excess.size(); ++cell) {
    if (comparison.beside[cell]) {
      ++beside;
      fit.continued += std::abs(comparison.excess_beside[cell] - shift) <= tolerance ? 1.0F : 0.0F;
    }
    if (!comparison.on_object[cell]) continue;
    ++cells;
    const float e = comparison.excess[cell] - shift;
    const bool unknown = std::isnan(e);
    const bool visible = std::abs(e) <= tolerance;
    if (visible) {
      const cv::Point2f px = comparison.cell_centre(cell) * frame.scale;
      const int x = std::min(static_cast<int>(px.x), frame.lab.cols - 1);
      const int y = std::min(static_cast<int>(px.y), frame.lab.rows - 1);
      likeness.add(view.appearance.lab[cell], frame.lab.at<cv::Vec3b>(y, x));
    }
    fit.unknown += unknown ? 1.0F : 0.0F;
    fit.visible += visible ? 1.0F : 0.0F;
    fit.hidden += e < -tolerance ? 1.0F : 0.0F;
    fit.seen_through += e > tolerance ? 1.0F : 0.0F;
    ++whole_rows[cell / kSide];
    ++whole_columns[cell % kSide];
    rows[cell / kSide] += unknown || visible ? 1 : 0;
    columns[cell % kSide] += unknown || visible ? 1 : 0;
  }
  fit.continued /= static_cast<float>(std::max(beside, 1));
  fit.likeness = likeness.correlation();
  if (cells == 0) return fit;
  for (float* share : {&fit.visible, &fit.hidden, &fit.seen_through, &fit.unknown}) *share /= static_cast<float>(cells);
  const auto [left, right] = seen_range(columns, whole_columns);
  const auto [top, bottom] = seen_range(rows, whole_rows);
  if (left < right && top < bottom) {
    fit.visible_box_px = {comparison.left + static_cast<float>(left) * comparison.cell_width,
                          comparison.top + static_cast<float>(top) * comparison.cell_height,
                          static_cast<float>(right - left) * comparison.cell_width,
                          static_cast<float>(bottom - top) * comparison.cell_height};
  }
  return fit;
}

namespace {

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
                               double centre_depth) {
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
      const double offset_mm = 1000.0 * (view.depth.at<float>(y, x) - centre_depth);
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
