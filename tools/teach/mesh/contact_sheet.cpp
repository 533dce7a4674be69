#include "tools/teach/mesh/contact_sheet.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream::teach {
namespace {

constexpr int kColumns = 12;
constexpr int kShown = 24;
constexpr int kTile_px = 100;
constexpr int kTitle_px = 26;
const cv::Scalar kGround(40, 40, 40);

/// Returns the view as a square, without distortion; the background is darker.
cv::Mat tile_of(const TrainingView& view) {
  cv::Mat shown = view.frame.colour * 0.6;
  view.frame.colour.copyTo(shown, view.mask);
  cv::Rect box = cv::boundingRect(view.mask);
  const int side = std::max({box.width, box.height, 8}) * 5 / 4;
  box = cv::Rect(box.x + box.width / 2 - side / 2, box.y + box.height / 2 - side / 2, side, side);
  cv::Mat square = cv::Mat::zeros(side, side, CV_8UC3);
  const cv::Rect inside = box & cv::Rect({0, 0}, shown.size());
  shown(inside).copyTo(square(inside - box.tl()));
  cv::Mat tile;
  cv::resize(square, tile, {kTile_px - 2, kTile_px - 2}, 0, 0, cv::INTER_AREA);
  return tile;
}

/// Returns "3 half turns", "2 turns by 90 degrees", largest angle first.
std::vector<std::string> rotation_words(const std::vector<Eigen::Isometry3d>& rotations) {
  constexpr std::array<int, 6> kWhole_deg = {60, 72, 90, 120, 144, 180};  // a scan's products are a degree off
  std::map<int, int, std::greater<>> count_by_deg;
  for (const Eigen::Isometry3d& rotation : rotations) {
    const double angle_deg = Eigen::AngleAxisd(rotation.linear()).angle() * 180.0 / M_PI;
    ++count_by_deg[*std::min_element(kWhole_deg.begin(), kWhole_deg.end(),
                                     [&](int a, int b) { return std::abs(a - angle_deg) < std::abs(b - angle_deg); })];
  }
  std::vector<std::string> words;
  for (const auto& [angle_deg, count] : count_by_deg) {
    const std::string number = count == 1 ? "a" : fmt::format("{}", count);
    const std::string ending = count == 1 ? "" : "s";
    words.push_back(angle_deg == 180 ? fmt::format("{} half turn{}", number, ending)
                                     : fmt::format("{} turn{} by {} degrees", number, ending, angle_deg));
  }
  return words;
}

std::string millimetres(double metres) {
  constexpr double kSmall_m = 0.01;
  return metres < kSmall_m ? fmt::format("{:.1f}", 1e3 * metres) : fmt::format("{:.0f}", 1e3 * metres);
}

}  // namespace

std::string symmetry_words(const ShapeSymmetry& shape) {
  const std::size_t axes = shape.symmetries.continuous.size();
  if (axes > 1) return "any turn";
  std::vector<std::string> words = rotation_words(shape.symmetries.discrete);
  if (axes == 1) words.insert(words.begin(), "a spin");
  if (shape.nearly_round) words.emplace_back("a spin but for its handle");
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, " and "));
}

std::string size_words(const Eigen::Vector3d& size_m) {
  if (!size_m.allFinite()) return "size unknown";
  return fmt::format("{} x {} x {} mm", millimetres(size_m.x()), millimetres(size_m.y()), millimetres(size_m.z()));
}

std::string title_of(const store::StoredObject& object, const Eigen::Vector3d& size_m) {
  return fmt::format("{} (object {}): {}, {} views, {}{}{}", object.name, object.id, size_words(size_m), object.views,
                     object.attitudes, object.coloured ? "" : ", colour unknown",
                     object.shape_symmetry ? "; shape symmetries: " + symmetry_words(*object.shape_symmetry) : "");
}

void write_title(const std::string& title, cv::Mat& view_image) {
  view_image.rowRange(0, kTitle_px).setTo(kGround);
  cv::putText(view_image, title, {4, kTitle_px - 8}, cv::FONT_HERSHEY_SIMPLEX, 0.55, {255, 255, 255}, 1, cv::LINE_AA);
}

cv::Mat view_image(const std::vector<TrainingView>& views, const std::string& title) {
  const int rows = kShown / kColumns;
  cv::Mat image(kTitle_px + rows * kTile_px, kColumns * kTile_px, CV_8UC3, kGround);
  write_title(title, image);
  const int count = static_cast<int>(views.size());
  for (int i = 0; i < std::min(kShown, count); ++i) {
    const std::size_t which = static_cast<std::size_t>(count <= kShown ? i : i * (count - 1) / (kShown - 1));
    const cv::Mat tile = tile_of(views[which]);
    tile.copyTo(image({{i % kColumns * kTile_px + 1, kTitle_px + i / kColumns * kTile_px + 1}, tile.size()}));
  }
  return image;
}

void write_contact_sheet(const std::vector<std::filesystem::path>& images, const std::filesystem::path& sheet) {
  cv::Mat all;
  for (const std::filesystem::path& file : images) {
    const cv::Mat image = read_colour_image(file);
    require(all.empty() || image.cols == all.cols, "{}: {} pixels wide, expected {} as the others are", file.string(),
            image.cols, all.cols);
    all.push_back(image);
  }
  write_image(all, sheet);
}

}  // namespace houghstream::teach
