#include "tools/render/world/scene_frames.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/optics/depth_sensor.hpp"
#include "tools/render/world/optics/photo.hpp"
#include "tools/render/world/optics/time_of_flight.hpp"

namespace houghstream::world {
namespace {

constexpr int kMinVisiblePx = 50;
constexpr std::uint64_t kFirstFrameAspect = 100000;

// Counts pixels of the whole silhouette, those beyond the image's border included.
int silhouette_px(const Mesh& mesh, const Eigen::Isometry3d& T_camera_object, const Camera& camera) {
  Eigen::AlignedBox2d extent;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3d point = T_camera_object * vertex.cast<double>();
    if (point.z() > 0.05) extent.extend(camera.project(point));
  }
  if (extent.isEmpty()) return 0;
  const Eigen::Vector2i low = extent.min().array().floor().cast<int>();
  const Eigen::Vector2i high = extent.max().array().ceil().cast<int>();
  const cv::Rect region(low.x(), low.y(), high.x() - low.x() + 1, high.y() - low.y() + 1);
  const cv::Mat depth = render_depth(mesh, T_camera_object, camera, region);
  return cv::countNonZero(depth == depth);  // NaN differs from itself
}

void add_ground_truth(const LitWorld& lit_world, const Eigen::Isometry3d& T_camera_world, const cv::Mat& ids,
                      RenderedFrame& result) {
  for (std::size_t i = 0; i < lit_world.world.items.size(); ++i) {
    const PlacedAsset& placed = lit_world.world.items[i];
    if (placed.object_id == 0) continue;
    const cv::Mat mask = ids == static_cast<double>(i + 1);
    const int visible = cv::countNonZero(mask);
    if (visible < kMinVisiblePx) continue;
    GroundTruthObject object;
    object.object_id = placed.object_id;
    object.T_camera_object = T_camera_world * placed.T_world_object;
    object.box_visible_px = cv::boundingRect(mask);
    const int all = silhouette_px(placed.thing->mesh, object.T_camera_object, result.frame.camera);
    object.visible_fraction = std::min(1.0, static_cast<double>(visible) / std::max(all, visible));
    result.objects.push_back(object);
    result.visible_masks.push_back(mask);
  }
}

}  // namespace

SensorKind parse_sensor(const std::string& name) {
  if (name == "structured_light") return SensorKind::kStructuredLight;
  if (name == "time_of_flight") return SensorKind::kTimeOfFlight;
  fail("sensor '{}', expected structured_light or time_of_flight", name);
}

RenderedFrame render_frame(const LitWorld& lit_world, const Eigen::Isometry3d& T_camera_world, std::uint64_t noise_seed,
                           SensorKind sensor) {
  const ShadedView view = shade_view(lit_world, lit_world.world.camera, T_camera_world);
  return record_view(lit_world, T_camera_world, view, noise_seed, sensor);
}

RenderedFrame record_view(const LitWorld& lit_world, const Eigen::Isometry3d& T_camera_world, const ShadedView& view,
                          std::uint64_t noise_seed, SensorKind sensor) {
  RenderedFrame result;
  result.frame.camera = lit_world.world.camera;
  result.frame.colour = simulate_colour_camera(view.radiance, lit_world.world.photo, aspect_seed(noise_seed, 1));
  const SensorView seen{view.geometry.depth, view.cos_incidence, view.reflectance, view.specular};
  const std::uint64_t depth_seed = aspect_seed(noise_seed, 2);
  if (sensor == SensorKind::kTimeOfFlight) {
    result.frame.colour = apply_camera_response(result.frame.colour, other_colour_camera());
    result.frame.depth = measure_time_of_flight(seen, TimeOfFlightSettings{}, depth_seed);
  } else {
    result.frame.depth = measure_depth(seen, result.frame.camera, DepthSensorSettings{}, depth_seed);
  }
  add_ground_truth(lit_world, T_camera_world, view.geometry.id, result);
  return result;
}

RenderedFrame render_scene_frame(const Scene& scene, const LitWorld& lit_world, int index, int count,
                                 SensorKind sensor) {
  const double time = count > 1 ? static_cast<double>(index) / (count - 1) : 0.0;
  const std::uint64_t noise_seed = aspect_seed(scene.seed, kFirstFrameAspect + static_cast<std::uint64_t>(index));
  return render_frame(lit_world, camera_at(scene.trajectory, time), noise_seed, sensor);
}

}  // namespace houghstream::world
