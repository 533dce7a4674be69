#include "tools/evaluate/import/drawn_boxes.hpp"

#include <cmath>

#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

using nlohmann::json;

const json& list_member(const json& object, const std::string& key, const std::string& where) {
  require(object.is_object() && object.contains(key) && object.at(key).is_array(), "{}: no list '{}'", where, key);
  return object.at(key);
}

std::string text_member(const json& object, const std::string& key, const std::string& where) {
  require(object.is_object() && object.contains(key) && object.at(key).is_string(), "{}: no text '{}'", where, key);
  return object.at(key).get<std::string>();
}

Camera read_camera(const json& boxes, const std::string& file) {
  const std::vector<double> size = json_numbers(boxes, "image_size", 2, file);
  require(boxes.contains("camera"), "{}: no 'camera'", file);
  const json& c = boxes.at("camera");
  const Camera camera{static_cast<int>(std::lround(size[0])),
                      static_cast<int>(std::lround(size[1])),
                      json_number(c, "fx", file),
                      json_number(c, "fy", file),
                      json_number(c, "cx", file),
                      json_number(c, "cy", file)};
  check_camera(camera, file);
  return camera;
}

DrawnBox parse_box(const json& entry, const Camera& camera, const std::string& where) {
  const std::vector<double> b = json_numbers(entry, "bbox_xyxy", 4, where);
  require(b[0] >= 0 && b[1] >= 0 && b[2] > b[0] && b[3] > b[1] && b[2] <= camera.width && b[3] <= camera.height,
          "{}: box {},{} to {},{}, expected inside the {}x{} image", where, b[0], b[1], b[2], b[3], camera.width,
          camera.height);
  const cv::Point corner(static_cast<int>(std::lround(b[0])), static_cast<int>(std::lround(b[1])));
  const cv::Point opposite(static_cast<int>(std::lround(b[2])), static_cast<int>(std::lround(b[3])));
  return {text_member(entry, "object", where), cv::Rect(corner, opposite)};
}

}  // namespace

std::vector<DrawnFrame> parse_drawn_frames(const json& frames, const Camera& camera, const std::string& source) {
  std::vector<DrawnFrame> drawn;
  for (const json& frame : frames) {
    DrawnFrame& out = drawn.emplace_back();
    out.name = text_member(frame, "frame", source);
    const std::string where = fmt::format("{} frame {}", source, out.name);
    for (const json& entry : list_member(frame, "objects", where)) out.boxes.push_back(parse_box(entry, camera, where));
  }
  return drawn;
}

DrawnBoxes read_drawn_boxes(const std::filesystem::path& file) {
  const json content = read_json_object(file);
  const json& frames = list_member(content, "frames", file.string());
  require(!frames.empty(), "{}: no frames", file.string());
  const Camera camera = read_camera(content, file.string());
  return {camera, parse_drawn_frames(frames, camera, file.string())};
}

}  // namespace houghstream
