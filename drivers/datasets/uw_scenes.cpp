#include "drivers/datasets/uw_scenes.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/files/mat_file.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

/// "a/desk_1/" names the folder desk_1 too.
fs::path without_slash(const fs::path& folder) {
  return folder.has_filename() ? folder : folder.parent_path();
}

std::string instance_name(const MatArray& structs, std::size_t index, const std::string& where) {
  const std::string category = mat_text(structs, index, "category", where);
  const double instance = mat_number(structs, index, "instance", where);
  constexpr double kMax = 10000;
  require(instance >= 1 && instance <= kMax && instance == std::floor(instance),
          "{} field 'instance': {}, expected a whole number from 1 to {}", where, instance, kMax);
  return fmt::format("{}_{}", category, static_cast<int>(instance));
}

cv::Rect read_box(const MatArray& structs, std::size_t index, const cv::Size& size, const std::string& where) {
  const double top = mat_number(structs, index, "top", where);
  const double bottom = mat_number(structs, index, "bottom", where);
  const double left = mat_number(structs, index, "left", where);
  const double right = mat_number(structs, index, "right", where);
  const bool inside = left >= 0 && top >= 0 && right <= size.width + 1 && bottom <= size.height + 1;
  require(inside && right >= left && bottom >= top,
          "{}: box from left {} top {} to right {} bottom {}, expected ordered and inside 1,1 to {},{}", where, left,
          top, right, bottom, size.width, size.height);
  const auto pixel = [](double one_based) { return static_cast<int>(std::lround(one_based)) - 1; };
  const cv::Rect box(cv::Point(pixel(left), pixel(top)), cv::Point(pixel(right) + 1, pixel(bottom) + 1));
  const cv::Rect seen = box & cv::Rect({0, 0}, size);
  require(!seen.empty(), "{}: box at left {} top {} lies outside the {}x{} image", where, left, top, size.width,
          size.height);
  return seen;
}

std::vector<UwBox> read_boxes(const MatArray& structs, const cv::Size& size, const std::string& where) {
  constexpr std::size_t kMaxBoxes = 1000;
  require(structs.count <= kMaxBoxes, "{}: {} boxes, expected at most {}", where, structs.count, kMaxBoxes);
  std::vector<UwBox> boxes;
  for (std::size_t i = 0; i < structs.count; ++i) {
    const std::string place = fmt::format("{} box {}", where, i + 1);
    const std::string name = instance_name(structs, i, place);
    boxes.push_back({name, read_box(structs, i, size, place)});
  }
  return boxes;
}

FrameFiles numbered_pair(const fs::path& folder, std::size_t number) {
  const std::string name = fmt::format("{}_{}", folder.filename().string(), number);
  FrameFiles pair{name, folder / (name + ".png"), folder / (name + "_depth.png")};
  for (const fs::path& file : {pair.colour, pair.depth})
    require(fs::exists(file), "{}: missing, expected as frame {} of the annotated video", file.string(), number);
  return pair;
}

}  // namespace

std::vector<UwSceneFrame> read_uw_scene(const fs::path& scene, const cv::Size& image_size) {
  const fs::path folder = without_slash(scene);
  const fs::path file = fs::path(folder).concat(".mat");
  const MatArray cells = read_mat_variable(file, "bboxes");
  const std::string variable = file.string() + " 'bboxes'";
  require(cells.kind == MatArray::Kind::kCells && cells.count > 0, "{}: {} {}, expected one cell for each frame",
          variable, cells.count, mat_kind_name(cells.kind));
  const std::size_t frames_there = list_frame_pairs(folder).size();
  require(cells.count >= frames_there, "{}: {} cells for {} frames in {}, expected one each", variable, cells.count,
          frames_there, folder.string());
  std::vector<UwSceneFrame> frames;
  for (std::size_t i = 0; i < cells.count; ++i) {
    const std::string where = fmt::format("{} frame {}", variable, i + 1);
    frames.push_back({numbered_pair(folder, i + 1), read_boxes(cells.children[i], image_size, where)});
  }
  return frames;
}

}  // namespace houghstream
