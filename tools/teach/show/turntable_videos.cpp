#include "tools/teach/show/turntable_videos.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <map>

#include "drivers/datasets/uw_dataset.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pose/fusion/fuse_views.hpp"
#include "pose/reconstruction/model_registration.hpp"
#include "pose/reconstruction/take_merging.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;
using reconstruction::ModelOfViews;
using reconstruction::ShownView;
using reconstruction::Take;

constexpr const char* kNominalCamera = "640x480,525,525,319.5,239.5";

struct Video {
  std::vector<TrainingView> views;
  fusion::FusedModel model;
};

fusion::FusedModel fuse(const std::string& name, const std::vector<TrainingView>& views, int threads) {
  fusion::FusionSettings settings;
  settings.align = false;
  settings.threads = threads;
  return fusion::fuse_views(name, views, settings);
}

/// The better of the poses that the axis gives and of those that registration makes of them.
Video make_video(const std::string& name, std::vector<TrainingView> views, int threads) {
  Video by_axis{views, fuse(name, views, threads)};
  reconstruction::register_views(views, threads);
  Video by_registration{views, fuse(name, views, threads)};
  const bool is_better = by_registration.model.after.median_m < by_axis.model.after.median_m;
  log_info("{}: {} views agree within {:.2f} mm by the axis, {:.2f} mm registered", name, views.size(),
           1e3 * by_axis.model.after.median_m, 1e3 * by_registration.model.after.median_m);
  return is_better ? by_registration : by_axis;
}

std::vector<Video> read_videos(const ShowOptions& options) {
  const fs::path folder = fs::path(options.source.substr(3)).lexically_normal();
  UwSelection selection;
  selection.instances = {folder.filename().string()};
  std::map<std::string, std::vector<TrainingView>> by_video;
  for (TrainingView& view :
       read_uw_training_views(folder.parent_path().parent_path(), selection,
                              parse_camera(options.camera.empty() ? kNominalCamera : options.camera)))
    by_video[view.object_frame].push_back(std::move(view));
  std::vector<Video> videos;
  for (auto& [name, views] : by_video) videos.push_back(make_video(name, std::move(views), options.threads));
  std::stable_sort(videos.begin(), videos.end(),
                   [](const Video& a, const Video& b) { return a.model.after.median_m < b.model.after.median_m; });
  return videos;
}

/// All videos' views in the first one's frame; what does not fit is left out.
std::vector<TrainingView> merge(const std::vector<Video>& videos, Mesh& outline, int threads) {
  std::vector<TrainingView> all = videos.front().views;
  const fusion::FusedModel& first = videos.front().model;
  outline = first.mesh;
  for (std::size_t i = 1; i < videos.size(); ++i) {
    const fusion::FusedModel& model = videos[i].model;
    const auto found =
        reconstruction::register_models({&first.mesh, &first.seen}, {&model.mesh, &model.seen}, true, threads);
    if (!found) {
      log_warning("{} does not fit {}, and is left out", videos[i].views.front().object_frame,
                  videos.front().views.front().object_frame);
      continue;
    }
    for (TrainingView view : videos[i].views) {
      view.T_camera_object = view.T_camera_object * found->T_a_b.inverse();
      all.push_back(std::move(view));
    }
    reconstruction::append_mesh(model.mesh, found->T_a_b, outline);
  }
  return all;
}

/// The views as a take that is over.
Take take_of(const std::vector<TrainingView>& views, std::vector<ShownView>& shown) {
  Take take;
  take.motion = reconstruction::Motion::kTurntable;
  take.degrees_round = 360;
  for (std::size_t i = 0; i < views.size(); ++i) {
    reconstruction::Keyframe keyframe;
    keyframe.frame = views[i].frame;
    keyframe.number = static_cast<int>(i);
    keyframe.T_camera_world = views[i].T_camera_object;
    take.frames.push_back({views[i].frame.id, true, false, static_cast<int>(i), Eigen::Isometry3d::Identity()});
    take.keyframes.push_back(std::move(keyframe));
    reconstruction::mark_seen(views[i].T_camera_object.inverse().translation(), take.seen);
    shown.push_back({static_cast<int>(i), views[i].T_camera_object, views[i].mask});
  }
  take.chosen.T_camera_stand = views.front().T_camera_object;
  return take;
}

}  // namespace

bool is_turntable_videos(const std::string& source) {
  if (source.rfind("uw:", 0) != 0 || !fs::is_directory(source.substr(3))) return false;
  const fs::path folder = source.substr(3);
  return std::any_of(fs::directory_iterator(folder), fs::directory_iterator(), [](const fs::directory_entry& entry) {
    const std::string name = entry.path().filename().string();
    return name.size() > 13 && name.compare(name.size() - 13, 13, "_maskcrop.png") == 0;
  });
}

Shown show_turntable(const ShowOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<Video> videos = read_videos(options);
  Mesh outline;
  std::vector<TrainingView> views = merge(videos, outline, options.threads);
  std::vector<TrainingView> registered = views;
  reconstruction::register_views(registered, options.threads);
  const double before = fuse(options.name, views, options.threads).after.median_m;
  const double after = fuse(options.name, registered, options.threads).after.median_m;
  if (after < before) views = std::move(registered);
  reconstruction::ModelMaking making;
  making.threads = options.threads;
  ModelOfViews model =
      fuse_masked_views(options.name, views, outline, mesh_bounds(videos.front().model.mesh).min().z(), making);
  const Eigen::Vector3d foot = reconstruction::foot_of(model.mesh);
  for (Eigen::Vector3f& vertex : model.mesh.vertices) vertex -= foot.cast<float>();
  for (TrainingView& view : views) view.T_camera_object = view.T_camera_object * Eigen::Translation3d(foot);
  Shown shown;
  shown.name = options.name;
  shown.views.emplace_back();
  shown.takes.push_back(take_of(views, shown.views.front()));
  shown.mesh = std::move(model.mesh);
  shown.seen = std::move(model.seen);
  shown.agreement_m = std::min(before, after);
  shown.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return shown;
}

}  // namespace houghstream::teach
