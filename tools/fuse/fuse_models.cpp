#include "tools/fuse/fuse_models.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "drivers/datasets/bop_writer.hpp"
#include "drivers/datasets/open_frame_source.hpp"
#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/log_line.hpp"
#include "tools/common/progress_line.hpp"
#include "tools/fuse/model_image.hpp"

namespace houghstream {
namespace {

void report(const std::string& name, const fusion::FusedModel& model, std::size_t views) {
  const auto seen = static_cast<double>(std::count(model.seen.begin(), model.seen.end(), true));
  fmt::print("{} views {} triangles {} diameter_mm {:.1f} seen_share {:.3f} agreement_mm {:.2f} before_mm {:.2f}\n",
             name, views, model.mesh.triangles.size(), 1e3 * mesh_diameter(model.mesh),
             seen / static_cast<double>(model.seen.size()), 1e3 * model.after.median_m, 1e3 * model.before.median_m);
}

}  // namespace

std::vector<ObjectViews> group_views(std::vector<TrainingView> views) {
  std::map<int, std::vector<ObjectViews>> frames_of_class;  // frames of each class, each with the views of one frame
  for (TrainingView& view : views) {
    if (view.class_id == 0) continue;
    std::vector<ObjectViews>& frames = frames_of_class[view.class_id];
    auto frame = std::find_if(frames.begin(), frames.end(), [&](const ObjectViews& other) {
      return other.views.front().object_frame == view.object_frame;
    });
    if (frame == frames.end()) {
      frame = frames.emplace(frames.end());
      frame->class_id = view.class_id;
      frame->class_name = view.class_name;
      frame->exact_poses = view.object_frame.empty();
    }
    frame->views.push_back(std::move(view));
  }
  require(!frames_of_class.empty(), "{} views without any object, expected some to fuse", views.size());
  std::vector<ObjectViews> objects;
  for (auto& [id, frames] : frames_of_class) {
    const auto maximum = std::max_element(frames.begin(), frames.end(), [](const ObjectViews& a, const ObjectViews& b) {
      return a.views.size() < b.views.size();
    });
    for (auto frame = frames.begin(); frame != frames.end(); ++frame) {
      if (frame != maximum) maximum->unused.push_back(frame->views.front().object_frame);
    }
    objects.push_back(std::move(*maximum));
  }
  return objects;
}

void check_outputs(const FuseOutputs& outputs, const std::vector<std::string>& views) {
  for (const std::string& view : views) {
    require_outside_source(outputs.models, view);
    require_outside_source(outputs.images, view);
  }
  require(outputs.replace || !has_models(outputs.models),
          "{}: holds models already; --replace puts others in their place", outputs.models.string());
  require_writable_folder(outputs.models);
  if (!outputs.images.empty()) require_writable_folder(outputs.images);
}

void fuse_models(const std::vector<ObjectViews>& objects, fusion::FusionSettings settings, const FuseOutputs& outputs) {
  std::vector<NamedModel> models;
  ProgressLine progress("objects fused", static_cast<double>(objects.size()));
  for (const ObjectViews& object : objects) {
    if (!object.unused.empty()) {
      log_warning("{}: fused from {} only, a model has one frame; left out: {}", object.class_name,
                  object.views.front().object_frame, fmt::join(object.unused, ", "));
    }
    settings.align = !object.exact_poses;
    fusion::FusedModel model = fusion::fuse_views(object.class_name, object.views, settings);
    report(object.class_name, model, object.views.size());
    if (!outputs.images.empty()) {
      std::error_code error;
      std::filesystem::create_directories(outputs.images, error);
      require(!error, "{}: cannot make this folder: {}", outputs.images.string(), error.message());
      write_png(draw_model(model.mesh), outputs.images / (object.class_name + ".png"));
    }
    models.push_back({object.class_id, object.class_name, std::move(model.mesh), {}});
    progress.add(1.0);
  }
  write_bop_models(models, outputs.models);
}

}  // namespace houghstream
