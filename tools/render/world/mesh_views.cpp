#include "tools/render/world/mesh_views.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"
#include "tools/render/world/objects/pixel_noise.hpp"
#include "tools/render/world/objects/seeds.hpp"
#include "tools/render/world/objects/vessels.hpp"
#include "tools/render/world/optics/depth_sensor.hpp"
#include "tools/render/world/optics/light.hpp"
#include "tools/render/world/optics/photo.hpp"
#include "tools/render/world/optics/shading.hpp"
#include "tools/render/world/rooms/stable_poses.hpp"
#include "tools/render/world/scene_frames.hpp"

namespace houghstream::world {
namespace {

constexpr int kMaxAttitudes = 10;
constexpr double kSameAttitudeDeg = 40.0;  // nearer ways of resting are one: views between them are jittered
constexpr double kNearlyFlat_m = 0.001;    // the foot of a scan
constexpr double kTiltDeviationDeg = 4.0;  // no table is level, no camera upright
constexpr double kMinLeanDeg = 10.0;
constexpr double kMaxLeanDeg = 45.0;
constexpr int kMargin_px = 12;

double radians(double degrees) {
  return degrees * M_PI / 180.0;
}

/// Returns a rotation about a level axis of random direction.
Eigen::Matrix3d tilt(double angle_rad, Random& random) {
  const double towards = random.uniform(0.0, 2.0 * M_PI);
  const Eigen::Vector3d axis(std::cos(towards), std::sin(towards), 0.0);
  return Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
}

/// Returns the mesh about the middle of its bounding box: the volume of a surface that is not closed depends on the
/// origin.
Mesh about_its_middle(Mesh mesh) {
  const Eigen::Vector3f middle = mesh_bounds(mesh).center();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex -= middle;
  return mesh;
}

/// Poses are sorted by stability, most stable first; those that differ by less than kSameAttitudeDeg are left out.
std::vector<Eigen::Vector3d> stable_ups(const Mesh& mesh) {
  std::vector<StablePose> all;
  for (const StablePoseFamily& family : find_stable_poses(about_its_middle(mesh), kNearlyFlat_m))
    all.insert(all.end(), family.begin(), family.end());
  std::stable_sort(all.begin(), all.end(), [](const StablePose& a, const StablePose& b) {
    return a.steepest_slope_rad() > b.steepest_slope_rad();
  });
  std::vector<Eigen::Vector3d> ups;
  for (const StablePose& attitude : all) {
    const Eigen::Vector3d up = attitude.R_table_object.row(2);
    const bool is_new = std::all_of(ups.begin(), ups.end(), [&](const Eigen::Vector3d& other) {
      return up.dot(other) < std::cos(radians(kSameAttitudeDeg));
    });
    if (is_new && static_cast<int>(ups.size()) < kMaxAttitudes) ups.push_back(up);
  }
  return ups;
}

/// A table whose top is at `height`.
PlacedAsset table_top(double height, Random& random) {
  constexpr double kThickness = 0.02;
  const cv::Mat cover =
      plain({256, 256}, hsv(random.uniform(0, 360), random.uniform(0.0, 0.5), random.uniform(0.2, 0.9)), 0.05, random);
  PlacedAsset table{make_asset("table", rotated_mesh({{0.6, 0.0}, {0.6, kThickness}}, cover), 0.08F),
                    Eigen::Isometry3d::Identity(), 0, true};
  table.T_world_object.translate(Eigen::Vector3d(0.0, 0.0, height - 0.5 * kThickness));  // its origin is its middle
  return table;
}

/// Returns the camera cropped to the mesh and a small margin.
Camera cropped_around(const Mesh& mesh, const Eigen::Isometry3d& T_camera_object) {
  const Camera whole = synthetic_camera();
  Eigen::AlignedBox2d extent;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    extent.extend(whole.project(T_camera_object * vertex.cast<double>()));
  const Eigen::Vector2i low = extent.min().array().floor().cast<int>() - kMargin_px;
  const Eigen::Vector2i high = extent.max().array().ceil().cast<int>() + kMargin_px;
  return whole.cropped(low.x(), low.y(), high.x() - low.x() + 1, high.y() - low.y() + 1);
}

/// Surroundings of the object: without them the camera's exposure would rise and its depth end without an edge.
void put_wall_behind(double distance, Random& random, ShadedView& view) {
  const auto grey = static_cast<float>(random.uniform(0.03, 0.5));
  const cv::Scalar colour(grey * random.uniform(0.7, 1.3), grey, grey * random.uniform(0.7, 1.3));
  const cv::Mat empty = view.geometry.id == 0;
  view.radiance.setTo(colour, empty);
  view.geometry.depth.setTo(distance, empty);
  view.cos_incidence.setTo(1.0, empty);
  view.reflectance.setTo(0.5, empty);
}

}  // namespace

MeshAttitudes parse_mesh_attitudes(const std::string& name) {
  if (name == "resting") return MeshAttitudes::kResting;
  if (name == "upright") return MeshAttitudes::kUpright;
  if (name == "any") return MeshAttitudes::kAny;
  fail("attitudes '{}', expected resting, upright or any", name);
}

std::vector<Eigen::Vector3d> up_directions(const Mesh& mesh, MeshAttitudes attitudes) {
  if (attitudes == MeshAttitudes::kAny) return {};
  if (attitudes == MeshAttitudes::kUpright) return {Eigen::Vector3d::UnitZ()};
  try {
    return stable_ups(mesh);
  } catch (const InputError&) {  // the mesh has no volume
    std::vector<Eigen::Vector3d> sides;
    for (int axis = 0; axis < 3; ++axis) {
      sides.emplace_back(Eigen::Vector3d::Unit(axis));
      sides.emplace_back(-Eigen::Vector3d::Unit(axis));
    }
    return sides;
  }
}

Eigen::Matrix3d random_rotation(Random& random) {
  const double u = random.uniform();
  const double a = random.uniform(0.0, 2.0 * M_PI);
  const double b = random.uniform(0.0, 2.0 * M_PI);
  return Eigen::Quaterniond(std::sqrt(u) * std::cos(b), std::sqrt(1.0 - u) * std::sin(a),
                            std::sqrt(1.0 - u) * std::cos(a), std::sqrt(u) * std::sin(b))
      .toRotationMatrix();
}

AssetPtr make_taught_thing(Mesh mesh, bool has_colour) {
  if (!has_colour) mesh.texture.release();
  if (mesh.texture.empty()) mesh.uvs.clear();
  if (!has_colour) mesh.colours.assign(mesh.vertices.size(), cv::Vec3b(128, 128, 128));
  return make_asset("taught", std::move(mesh), 0.15F);
}

AssetPtr plainly_painted(const Asset& thing, Random& random) {
  Asset painted = thing;
  const cv::Scalar colour = hsv(random.uniform(0, 360), random.uniform(0.0, 0.8), random.uniform(0.15, 0.95));
  painted.mesh.colours.assign(thing.mesh.vertices.size(), cv::Vec3b(colour[0], colour[1], colour[2]));
  painted.specular = static_cast<float>(random.uniform(0.0, 0.3));
  return std::make_shared<const Asset>(std::move(painted));
}

MeshViews::MeshViews(Mesh mesh, const MeshViewSettings& settings, std::uint64_t seed)
    : settings_(settings), seed_(world_seed(DatasetSplit::kTraining, seed)) {
  const Eigen::AlignedBox3f bounds = mesh_bounds(mesh);
  centre_ = bounds.center().cast<double>();
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    radius_ = std::max(radius_, (vertex.cast<double>() - centre_).norm());
  thing_ = make_taught_thing(std::move(mesh), settings.has_colour);
  if (settings.attitudes == MeshAttitudes::kAny) {
    add_any_views();
  } else {
    ups_ = up_directions(thing_->mesh, settings.attitudes);
    add_level_views();
  }
}

void MeshViews::add_level_views() {
  const int each = std::min(settings_.views_per_attitude, settings_.max_views / static_cast<int>(ups_.size()));
  for (std::size_t attitude = 0; attitude < ups_.size(); ++attitude) {
    const Eigen::Matrix3d R_level_object =
        Eigen::Quaterniond::FromTwoVectors(ups_[attitude], Eigen::Vector3d::UnitZ()).toRotationMatrix();
    for (int i = 0; i < each; ++i) {
      Random random(aspect_seed(seed_, 1000000U * (attitude + 1U) + static_cast<std::uint64_t>(i)));
      // The directions are spread evenly over the part of the sphere between the two pitches by Fibonacci's spiral.
      const double low = std::sin(radians(settings_.lowest_pitch_deg));
      const double high = std::sin(radians(settings_.highest_pitch_deg));
      const double azimuth = i * M_PI * (3.0 - std::sqrt(5.0));
      ViewPose pose;
      pose.pitch_rad = std::asin(low + (high - low) * (i + 0.5) / each);
      pose.roll_rad = radians(kTiltDeviationDeg) * random.normal();
      const bool leans = settings_.attitudes == MeshAttitudes::kResting && chance(random, settings_.leaning_fraction);
      const double lean_deg = leans ? random.uniform(kMinLeanDeg, kMaxLeanDeg) : kTiltDeviationDeg * random.normal();
      pose.on_table = !leans;
      pose.R_level_object = tilt(radians(lean_deg), random) *
                            Eigen::AngleAxisd(azimuth, Eigen::Vector3d::UnitZ()).toRotationMatrix() * R_level_object;
      poses_.push_back(pose);
    }
  }
}

void MeshViews::add_any_views() {
  for (int i = 0; i < settings_.max_views; ++i) {
    Random random(aspect_seed(seed_, 1000000U + static_cast<std::uint64_t>(i)));
    ViewPose pose;
    pose.R_level_object = random_rotation(random);
    pose.pitch_rad = radians(random.uniform(settings_.lowest_pitch_deg, settings_.highest_pitch_deg));
    poses_.push_back(pose);
  }
}

TrainingView MeshViews::render(int index) const {
  const ViewPose& pose = poses_.at(static_cast<std::size_t>(index));
  const std::uint64_t view_seed = aspect_seed(seed_, 500U + static_cast<std::uint64_t>(index));
  Random random(aspect_seed(view_seed, 2));
  World world;
  set_lighting(world, chance(random, 0.25) ? TimeOfDay::kEvening : TimeOfDay::kDay, aspect_seed(view_seed, 3));
  world.focus_radius_m = std::max(0.3, 1.5 * radius_);
  PlacedAsset object{settings_.has_colour ? thing_ : plainly_painted(*thing_, random), Eigen::Isometry3d::Identity(), 1,
                     true};
  object.T_world_object.rotate(pose.R_level_object);
  object.T_world_object.translate(-centre_);
  world.items = {object};
  double lowest = 0.0;
  if (pose.on_table) {
    for (const Eigen::Vector3f& vertex : thing_->mesh.vertices)
      lowest = std::min(lowest, (object.T_world_object * vertex.cast<double>()).z());
    world.items.push_back(table_top(lowest, random));
  }

  const double distance = std::max(settings_.distance_m, 3.5 * radius_) * random.uniform(0.96, 1.04);
  const Eigen::Vector3d eye = distance * Eigen::Vector3d(0.0, -std::cos(pose.pitch_rad), std::sin(pose.pitch_rad));
  const Eigen::Isometry3d T_camera_world =
      Eigen::AngleAxisd(pose.roll_rad, Eigen::Vector3d::UnitZ()) * look_at(eye, Eigen::Vector3d::Zero());
  const Camera camera = cropped_around(thing_->mesh, T_camera_world * object.T_world_object);
  ShadedView shaded = shade_view(light_world(world), camera, T_camera_world);
  put_wall_behind(distance + random.uniform(2.0, 4.0) * radius_, random, shaded);

  TrainingView view;
  view.frame.camera = camera;
  view.frame.colour = simulate_colour_camera(shaded.radiance, world.photo, aspect_seed(view_seed, 4));
  view.frame.depth = measure_depth({shaded.geometry.depth, shaded.cos_incidence, shaded.reflectance, shaded.specular},
                                   camera, DepthSensorSettings{}, aspect_seed(view_seed, 5));
  view.mask = shaded.geometry.id == 1;
  view.T_camera_object = T_camera_world * object.T_world_object;
  if (pose.on_table)
    view.support = {T_camera_world.linear() * Eigen::Vector3d::UnitZ(), T_camera_world * Eigen::Vector3d(0, 0, lowest)};
  return view;
}

}  // namespace houghstream::world
