#include <algorithm>
#include <iterator>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/datasets/object_pixels.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/base/require_folder.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> scene_folders(const fs::path& folder) {
  require_folder(folder, "BOP training scenes");
  std::vector<fs::path> scenes;
  if (fs::exists(folder / "scene_camera.json")) scenes.push_back(folder);
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_directory() && fs::exists(entry.path() / "scene_camera.json")) scenes.push_back(entry.path());
  }
  std::sort(scenes.begin(), scenes.end());
  require(!scenes.empty(), "{}: no scene_camera.json in or below it, expected BOP training scenes", folder.string());
  return scenes;
}

/// Crops the view to the object with some margin: whole images of every view would fill the memory for nothing.
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

std::string image_name(const BopScene& scene, std::size_t index) {
  return fmt::format("{} image {}", scene.folder().string(), scene.images()[index].image_id);
}

/// Returns one object of an image as a view; `frame` is the whole image.
TrainingView object_view(const BopScene& scene, std::size_t index, std::size_t object_index, const RgbdFrame& frame,
                         const std::map<int, std::string>& names) {
  const GroundTruthObject& object = scene.images()[index].objects[object_index];
  TrainingView view;
  view.source = fmt::format("{} object {}", image_name(scene, index), object_index);
  require(object.has_pose, "{}: object without pose, expected cam_R_m2c and cam_t_m2c to train from", view.source);
  view.frame = frame;
  view.mask = scene.read_mask(index, object_index);
  view.class_id = object.object_id;
  const auto name = names.find(object.object_id);
  view.class_name = name != names.end() ? name->second : fmt::format("object_{}", object.object_id);
  view.T_camera_object = object.T_camera_object;
  return view;
}

/// Holds the outcome of an image.
struct ImageViews {
  std::vector<TrainingView> views;
  int hidden = 0;  ///< objects that are less visible than kMinTrainingVisibility
  int empty = 0;   ///< objects without mask or depth
};

/// Reads an image as one view for each of its objects that is visible enough; the image is read once.
ImageViews read_views(const BopScene& scene, std::size_t index, const std::map<int, std::string>& names) {
  const std::vector<GroundTruthObject>& objects = scene.images()[index].objects;
  ImageViews out;
  if (objects.empty()) {
    TrainingView& background = out.views.emplace_back();
    background.frame = scene.read_frame(index);
    background.source = image_name(scene, index);
    return out;
  }
  std::optional<RgbdFrame> frame;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].visible_fraction < kMinTrainingVisibility) {
      ++out.hidden;
      continue;
    }
    if (!frame) frame = scene.read_frame(index);
    TrainingView view = object_view(scene, index, i, *frame, names);
    if (count_depth_pixels(view.frame.depth, view.mask) == 0) {
      log_warning("{}: empty mask, or no depth on the object; view left out", view.source);
      ++out.empty;
      continue;
    }
    crop_around_mask(view);
    out.views.push_back(std::move(view));
  }
  return out;
}

/// Counts of what was left out of a scene, or of all scenes.
struct LeftOut {
  int hidden = 0;
  int empty = 0;
};

LeftOut append_views(const BopScene& scene, const std::map<int, std::string>& names, int threads,
                     std::vector<TrainingView>& views) {
  std::vector<ImageViews> read(scene.images().size());
  parallel_for(threads, static_cast<int>(read.size()), [&](int i) {
    read[static_cast<std::size_t>(i)] = read_views(scene, static_cast<std::size_t>(i), names);
  });
  LeftOut left_out;
  for (ImageViews& image : read) {
    std::move(image.views.begin(), image.views.end(), std::back_inserter(views));
    left_out.hidden += image.hidden;
    left_out.empty += image.empty;
  }
  return left_out;
}

}  // namespace

std::vector<TrainingView> read_bop_training_views(const fs::path& folder, int threads) {
  std::vector<TrainingView> views;
  LeftOut left_out;
  for (const fs::path& scene_folder : scene_folders(folder)) {
    const LeftOut here = append_views(BopScene(scene_folder), find_bop_names(scene_folder), threads, views);
    left_out.hidden += here.hidden;
    left_out.empty += here.empty;
  }
  require(!views.empty(),
          "{}: of its objects {} have an empty mask or no depth, {} are visible by less than {:.0f} %, expected at "
          "least one usable view",
          folder.string(), left_out.empty, left_out.hidden, 100.0 * kMinTrainingVisibility);
  if (left_out.hidden > 0)
    log_info("{}: {} views, {} objects visible by less than {:.0f} % left out", folder.string(), views.size(),
             left_out.hidden, 100.0 * kMinTrainingVisibility);
  return views;
}

}  // namespace houghstream
