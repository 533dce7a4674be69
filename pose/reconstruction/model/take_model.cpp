#include "pose/reconstruction/model/take_model.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/geometry/renderer.hpp"
#include "pose/fusion/surface_nets.hpp"
#include "pose/fusion/surface_smoothing.hpp"
#include "pose/fusion/tsdf_volume.hpp"
#include "pose/fusion/view_colours.hpp"
#include "pose/reconstruction/model/model_registration.hpp"

namespace houghstream::reconstruction {
namespace {

using fusion::DepthView;
using fusion::TsdfVolume;

/// Returns the region in which a box is visible, a few pixels wider; the whole image where the camera is too near.
cv::Rect region_of(const Eigen::AlignedBox3d& box, const Camera& camera, const Eigen::Isometry3d& T_camera_world) {
  constexpr int kMargin_px = 8;
  const cv::Rect image(0, 0, camera.width, camera.height);
  const std::optional<cv::Rect> seen = project_box(box, camera, T_camera_world);
  if (!seen) return image;
  const cv::Rect region(seen->x - kMargin_px, seen->y - kMargin_px, seen->width + 2 * kMargin_px,
                        seen->height + 2 * kMargin_px);
  return region & image;
}

/// Returns the views of all surface that the keyframes show about a box; only free space counts as outside.
std::vector<DepthView> views_of_box(const Take& take, const Eigen::AlignedBox3d& box, int threads) {
  std::vector<DepthView> views(take.keyframes.size());
  parallel_for(threads, static_cast<int>(views.size()), [&](int i) {
    const Keyframe& keyframe = take.keyframes[static_cast<std::size_t>(i)];
    const cv::Rect region = region_of(box, keyframe.frame.camera, keyframe.T_camera_world);
    if (region.width < 16 || region.height < 16) return;
    TrainingView view;
    view.frame = keyframe.frame;
    view.frame.colour = keyframe.frame.colour(region);
    view.frame.depth = keyframe.frame.depth(region);
    view.frame.camera = keyframe.frame.camera.cropped(region.x, region.y, region.width, region.height);
    view.mask = cv::Mat(region.size(), CV_8UC1, cv::Scalar(255));
    if (take.motion == Motion::kObject && !take.selected.is_skin_coloured) {  // the hand that rotates it
      cv::Mat skin;
      cv::dilate(skin_pixels(view.frame.colour), skin, cv::getStructuringElement(cv::MORPH_ELLIPSE, {5, 5}));
      view.frame.depth = view.frame.depth.clone();
      view.frame.depth.setTo(std::numeric_limits<float>::quiet_NaN(), skin);
    }
    view.T_camera_object = keyframe.T_camera_world;
    views[static_cast<std::size_t>(i)] = fusion::make_depth_view(view);
    views[static_cast<std::size_t>(i)].lighting_id = lighting_of(take, 0);
  });
  views.erase(std::remove_if(views.begin(), views.end(), [](const DepthView& view) { return view.depth.empty(); }),
              views.end());
  return views;
}

fusion::TsdfSettings tsdf_settings(double voxel, int threads) {
  fusion::TsdfSettings settings;
  settings.voxel = voxel;
  settings.min_fraction = 0.02;
  settings.outline_weight = 0.0;  // nothing is known about the object beside a crop
  settings.threads = threads;
  return settings;
}

/// The voxels of the coarse grid that the object fills, in CV_8UC1 slices.
struct ObjectVoxels {
  TsdfVolume grid;  ///< its layout
  std::vector<cv::Mat> slices;
  Eigen::AlignedBox3d box;
  bool touches_border = false;  ///< whether the object reaches a side of the grid

  bool contains(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d cell = (point - grid.origin) / grid.voxel;
    const int k = std::clamp(static_cast<int>(std::lround(cell.z())), 0, grid.nz - 1);
    const cv::Point at(static_cast<int>(std::lround(cell.x())), static_cast<int>(std::lround(cell.y())));
    const cv::Mat& slice = slices[static_cast<std::size_t>(k)];
    return cv::Rect(0, 0, grid.nx, grid.ny).contains(at) && slice.at<std::uint8_t>(at) != 0;
  }
};

/// Labels the connected components of the voxels that are inside, observed, and higher than the table's depth can
/// reach; 0 = none.
std::vector<int> label_components(const TsdfVolume& grid, double lowest, int& components) {
  std::vector<int> labels(grid.distance.size(), 0);
  components = 0;
  std::vector<std::size_t> queue;
  const int bottom = static_cast<int>(std::ceil((lowest - grid.origin.z()) / grid.voxel));
  const auto is_solid = [&](std::size_t at) {
    return at >= grid.index(0, 0, bottom) && grid.weight[at] > 0.0F && grid.distance[at] < 0.0F;
  };
  for (std::size_t start = 0; start < labels.size(); ++start) {
    if (labels[start] != 0 || !is_solid(start)) continue;
    labels[start] = ++components;
    queue = {start};
    while (!queue.empty()) {
      const std::size_t at = queue.back();
      queue.pop_back();
      const int i = static_cast<int>(at % static_cast<std::size_t>(grid.nx));
      const int j = static_cast<int>(at / static_cast<std::size_t>(grid.nx) % static_cast<std::size_t>(grid.ny));
      const int k = static_cast<int>(at / static_cast<std::size_t>(grid.nx) / static_cast<std::size_t>(grid.ny));
      for (int n = 0; n < 27; ++n) {
        const int x = i + n % 3 - 1;
        const int y = j + n / 3 % 3 - 1;
        const int z = k + n / 9 - 1;
        if (x < 0 || y < 0 || z < 0 || x >= grid.nx || y >= grid.ny || z >= grid.nz) continue;
        const std::size_t next = grid.index(x, y, z);
        if (labels[next] != 0 || !is_solid(next)) continue;
        labels[next] = components;
        queue.push_back(next);
      }
    }
  }
  return labels;
}

/// Returns the component on which most of the selected object's pixels lie; 0 = none.
int select_component(const Take& take, const TsdfVolume& grid, const std::vector<int>& labels, int components) {
  std::vector<int> votes(static_cast<std::size_t>(components) + 1, 0);
  const Keyframe& first = take.keyframes.front();
  const Eigen::Isometry3d T_world_camera = first.T_camera_world.inverse();
  for (int y = 0; y < take.selected.mask.rows; y += 2) {
    for (int x = 0; x < take.selected.mask.cols; x += 2) {
      const float z = first.frame.depth.at<float>(y, x);
      if (take.selected.mask.at<std::uint8_t>(y, x) == 0 || !(z > 0.0F)) continue;
      const Eigen::Vector3d ray = first.frame.camera.backproject(x, y, 1.0);
      // The point lies a little below the surface, so that it falls into a voxel of the object.
      const Eigen::Vector3d cell = (T_world_camera * (ray * (z + 0.5 * grid.voxel)) - grid.origin) / grid.voxel;
      const Eigen::Vector3i at = cell.array().round().cast<int>();
      if ((at.array() < 0).any() || at.x() >= grid.nx || at.y() >= grid.ny || at.z() >= grid.nz) continue;
      ++votes[static_cast<std::size_t>(labels[grid.index(at.x(), at.y(), at.z())])];
    }
  }
  votes[0] = 0;
  const auto maximum = std::max_element(votes.begin(), votes.end());
  return *maximum > 0 ? static_cast<int>(maximum - votes.begin()) : 0;
}

ObjectVoxels segment_object(const Take& take, const Eigen::AlignedBox3d& box, const ReconstructionSettings& settings) {
  ObjectVoxels voxels;
  voxels.grid = fusion::integrate_box(views_of_box(take, box, settings.threads), box,
                                      tsdf_settings(settings.coarse_voxel_m, settings.threads));
  int components = 0;
  const std::vector<int> labels = label_components(voxels.grid, box.min().z(), components);
  const int component = select_component(take, voxels.grid, labels, components);
  if (component == 0) return voxels;
  const TsdfVolume& grid = voxels.grid;
  for (int k = 0; k < grid.nz; ++k) {
    cv::Mat slice = cv::Mat::zeros(grid.ny, grid.nx, CV_8UC1);
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        if (labels[grid.index(i, j, k)] != component) continue;
        slice.at<std::uint8_t>(j, i) = 255;
        voxels.box.extend(grid.centre(i, j, k));
        voxels.touches_border = voxels.touches_border || i == 0 || j == 0 || i == grid.nx - 1 || j == grid.ny - 1;
      }
    }
    voxels.slices.push_back(slice);
  }
  return voxels;
}

/// Returns the object's voxels in a box that contains all of it.
ObjectVoxels find_object(const Take& take, const ReconstructionSettings& settings) {
  constexpr double kWidest_m = 0.45;
  double half =
      std::min(take.selected.has_given_box ? 1.1 * take.selected.radius_m + 0.01 : 1.4 * take.selected.radius_m + 0.03,
               kWidest_m);
  for (;;) {
    const Eigen::AlignedBox3d box(Eigen::Vector3d(-half, -half, settings.foot_m + settings.coarse_voxel_m),
                                  Eigen::Vector3d(half, half, 1.1 * take.selected.height_m + 0.02));
    ObjectVoxels voxels = segment_object(take, box, settings);
    require(!voxels.slices.empty(),
            "nothing is left of the object when all views are put together, expected one thing "
            "that stays together");
    if (!voxels.touches_border || half >= kWidest_m || take.selected.has_given_box) return voxels;
    half = std::min(1.5 * half, kWidest_m);
  }
}

/// Dilates the object's voxels by `margin_m` and fills what they enclose in each slice.
void dilate_voxels(const ReconstructionSettings& settings, ObjectVoxels& voxels) {
  const int cells = static_cast<int>(std::ceil(settings.margin_m / settings.coarse_voxel_m));
  const cv::Mat kernel = cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * cells + 1, 2 * cells + 1});
  std::vector<cv::Mat> dilated(voxels.slices.size());
  for (std::size_t k = 0; k < dilated.size(); ++k) {
    cv::Mat all = cv::Mat::zeros(voxels.slices[k].size(), CV_8UC1);
    for (int d = -cells; d <= cells; ++d) {
      const auto at = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(k) + d, 0,
                                                 static_cast<std::ptrdiff_t>(dilated.size()) - 1);
      all |= voxels.slices[static_cast<std::size_t>(at)];
    }
    cv::dilate(all, all, kernel);
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(all, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    cv::drawContours(all, outlines, -1, cv::Scalar(255), cv::FILLED);
    dilated[k] = all;
  }
  voxels.slices = std::move(dilated);
}

/// Space away from the object is marked as free; below the foot's height the object is continued down to the table.
void carve_free_space(const ObjectVoxels& voxels, const ReconstructionSettings& settings, TsdfVolume& grid) {
  const double truncation = 4.0 * grid.voxel;
  const int foot =
      std::clamp(static_cast<int>(std::ceil((settings.foot_m - grid.origin.z()) / grid.voxel)), 0, grid.nz - 1);
  for (int k = grid.nz - 1; k >= 0; --k) {
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        const std::size_t at = grid.index(i, j, k);
        const Eigen::Vector3d centre = grid.centre(i, j, k);
        if (!voxels.contains({centre.x(), centre.y(), std::max(centre.z(), settings.foot_m)})) grid.distance[at] = 1.0F;
        const bool is_free = grid.weight[at] > 0.0F && grid.distance[at] > 0.0F;
        if (k < foot && !is_free) grid.distance[at] = grid.distance[grid.index(i, j, foot)];
        grid.distance[at] = std::max(grid.distance[at], static_cast<float>(std::min(-centre.z() / truncation, 1.0)));
      }
    }
  }
}

}  // namespace

int lighting_of(const Take& take, int number) {
  return take.motion == Motion::kCamera ? number : -1;
}

ReconstructedModel reconstruct_model(const Take& take, const ReconstructionSettings& settings) {
  ObjectVoxels voxels = find_object(take, settings);
  Eigen::AlignedBox3d box = voxels.box;
  const double voxel = box.diagonal().norm() > 0.3 ? 2.0 * settings.voxel_m : settings.voxel_m;
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(settings.margin_m);
  box = Eigen::AlignedBox3d(box.min() - margin, box.max() + margin);
  box.min().z() = -0.002;
  dilate_voxels(settings, voxels);
  const std::vector<DepthView> views = views_of_box(take, box, settings.threads);
  TsdfVolume grid = fusion::integrate_box(views, box, tsdf_settings(voxel, settings.threads));
  carve_free_space(voxels, settings, grid);
  ReconstructedModel model;
  model.mesh = fusion::largest_part(fusion::extract_surface(grid));
  require(!model.mesh.triangles.empty(), "the views have no common surface, expected an object that all of them show");
  fusion::smooth_surface(settings.threads, model.mesh);
  model.seen = fusion::colour_mesh(views, 4.0 * voxel, settings.threads, model.mesh);
  model.T_world_object.translation() = foot_of(model.mesh);
  model.T_world_object.translation().z() = 0.0;  // height of the table
  for (Eigen::Vector3f& vertex : model.mesh.vertices) vertex -= model.T_world_object.translation().cast<float>();
  const int n = static_cast<int>(take.keyframes.size());
  std::vector<MaskedKeyframe> masked(static_cast<std::size_t>(n));
  parallel_for(settings.threads, n, [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    const Keyframe& keyframe = take.keyframes[at];
    masked[at] = {i, keyframe.T_camera_world * model.T_world_object, {}};
    masked[at].mask = render_visible_mask(model.mesh, keyframe.frame, masked[at].T_camera_object);
  });
  for (MaskedKeyframe& view : masked) {
    if (cv::countNonZero(view.mask) > 0) model.views.push_back(std::move(view));
  }
  model.deviation_m = surface_deviation(model.mesh, {{&take, &model.views}}, settings.threads);
  model.free_space_violation = free_space_violation(model.mesh, take, model.views, settings.threads);
  return model;
}

namespace {

/// Crops a view to the model, in the form for fusion.
fusion::DepthView crop_depth_view(const TrainingView& view, const Mesh& prior_mesh, bool whole_image) {
  constexpr int kMargin_px = 14;
  constexpr int kUnsure_px = 2;
  const Camera& camera = view.frame.camera;
  const cv::Rect whole(0, 0, camera.width, camera.height);
  const cv::Mat model = render_depth(prior_mesh, view.T_camera_object, camera, whole);
  cv::Mat outline = model == model;
  outline |= view.mask;
  cv::Rect region = cv::boundingRect(outline);
  region = cv::Rect(region.x - kMargin_px, region.y - kMargin_px, region.width + 2 * kMargin_px,
                    region.height + 2 * kMargin_px) &
           whole;
  TrainingView cropped = view;
  cropped.frame.colour = view.frame.colour(region);
  cropped.frame.depth = view.frame.depth(region);
  cropped.frame.camera = camera.cropped(region.x, region.y, region.width, region.height);
  cropped.mask = view.mask(region);
  fusion::DepthView out = fusion::make_depth_view(cropped);
  cv::dilate(outline, outline, cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * kUnsure_px + 1, 2 * kUnsure_px + 1}));
  out.free_space_mask = outline(region) == 0;
  if (whole_image) out.image = whole - region.tl();
  return out;
}

void end_at_foot(double foot_m, fusion::TsdfVolume& grid) {
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

std::vector<TrainingView> training_views(const Take& take, const std::vector<MaskedKeyframe>& views,
                                         const std::string& name) {
  std::vector<TrainingView> out;
  for (const MaskedKeyframe& view : views) {
    TrainingView training_view;
    training_view.frame = take.keyframes[static_cast<std::size_t>(view.keyframe)].frame;
    training_view.mask = view.mask;
    training_view.class_id = 1;
    training_view.class_name = name;
    training_view.T_camera_object = view.T_camera_object;
    out.push_back(std::move(training_view));
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
  points.cell_px = 3;
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

FusedSurface fuse_masked_views(const std::string& name, const MaskedViews& views, const Mesh& prior_mesh,
                               std::optional<double> foot_m, const ReconstructionSettings& settings) {
  std::vector<fusion::DepthView> depth_views(views.views.size());
  parallel_for(settings.threads, static_cast<int>(depth_views.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    depth_views[at] = crop_depth_view(views.views[at], prior_mesh, views.whole_images);
    if (!views.lighting_ids.empty()) depth_views[at].lighting_id = views.lighting_ids[at];
  });
  fusion::TsdfSettings tsdf_settings;
  const Eigen::AlignedBox3d bounds = mesh_bounds(prior_mesh).cast<double>();
  tsdf_settings.voxel = bounds.diagonal().norm() > 0.3 ? 2.0 * settings.voxel_m : settings.voxel_m;
  tsdf_settings.min_fraction = 0.02;
  tsdf_settings.outline_weight = 0.3;
  tsdf_settings.threads = settings.threads;
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(settings.margin_m);
  fusion::TsdfVolume grid = fusion::integrate_box(
      depth_views, Eigen::AlignedBox3d(bounds.min() - margin, bounds.max() + margin), tsdf_settings);
  if (foot_m) end_at_foot(*foot_m, grid);
  FusedSurface model;
  model.mesh = fusion::largest_part(fusion::extract_surface(grid));
  require(!model.mesh.triangles.empty(), "{}: the views have no common surface, expected those of one object", name);
  fusion::smooth_surface(settings.threads, model.mesh);
  model.seen = fusion::colour_mesh(depth_views, 4.0 * grid.voxel, settings.threads, model.mesh);
  return model;
}

bool merge_takes(const Take& first, ReconstructedModel& model, const Take& second, ReconstructedModel& other,
                 const ReconstructionSettings& settings) {
  const auto found = register_models({&model.mesh, &model.seen}, {&other.mesh, &other.seen}, false, settings.threads);
  if (!found) return false;
  const Eigen::Isometry3d T_other_model = found->T_a_b.inverse();
  ReconstructedModel registered = other;
  for (MaskedKeyframe& view : registered.views) view.T_camera_object = view.T_camera_object * T_other_model;
  registered.T_world_object = registered.T_world_object * T_other_model;
  Mesh both = model.mesh;  // its outline is that of both
  append_mesh(other.mesh, found->T_a_b, both);
  MaskedViews views{training_views(first, model.views, ""), {}, true};
  views.lighting_ids.assign(views.views.size(), lighting_of(first, 0));
  std::vector<TrainingView> second_views = training_views(second, registered.views, "");
  std::move(second_views.begin(), second_views.end(), std::back_inserter(views.views));
  views.lighting_ids.resize(views.views.size(), lighting_of(second, 1));
  FusedSurface fused = fuse_masked_views("both takes", views, both, std::nullopt, settings);
  registered.free_space_violation =
      std::max(free_space_violation(fused.mesh, first, model.views, settings.threads),
               free_space_violation(fused.mesh, second, registered.views, settings.threads));
  if (registered.free_space_violation > kMaxFreeSpaceViolation) return false;
  model.free_space_violation = registered.free_space_violation;
  model.mesh = std::move(fused.mesh);
  model.seen = std::move(fused.seen);
  registered.mesh = model.mesh;
  registered.seen = model.seen;
  other = std::move(registered);
  for (const auto& [take, masked] : {std::pair{&first, &model}, std::pair{&second, &other}}) {
    parallel_for(settings.threads, static_cast<int>(masked->views.size()), [&, take = take, masked = masked](int i) {
      MaskedKeyframe& view = masked->views[static_cast<std::size_t>(i)];
      view.mask = render_visible_mask(model.mesh, take->keyframes[static_cast<std::size_t>(view.keyframe)].frame,
                                      view.T_camera_object);
    });
  }
  model.deviation_m =
      surface_deviation(model.mesh, {{&first, &model.views}, {&second, &other.views}}, settings.threads);
  other.deviation_m = model.deviation_m;
  return true;
}

}  // namespace houghstream::reconstruction
