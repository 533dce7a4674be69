#include "tools/teach/show/turntable_videos.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <map>
#include <tuple>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pose/fusion/fuse_views.hpp"
#include "pose/reconstruction/model/model_registration.hpp"
#include "pose/reconstruction/model/silhouette_alignment.hpp"
#include "pose/reconstruction/model/take_model.hpp"
#include "tools/train/uw_dataset.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;
using reconstruction::FusedSurface;
using reconstruction::MaskedKeyframe;
using reconstruction::Take;

constexpr const char* kNominalCamera = "640x480,525,525,319.5,239.5";

struct Video {
  std::vector<TrainingView> views;
  fusion::FusedModel model;
  double overlap = 0.0;  ///< median over its views, of the model's outline and the masks
};

/// Returns the median overlap of the model's outline with the views' masks.
double silhouette_iou(const Mesh& mesh, const std::vector<TrainingView>& views) {
  std::vector<double> overlaps;
  overlaps.reserve(views.size());
  for (const TrainingView& view : views) overlaps.push_back(reconstruction::silhouette_iou(mesh, view));
  const auto middle = overlaps.begin() + static_cast<std::ptrdiff_t>(overlaps.size() / 2);
  std::nth_element(overlaps.begin(), middle, overlaps.end());
  return *middle;
}

fusion::FusedModel fused_model(const std::string& name, const std::vector<TrainingView>& views, int threads) {
  fusion::FusionSettings settings;
  settings.align = false;
  settings.threads = threads;
  return fusion::fuse_views(name, views, settings);
}

Video fuse(const std::string& name, std::vector<TrainingView> views, int threads) {
  Video video{std::move(views), {}, 0.0};
  video.model = fused_model(name, video.views, threads);
  video.overlap = silhouette_iou(video.model.mesh, video.views);
  return video;
}

/// Makes a video of the best poses: those of the axis, those that registration makes of them, or those of the outlines;
/// the masks, from which none is made, decide.
Video make_video(const std::string& name, const std::vector<TrainingView>& views, int threads) {
  std::vector<TrainingView> registered = views;
  reconstruction::register_views(registered, threads);
  std::vector<Video> videos = {fuse(name, views, threads), fuse(name, std::move(registered), threads)};
  std::vector<TrainingView> placed = views;
  reconstruction::align_silhouettes(videos.front().model.mesh, threads, placed);
  videos.push_back(fuse(name, std::move(placed), threads));
  log_info("{}: {} views, whose outlines overlap by {:.3f} by the axis, {:.3f} registered, {:.3f} placed by outlines",
           name, views.size(), videos[0].overlap, videos[1].overlap, videos[2].overlap);
  return *std::max_element(videos.begin(), videos.end(),
                           [](const Video& a, const Video& b) { return a.overlap < b.overlap; });
}

std::vector<Video> read_videos(const ShowOptions& options) {
  // CATEGORY/INSTANCE, however it was named: with a slash at its end, or from within CATEGORY.
  const fs::path folder = fs::absolute(fs::path(options.source.substr(3)) / "").lexically_normal().parent_path();
  UwSelection selection;
  selection.instances = {folder.filename().string()};
  std::map<std::string, std::vector<TrainingView>> by_video;
  for (TrainingView& view :
       read_uw_training_views(folder.parent_path().parent_path(), selection,
                              parse_camera(options.camera.empty() ? kNominalCamera : options.camera)))
    by_video[view.object_frame].push_back(std::move(view));
  std::vector<Video> videos;
  videos.reserve(by_video.size());
  for (auto& [name, views] : by_video) videos.push_back(make_video(name, views, options.threads));
  std::stable_sort(videos.begin(), videos.end(), [](const Video& a, const Video& b) { return a.overlap > b.overlap; });
  return videos;
}

/// All videos' views in the first one's frame; what does not fit is left out.
class Merging {
 public:
  Merging(const ShowOptions& options, const Video& first) : options_(options), first_(first), views_(first.views) {
    making_.threads = options.threads;
    outline_ = first.model.mesh;
    model_ = fuse(views_, outline_);
    overlap_ = teach::silhouette_iou(model_.mesh, views_);
  }

  /// Adds a video where the outlines of all views still fit.
  void add(const Video& video) {
    constexpr double kMaxLost = 0.02;
    const auto found = reconstruction::register_models({&first_.model.mesh, &first_.model.seen},
                                                       {&video.model.mesh, &video.model.seen}, true, options_.threads);
    double overlap = 0.0;
    if (found) {
      std::vector<TrainingView> all = views_;
      for (TrainingView view : video.views) {
        view.T_camera_object = view.T_camera_object * found->T_a_b.inverse();
        all.push_back(std::move(view));
      }
      Mesh outline = outline_;
      reconstruction::append_mesh(video.model.mesh, found->T_a_b, outline);
      FusedSurface model = fuse(all, outline);
      overlap = teach::silhouette_iou(model.mesh, all);
      if (overlap > overlap_ - kMaxLost) {
        std::tie(views_, outline_, model_, overlap_) =
            std::tuple(std::move(all), std::move(outline), std::move(model), overlap);
        return;
      }
    }
    log_warning("{} does not fit {}, and is left out: the outlines would overlap by {:.3f} instead of {:.3f}",
                video.views.front().object_frame, first_.views.front().object_frame, overlap, overlap_);
  }

  /// Moves the views to the model's outline, and makes it again, for as long as that helps.
  void settle() {
    constexpr int kRounds = 4;
    for (int round = 0; round < kRounds; ++round) {
      std::vector<TrainingView> placed = views_;
      reconstruction::align_silhouettes(model_.mesh, options_.threads, placed);
      FusedSurface again = fuse(placed, model_.mesh);
      const double overlap = teach::silhouette_iou(again.mesh, placed);
      if (overlap <= overlap_) return;
      std::tie(views_, model_, overlap_) = std::tuple(std::move(placed), std::move(again), overlap);
    }
  }

  std::vector<TrainingView>& views() { return views_; }
  FusedSurface& model() { return model_; }
  double overlap() const { return overlap_; }

 private:
  FusedSurface fuse(const std::vector<TrainingView>& views, const Mesh& outline) const {
    return fuse_masked_views(options_.name, {views, {}}, outline, mesh_bounds(outline).min().z(), making_);
  }

  const ShowOptions& options_;
  const Video& first_;
  reconstruction::ReconstructionSettings making_;
  std::vector<TrainingView> views_;
  Mesh outline_;
  FusedSurface model_;
  double overlap_ = 0.0;
};

/// Returns the views as a take that is over.
Take take_of(const std::vector<TrainingView>& views, std::vector<MaskedKeyframe>& shown) {
  Take take;
  take.motion = reconstruction::Motion::kTurntable;
  take.covered_degrees = 360;
  for (std::size_t i = 0; i < views.size(); ++i) {
    reconstruction::Keyframe keyframe;
    keyframe.frame = views[i].frame;
    keyframe.number = static_cast<int>(i);
    keyframe.T_camera_world = views[i].T_camera_object;
    reconstruction::RegisteredFrame& placed = take.frames.emplace_back();
    placed.id = views[i].frame.id;
    placed.tracked = true;
    placed.keyframe = static_cast<int>(i);
    take.keyframes.push_back(std::move(keyframe));
    reconstruction::mark_covered(views[i].T_camera_object.inverse().translation(), take.seen);
    shown.push_back({static_cast<int>(i), views[i].T_camera_object, views[i].mask});
  }
  take.selected.T_camera_stand = views.front().T_camera_object;
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

ShowResult show_turntable(const ShowOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<Video> videos = read_videos(options);
  Merging merging(options, videos.front());
  for (std::size_t i = 1; i < videos.size(); ++i) merging.add(videos[i]);
  merging.settle();
  std::vector<TrainingView>& views = merging.views();
  FusedSurface& model = merging.model();
  const Eigen::Vector3d foot = reconstruction::foot_of(model.mesh);
  for (Eigen::Vector3f& vertex : model.mesh.vertices) vertex -= foot.cast<float>();
  for (TrainingView& view : views) view.T_camera_object = view.T_camera_object * Eigen::Translation3d(foot);
  ShowResult shown;
  shown.name = options.name;
  shown.views.emplace_back();
  shown.takes.push_back(take_of(views, shown.views.front()));
  shown.mesh = std::move(model.mesh);
  shown.seen_surface = covered_fraction(model.seen);
  shown.deviation_m = fused_model(options.name, views, options.threads).after.median_m;
  shown.silhouette_iou = merging.overlap();
  shown.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return shown;
}

}  // namespace houghstream::teach
