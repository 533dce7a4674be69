#include "tools/evaluate/import/import_scene.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

#include "drivers/datasets/bop_writer.hpp"
#include "drivers/datasets/uw_scenes.hpp"
#include "drivers/files/frame_folder.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "tools/evaluate/import/drawn_boxes.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;
/// Ids from 1 in the order of the names.
std::map<std::string, int> number_names(const std::set<std::string>& names) {
  std::map<std::string, int> ids;
  for (const std::string& name : names) ids.emplace(name, static_cast<int>(ids.size()) + 1);
  return ids;
}

GroundTruthObject boxed_object(int object_id, const cv::Rect& box_px) {
  GroundTruthObject object;
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

FrameFiles named_pair(const fs::path& source, const std::string& name) {
  return {name, source / (name + "_color.png"), source / (name + "_depth.png")};
}

/// Frames of another scene would be taken for this one's.
void require_free(const fs::path& scene_folder, const fs::path& source) {
  require_other_file(scene_folder, source);
  require(!has_images(scene_folder), "{}: holds pictures already, expected a new folder or one without",
          scene_folder.string());
}

}  // namespace

int import_boxes(const fs::path& source, const fs::path& scene_folder) {
  require_free(scene_folder, source);
  const DrawnBoxes drawn = read_drawn_boxes(source / "boxes.json");
  std::set<std::string> names;
  for (const DrawnFrame& frame : drawn.frames) {
    for (const DrawnBox& box : frame.boxes) names.insert(box.object);
  }
  const std::map<std::string, int> ids = number_names(names);
  BopWriter writer(scene_folder);
  for (const DrawnFrame& frame : drawn.frames) {
    std::vector<GroundTruthObject> objects;
    for (const DrawnBox& box : frame.boxes) objects.push_back(boxed_object(ids.at(box.object), box.box_px));
    writer.add(read_frame_pair(named_pair(source, frame.name), drawn.camera, 0), objects, {});
  }
  writer.finish();
  write_names(ids, scene_folder);
  return static_cast<int>(drawn.frames.size());
}

int import_uw_scene(const fs::path& video, const Camera& camera, const fs::path& scene_folder) {
  check_camera(camera, "camera");
  require_free(scene_folder, video);
  const std::vector<UwSceneFrame> frames = read_uw_scene(video, {camera.width, camera.height});
  std::set<std::string> names;
  for (const UwSceneFrame& frame : frames) {
    for (const UwBox& box : frame.boxes) names.insert(box.name);
  }
  const std::map<std::string, int> ids = number_names(names);
  BopWriter writer(scene_folder);
  for (const UwSceneFrame& frame : frames) {
    std::vector<GroundTruthObject> objects;
    for (const UwBox& box : frame.boxes) objects.push_back(boxed_object(ids.at(box.name), box.box_px));
    writer.add(read_frame_pair(frame.images, camera, 0), objects, {});
  }
  writer.finish();
  write_names(ids, scene_folder);
  return static_cast<int>(frames.size());
}

}  // namespace houghstream
