#include "tools/evaluate/import/import_scene.hpp"

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "drivers/datasets/bop_writer.hpp"
#include "drivers/files/frame_folder.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/json_names.hpp"
#include "tools/evaluate/import/drawn_boxes.hpp"
#include "tools/evaluate/import/uw_boxes.hpp"

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

/// Refuses a folder with frames of another scene, which would be taken for this one's.
void require_free(const fs::path& scene_folder, const fs::path& source) {
  require_other_file(scene_folder, source);
  require(!has_images(scene_folder), "{}: holds pictures already, expected a new folder or one without",
          scene_folder.string());
}

/// Writes the scene of frames whose images are called NAME`colour_ending` and NAME_depth.png.
int write_scene(const DrawnBoxes& drawn, const fs::path& source, const std::string& colour_ending,
                const fs::path& scene_folder) {
  std::set<std::string> objects_seen;
  for (const DrawnFrame& frame : drawn.frames) {
    for (const DrawnBox& box : frame.boxes) objects_seen.insert(box.object);
  }
  const std::map<std::string, int> ids = number_names(objects_seen);
  BopWriter writer(scene_folder);
  for (const DrawnFrame& frame : drawn.frames) {
    std::vector<GroundTruthObject> objects;
    for (const DrawnBox& box : frame.boxes) objects.push_back(boxed_object(ids.at(box.object), box.box_px));
    const FrameFiles files{frame.name, source / (frame.name + colour_ending), source / (frame.name + "_depth.png")};
    writer.add(read_frame_pair(files, drawn.camera, 0), objects, {});
  }
  writer.finish();
  std::map<int, std::string> names;
  for (const auto& [name, id] : ids) names[id] = name;
  write_bop_names(names, scene_folder / "names.json");
  return static_cast<int>(drawn.frames.size());
}

/// Returns a word of a command line of the shell, whatever it holds.
std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// Returns the output of uw_boxes.py for SCENE_K.mat, whose error becomes this one's. Its library crashes on some
/// damaged files, so it runs in a separate process.
std::string run_uw_boxes(const fs::path& file, const Camera& camera) {
  const std::string command = fmt::format("/usr/bin/python3 -I -c {} {} {} {} 2>&1", quoted(kUwBoxesScript),
                                          quoted(file.string()), camera.width, camera.height);
  std::FILE* pipe = popen(command.c_str(), "r");
  require(pipe != nullptr, "{}: no process can be started to read it", file.string());
  std::string text;
  std::array<char, 4096> piece{};
  while (const std::size_t size = std::fread(piece.data(), 1, piece.size(), pipe)) text.append(piece.data(), size);
  const int ended = pclose(pipe);
  const int status = WIFEXITED(ended) ? WEXITSTATUS(ended) : ended;
  if (status == 0) return text;
  const std::string last_line = text.substr(0, text.find_last_not_of('\n') + 1);
  require(status != 1, "{}", last_line.substr(last_line.rfind('\n') + 1));
  fail("{}: its reader ended with status {}, expected a whole MATLAB file", file.string(), status);
}

DrawnBoxes read_uw_scene(const fs::path& folder, const Camera& camera) {
  const fs::path file = fs::path(folder).concat(".mat");
  const nlohmann::json frames = parse_json(run_uw_boxes(file, camera), file.string());
  const DrawnBoxes drawn{camera, parse_drawn_frames(frames, camera, file.string())};
  const std::size_t frames_there = list_frame_pairs(folder).size();
  require(drawn.frames.size() >= frames_there, "{} 'bboxes': {} cells for {} frames in {}, expected one each",
          file.string(), drawn.frames.size(), frames_there, folder.string());
  for (const DrawnFrame& frame : drawn.frames) {
    for (const char* ending : {".png", "_depth.png"}) {
      const fs::path image = folder / (frame.name + ending);
      require(fs::exists(image), "{}: missing, expected as frame {} of the annotated video", image.string(),
              &frame - drawn.frames.data() + 1);
    }
  }
  return drawn;
}

}  // namespace

int import_boxes(const fs::path& source, const fs::path& scene_folder) {
  require_free(scene_folder, source);
  return write_scene(read_drawn_boxes(source / "boxes.json"), source, "_color.png", scene_folder);
}

int import_uw_scene(const fs::path& video, const Camera& camera, const fs::path& scene_folder) {
  check_camera(camera, "camera");
  require_free(scene_folder, video);
  const fs::path folder = video.has_filename() ? video : video.parent_path();  // "a/desk_1/" names desk_1 too
  return write_scene(read_uw_scene(folder, camera), folder, ".png", scene_folder);
}

}  // namespace houghstream
