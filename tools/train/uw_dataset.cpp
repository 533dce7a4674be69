#include "tools/train/uw_dataset.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/files/frame_folder.hpp"
#include "drivers/files/image_file.hpp"
#include "drivers/files/natural_order.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/require_folder.hpp"
#include "tools/train/turntable.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

/// One instance's folder and the class it teaches.
struct Instance {
  fs::path folder;
  std::string name;
  std::string class_name;
};

/// Parses "can_1" or "can_1=can".
std::pair<std::string, std::string> parse_selected(const std::string& text) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos) return {text, ""};
  require(sign > 0 && sign + 1 < text.size(), "instance '{}', expected NAME or NAME=CLASS", text);
  return {text.substr(0, sign), text.substr(sign + 1)};
}

std::map<std::string, fs::path> instance_folders(const fs::path& folder) {
  require_folder(folder, "CATEGORY/INSTANCE/ folders");
  std::map<std::string, fs::path> found;
  for (const auto& category : fs::directory_iterator(folder)) {
    if (!category.is_directory()) continue;
    for (const auto& instance : fs::directory_iterator(category)) {
      if (instance.is_directory()) found[instance.path().filename().string()] = instance.path();
    }
  }
  require(!found.empty(), "{}: no CATEGORY/INSTANCE/ folders", folder.string());
  return found;
}

std::vector<Instance> select_instances(const fs::path& folder, const UwSelection& selection) {
  const std::map<std::string, fs::path> found = instance_folders(folder);
  std::vector<std::string> wanted = selection.instances;
  if (wanted.empty()) {
    for (const auto& entry : found) wanted.push_back(entry.first);
  }
  std::vector<Instance> instances;
  for (const std::string& text : wanted) {
    const auto [name, class_name] = parse_selected(text);
    const auto entry = found.find(name);
    require(entry != found.end(), "{}: no instance '{}' among {}", folder.string(), name, found.size());
    const std::string category = entry->second.parent_path().filename().string();
    const std::string default_class = selection.by_category ? category : name;
    instances.push_back({entry->second, name, class_name.empty() ? default_class : class_name});
  }
  return instances;
}

/// Video and frame number of "INSTANCE_V_N_crop.png".
struct ViewName {
  std::string stem;  ///< INSTANCE_V_N
  int video = 0;
  int number = 0;
  double yaw = 0.0;  ///< radians
};

/// Sets yaws, which the dataset does not state: a video is taken as one full turn, evenly spread over its frame
/// numbers.
void set_yaws(std::vector<ViewName>& names) {
  std::map<int, std::pair<int, int>> range;  // first and last frame number by video
  for (const ViewName& name : names) {
    auto& [first, last] = range.try_emplace(name.video, name.number, name.number).first->second;
    first = std::min(first, name.number);
    last = std::max(last, name.number);
  }
  for (ViewName& name : names) {
    const auto [first, last] = range.at(name.video);
    name.yaw = 2.0 * M_PI * (name.number - first) / (last - first + 1);
  }
}

std::vector<ViewName> list_views(const Instance& instance) {
  std::vector<ViewName> names;
  for (const auto& entry : fs::directory_iterator(instance.folder)) {
    const std::string file = entry.path().filename().string();
    if (file.compare(0, instance.name.size(), instance.name) != 0) continue;
    ViewName name;
    int used = 0;
    const std::string rest = file.substr(instance.name.size());
    if (std::sscanf(rest.c_str(), "_%6d_%6d_crop.png%n", &name.video, &name.number, &used) != 2) continue;
    if (static_cast<std::size_t>(used) != rest.size()) continue;
    name.stem = fmt::format("{}_{}_{}", instance.name, name.video, name.number);
    names.push_back(name);
  }
  require(!names.empty(), "{}: no views, expected {}_V_N_crop.png", instance.folder.string(), instance.name);
  std::sort(names.begin(), names.end(),
            [](const ViewName& a, const ViewName& b) { return natural_less(a.stem, b.stem); });
  set_yaws(names);
  return names;
}

cv::Point read_location(const fs::path& file) {
  std::istringstream in(read_file(file, "a place of a cut"));
  cv::Point location(-1, -1);
  char comma = 0;
  in >> location.x >> comma >> location.y;
  require(in && comma == ',' && location.x >= 0 && location.y >= 0,
          "{}: missing or unreadable, expected 'x,y' of the crop in pixels", file.string());
  return location;
}

TrainingView read_view(const Instance& instance, const ViewName& name, const Camera& camera) {
  const std::string prefix = (instance.folder / name.stem).string();
  TrainingView view;
  view.source = prefix;
  view.class_name = instance.class_name;
  view.object_frame = fmt::format("{}_{}", instance.name, name.video);
  view.frame.id.utime = dataset_utime(static_cast<std::size_t>(name.number));
  view.frame.colour = read_colour_image(prefix + "_crop.png");
  view.frame.depth = depth_from_millimetres(read_depth_image(prefix + "_depthcrop.png"));
  view.mask = read_mask_image(prefix + "_maskcrop.png");
  const cv::Point at = read_location(prefix + "_loc.txt");
  const cv::Size size = view.frame.colour.size();
  require(at.x <= camera.width - size.width && at.y <= camera.height - size.height,
          "{}: crop {}x{} at {},{}, expected inside the {}x{} image", prefix, size.width, size.height, at.x, at.y,
          camera.width, camera.height);
  view.frame.camera = camera.cropped(at.x, at.y, size.width, size.height);
  check_frame(view.frame, prefix);
  require(view.mask.size() == size, "{}: mask {}x{} and picture {}x{}, expected equal sizes", prefix, view.mask.cols,
          view.mask.rows, size.width, size.height);
  return view;
}

/// Computes poses for the views of one video.
void set_poses(const std::vector<ViewName>& names, std::vector<TrainingView>& views) {
  std::vector<TurntableView> turn;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const RgbdFrame& frame = views[i].frame;
    turn.push_back({names[i].yaw, object_points(frame.colour, frame.depth, views[i].mask, frame.camera)});
  }
  const Turntable table = estimate_turntable(turn);
  for (std::size_t i = 0; i < views.size(); ++i) views[i].T_camera_object = table.pose_at(turn[i].yaw);
}

void append_instance(const Instance& instance, const Camera& camera, std::vector<TrainingView>& out) {
  std::map<int, std::pair<std::vector<ViewName>, std::vector<TrainingView>>> videos;
  for (const ViewName& name : list_views(instance)) {
    TrainingView view = read_view(instance, name, camera);
    if (count_depth_pixels(view.frame.depth, view.mask) == 0) {
      log_warning("{}: empty mask, or no depth on the object; view left out", view.source);
      continue;
    }
    videos[name.video].first.push_back(name);
    videos[name.video].second.push_back(std::move(view));
  }
  require(!videos.empty(), "{}: every view has an empty mask or no depth on the object", instance.folder.string());
  for (auto& [video, content] : videos) {
    set_poses(content.first, content.second);
    std::move(content.second.begin(), content.second.end(), std::back_inserter(out));
  }
}

}  // namespace

std::vector<TrainingView> read_uw_training_views(const fs::path& folder, const UwSelection& selection,
                                                 const Camera& camera) {
  check_camera(camera, folder.string());
  const std::vector<Instance> instances = select_instances(folder, selection);
  std::set<std::string> class_names;
  for (const Instance& instance : instances) class_names.insert(instance.class_name);
  std::vector<TrainingView> views;
  for (const Instance& instance : instances) append_instance(instance, camera, views);
  for (TrainingView& view : views) {
    view.class_id = 1 + static_cast<int>(std::distance(class_names.begin(), class_names.find(view.class_name)));
  }
  return views;
}

std::vector<TrainingView> read_background_views(const fs::path& folder, const Camera& camera) {
  std::vector<TrainingView> views;
  for (const fs::path& video : list_frame_folders(folder)) {
    for (const FrameFiles& pair : list_frame_pairs(video)) {
      TrainingView view;
      view.frame = read_frame_pair(pair, camera, dataset_utime(views.size()));
      view.source = pair.colour.string();
      views.push_back(std::move(view));
    }
  }
  return views;
}

}  // namespace houghstream
