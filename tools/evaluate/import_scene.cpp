#include "tools/evaluate/import_scene.hpp"

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "drivers/bop_writer.hpp"
#include "drivers/frame_folder.hpp"
#include "drivers/json_file.hpp"
#include "drivers/uw_scenes.hpp"
#include "pipeline/checks.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;
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

/// Ids from 1 in the order of the names.
std::map<std::string, int> number_names(const std::set<std::string>& names) {
  std::map<std::string, int> ids;
  for (const std::string& name : names) ids.emplace(name, static_cast<int>(ids.size()) + 1);
  return ids;
}

std::map<std::string, int> number_objects(const json& frames, const std::string& file) {
  std::set<std::string> names;
  for (const json& frame : frames) {
    for (const json& object : list_member(frame, "objects", file)) names.insert(text_member(object, "object", file));
  }
  return number_names(names);
}

TrueObject boxed_object(int object_id, const cv::Rect& box_px) {
  TrueObject object;
  object.object_id = object_id;
  object.has_pose = false;
  object.box_visible_px = box_px;
  return object;
}

void write_names(const std::map<std::string, int>& ids, const fs::path& scene_folder) {
  std::map<int, std::string> names;
  for (const auto& [name, id] : ids) names[id] = name;
  write_bop_names(names, scene_folder / "names.json");
}

TrueObject parse_box(const json& entry, int object_id, const Camera& camera, const std::string& where) {
  const std::vector<double> b = json_numbers(entry, "bbox_xyxy", 4, where);
  require(b[0] >= 0 && b[1] >= 0 && b[2] > b[0] && b[3] > b[1] && b[2] <= camera.width && b[3] <= camera.height,
          "{}: box {},{} to {},{}, expected inside the {}x{} image", where, b[0], b[1], b[2], b[3], camera.width,
          camera.height);
  const cv::Point corner(static_cast<int>(std::lround(b[0])), static_cast<int>(std::lround(b[1])));
  const cv::Point opposite(static_cast<int>(std::lround(b[2])), static_cast<int>(std::lround(b[3])));
  return boxed_object(object_id, cv::Rect(corner, opposite));
}

FramePair named_pair(const fs::path& source, const std::string& name) {
  return {name, source / (name + "_color.png"), source / (name + "_depth.png")};
}

}  // namespace

int import_boxes(const fs::path& source, const fs::path& scene_folder) {
  const fs::path file = source / "boxes.json";
  const json boxes = read_json_object(file);
  const json& frames = list_member(boxes, "frames", file.string());
  require(!frames.empty(), "{}: no frames", file.string());
  const Camera camera = read_camera(boxes, file.string());
  const std::map<std::string, int> ids = number_objects(frames, file.string());
  BopWriter writer(scene_folder);
  for (const json& frame : frames) {
    const std::string name = text_member(frame, "frame", file.string());
    const std::string where = fmt::format("{} frame {}", file.string(), name);
    std::vector<TrueObject> objects;
    for (const json& entry : list_member(frame, "objects", where)) {
      objects.push_back(parse_box(entry, ids.at(text_member(entry, "object", where)), camera, where));
    }
    writer.add(read_frame_pair(named_pair(source, name), camera, 0), objects, {});
  }
  writer.finish();
  write_names(ids, scene_folder);
  return static_cast<int>(frames.size());
}

int import_uw_scene(const fs::path& video, const Camera& camera, const fs::path& scene_folder) {
  check_camera(camera, "camera");
  const std::vector<UwSceneFrame> frames = read_uw_scene(video, {camera.width, camera.height});
  std::set<std::string> names;
  for (const UwSceneFrame& frame : frames) {
    for (const UwBox& box : frame.boxes) names.insert(box.name);
  }
  const std::map<std::string, int> ids = number_names(names);
  BopWriter writer(scene_folder);
  for (const UwSceneFrame& frame : frames) {
    std::vector<TrueObject> objects;
    for (const UwBox& box : frame.boxes) objects.push_back(boxed_object(ids.at(box.name), box.box_px));
    writer.add(read_frame_pair(frame.images, camera, 0), objects, {});
  }
  writer.finish();
  write_names(ids, scene_folder);
  return static_cast<int>(frames.size());
}

}  // namespace houghstream
