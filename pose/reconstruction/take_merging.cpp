#include "pose/reconstruction/take_merging.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/geometry/renderer.hpp"
#include "pose/fusion/distance_grid.hpp"
#include "pose/fusion/grid_surface.hpp"
#include "pose/fusion/surface_smoothing.hpp"
#include "pose/fusion/view_colours.hpp"
#include "pose/reconstruction/model_registration.hpp"

namespace houghstream::reconstruction {
namespace {

/// The part of a view in which the model is, as fusion takes it.
fusion::DepthView depth_view(const TrainingView& view, const Mesh& known, bool whole_picture) {
  constexpr int kMargin_px = 14;
  constexpr int kUnsure_px = 2;
  const Camera& camera = view.frame.camera;
  const cv::Rect whole(0, 0, camera.width, camera.height);
  const cv::Mat model = render_depth(known, view.T_camera_object, camera, whole);
  cv::Mat outline = model == model;
  outline |= view.mask;
  cv::Rect region = cv::boundingRect(outline);
  region = cv::Rect(region.x - kMargin_px, region.y - kMargin_px, region.width + 2 * kMargin_px,
                    region.height + 2 * kMargin_px) &
           whole;
  TrainingView cut = view;
  cut.frame.colour = view.frame.colour(region);
  cut.frame.depth = view.frame.depth(region);
  cut.frame.camera = camera.cropped(region.x, region.y, region.width, region.height);
  cut.mask = view.mask(region);
  fusion::DepthView out = fusion::make_depth_view(cut);
  cv::dilate(outline, outline, cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * kUnsure_px + 1, 2 * kUnsure_px + 1}));
  out.outside = outline(region) == 0;
  if (whole_picture) out.picture = whole - region.tl();
  return out;
}

void end_at_foot(double foot_m, fusion::DistanceGrid& grid) {
  const double truncation = 4.0 * grid.voxel;
  for (int k = 0; k < grid.nz; ++k) {
    const double below = (foot_m - grid.centre(0, 0, k).z()) / truncation;
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        float& distance = grid.distance[grid.index(i, j, k)];
        distance = std::max(distance, static_cast<float>(std::min(below, 1.0)));
      }
    }
  }
}

}  // namespace

std::vector<TrainingView> training_views(const Take& take, const std::vector<ShownView>& views,
                                         const std::string& name) {
  std::vector<TrainingView> out;
  for (const ShownView& view : views) {
    TrainingView made;
    made.frame = take.keyframes[static_cast<std::size_t>(view.keyframe)].frame;
    made.mask = view.mask;
    made.class_id = 1;
    made.class_name = name;
    made.T_camera_object = view.T_camera_object;
    out.push_back(std::move(made));
  }
  return out;
}

void append_mesh(const Mesh& mesh, const Eigen::Isometry3d& T_to_from, Mesh& to) {
  const auto offset = static_cast<std::uint32_t>(to.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) to.vertices.push_back(T_to_from.cast<float>() * vertex);
  for (std::array<std::uint32_t, 3> triangle : mesh.triangles) {
    for (std::uint32_t& vertex : triangle) vertex += offset;
    to.triangles.push_back(triangle);
  }
}

Eigen::Vector3d foot_of(const Mesh& mesh) {
  constexpr float kFoot_m = 0.01F;
  Eigen::AlignedBox2f foot;
  const float lowest = mesh_bounds(mesh).min().z();
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    if (vertex.z() < lowest + kFoot_m) foot.extend(vertex.head<2>());
  }
  return {foot.center().x(), foot.center().y(), lowest};
}

void register_views(std::vector<TrainingView>& views, int threads) {
  constexpr int kRounds = 4;
  MapSettings settings;
  settings.coarsest = 1;
  settings.threads = threads;
  std::vector<Keyframe> keyframes(views.size());
  LevelSettings levels;
  levels.levels = 2;
  PointSettings points;
  points.square_px = 3;
  parallel_for(threads, static_cast<int>(views.size()), [&](int i) {
    const TrainingView& view = views[static_cast<std::size_t>(i)];
    Keyframe& keyframe = keyframes[static_cast<std::size_t>(i)];
    keyframe.levels = make_levels(view.frame, levels);
    cv::Mat mask;
    cv::resize(view.mask, mask, keyframe.levels.levels[0].depth.size(), 0, 0, cv::INTER_NEAREST);
    keyframe.points = choose_points(keyframe.levels, mask, points);
    keyframe.T_camera_world = view.T_camera_object;
  });
  KeyframeMap map(settings, std::move(keyframes));
  map.refine(kRounds);
  for (std::size_t i = 0; i < views.size(); ++i) views[i].T_camera_object = map.keyframes()[i].T_camera_world;
}

ModelOfViews fuse_masked_views(const std::string& name, const MaskedViews& views, const Mesh& known,
                               std::optional<double> foot_m, const ModelMaking& settings) {
  std::vector<fusion::DepthView> depth_views(views.views.size());
  parallel_for(settings.threads, static_cast<int>(depth_views.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    depth_views[at] = depth_view(views.views[at], known, views.whole_pictures);
    if (!views.lights.empty()) depth_views[at].light = views.lights[at];
  });
  fusion::GridSettings grid_settings;
  const Eigen::AlignedBox3d bounds = mesh_bounds(known).cast<double>();
  grid_settings.voxel = bounds.diagonal().norm() > 0.3 ? 2.0 * settings.voxel_m : settings.voxel_m;
  grid_settings.fewest_share = 0.02;
  grid_settings.outline_weight = 0.3;
  grid_settings.threads = settings.threads;
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(settings.beside_m);
  fusion::DistanceGrid grid =
      fusion::fuse_box(depth_views, Eigen::AlignedBox3d(bounds.min() - margin, bounds.max() + margin), grid_settings);
  if (foot_m) end_at_foot(*foot_m, grid);
  ModelOfViews model;
  model.mesh = fusion::largest_part(fusion::extract_surface(grid));
  require(!model.mesh.triangles.empty(), "{}: the views have no common surface, expected those of one object", name);
  fusion::smooth_surface(settings.threads, model.mesh);
  model.seen = fusion::colour_mesh(depth_views, 4.0 * grid.voxel, settings.threads, model.mesh);
  return model;
}

bool merge_takes(const Take& first, ShownModel& model, const Take& second, ShownModel& other,
                 const ModelMaking& settings) {
  const auto found = register_models({&model.mesh, &model.seen}, {&other.mesh, &other.seen}, false, settings.threads);
  if (!found) return false;
  const Eigen::Isometry3d T_other_model = found->T_a_b.inverse();
  ShownModel moved = other;
  for (ShownView& view : moved.views) view.T_camera_object = view.T_camera_object * T_other_model;
  moved.T_world_object = moved.T_world_object * T_other_model;
  Mesh both = model.mesh;  // its outline is that of both
  append_mesh(other.mesh, found->T_a_b, both);
  MaskedViews views{training_views(first, model.views, ""), {}, true};
  views.lights.assign(views.views.size(), light_of(first, 0));
  std::vector<TrainingView> more = training_views(second, moved.views, "");
  std::move(more.begin(), more.end(), std::back_inserter(views.views));
  views.lights.resize(views.views.size(), light_of(second, 1));
  ModelOfViews fused = fuse_masked_views("both takes", views, both, std::nullopt, settings);
  moved.seen_through = std::max(seen_through_share(fused.mesh, first, model.views, settings.threads),
                                seen_through_share(fused.mesh, second, moved.views, settings.threads));
  if (moved.seen_through > kMostSeenThrough) return false;
  model.seen_through = moved.seen_through;
  model.mesh = std::move(fused.mesh);
  model.seen = std::move(fused.seen);
  moved.mesh = model.mesh;
  moved.seen = model.seen;
  other = std::move(moved);
  for (const auto& [take, shown] : {std::pair{&first, &model}, std::pair{&second, &other}}) {
    parallel_for(settings.threads, static_cast<int>(shown->views.size()), [&, take = take, shown = shown](int i) {
      ShownView& view = shown->views[static_cast<std::size_t>(i)];
      view.mask =
          mask_of(model.mesh, take->keyframes[static_cast<std::size_t>(view.keyframe)].frame, view.T_camera_object);
    });
  }
  model.agreement_m = disagreement(model.mesh, {{&first, &model.views}, {&second, &other.views}}, settings.threads);
  other.agreement_m = model.agreement_m;
  return true;
}

}  // namespace houghstream::reconstruction
