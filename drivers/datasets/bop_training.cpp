#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/datasets/object_pixels.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> scene_folders(const fs::path& folder) {
  require(fs::is_directory(folder), "{}: no such folder, expected BOP training scenes", folder.string());
  std::vector<fs::path> scenes;
  if (fs::exists(folder / "scene_camera.json")) scenes.push_back(folder);
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_directory() && fs::exists(entry.path() / "scene_camera.json")) scenes.push_back(entry.path());
  }
  std::sort(scenes.begin(), scenes.end());
  require(!scenes.empty(), "{}: no scene_camera.json in or below it, expected BOP training scenes", folder.string());
  return scenes;
}

/// The object with some room around it: whole images of every view would fill the memory for nothing.
void crop_around_mask(TrainingView& view) {
  constexpr int kMargin_px = 40;
  const cv::Rect box = cv::boundingRect(view.mask);
  const cv::Rect wide(box.x - kMargin_px, box.y - kMargin_px, box.width + 2 * kMargin_px, box.height + 2 * kMargin_px);
  const cv::Rect crop = wide & cv::Rect({0, 0}, view.mask.size());
  view.frame.colour = view.frame.colour(crop).clone();
  view.frame.depth = view.frame.depth(crop).clone();
  view.frame.camera = view.frame.camera.cropped(crop.x, crop.y, crop.width, crop.height);
  view.mask = view.mask(crop).clone();
}

TrainingView object_view(const BopScene& scene, std::size_t index, const std::map<int, std::string>& names) {
  const TrueObject& object = scene.images()[index].objects.front();
  TrainingView view;
  view.source = fmt::format("{} image {}", scene.folder().string(), scene.images()[index].image_id);
  require(object.has_pose, "{}: object without pose, expected cam_R_m2c and cam_t_m2c to train from", view.source);
  view.frame = scene.read_frame(index);
  view.mask = scene.read_mask(index, 0);
  view.class_id = object.object_id;
  const auto name = names.find(object.object_id);
  view.class_name = name != names.end() ? name->second : fmt::format("object_{}", object.object_id);
  view.T_camera_object = object.T_camera_object;
  return view;
}

/// One image as a view; nothing where it shows too little of its object.
std::optional<TrainingView> read_view(const BopScene& scene, std::size_t index,
                                      const std::map<int, std::string>& names) {
  const std::string source = fmt::format("{} image {}", scene.folder().string(), scene.images()[index].image_id);
  const std::size_t objects = scene.images()[index].objects.size();
  require(objects <= 1, "{}: {} objects, expected one object per training image", source, objects);
  if (objects == 0) {
    return TrainingView{scene.read_frame(index), {}, 0, "", Eigen::Isometry3d::Identity(), source, ""};
  }
  TrainingView view = object_view(scene, index, names);
  if (count_depth_pixels(view.frame.depth, view.mask) == 0) {
    log_warning("{}: empty mask, or no depth on the object; view left out", view.source);
    return std::nullopt;
  }
  crop_around_mask(view);
  return view;
}

/// Returns the number of views that were left out.
int append_views(const BopScene& scene, const std::map<int, std::string>& names, int threads,
                 std::vector<TrainingView>& views) {
  std::vector<std::optional<TrainingView>> read(scene.images().size());
  parallel_for(threads, static_cast<int>(read.size()), [&](int i) {
    read[static_cast<std::size_t>(i)] = read_view(scene, static_cast<std::size_t>(i), names);
  });
  int skipped = 0;
  for (std::optional<TrainingView>& view : read) {
    if (view) views.push_back(std::move(*view));
    skipped += view ? 0 : 1;
  }
  return skipped;
}

}  // namespace

std::vector<TrainingView> read_bop_training_views(const fs::path& folder, int threads) {
  std::vector<TrainingView> views;
  int skipped = 0;
  for (const fs::path& scene_folder : scene_folders(folder)) {
    skipped += append_views(BopScene(scene_folder), find_bop_names(scene_folder), threads, views);
  }
  require(!views.empty(),
          "{}: all {} views have an empty mask or no depth on the object, expected at least one usable view",
          folder.string(), skipped);
  return views;
}

}  // namespace houghstream
