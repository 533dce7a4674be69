#include "tools/render/world/calibration_scenes.hpp"

#include <algorithm>
#include <cmath>

#include "tools/render/world/objects/objects.hpp"
#include "tools/render/world/objects/pixel_noise.hpp"
#include "tools/render/world/objects/seeds.hpp"
#include "tools/render/world/objects/shape_variants.hpp"
#include "tools/render/world/optics/light.hpp"
#include "tools/render/world/rooms/attitudes.hpp"
#include "tools/render/world/rooms/room.hpp"
#include "tools/render/world/rooms/table_setter.hpp"

namespace houghstream::world {
namespace {

constexpr std::uint64_t kFirstRoom = 1ULL << 44U;  // number of training worlds, far beyond those of other uses
constexpr int kMaxDistractors = 12;
constexpr int kMaxLookAlikes = 3;
constexpr double kTaughtColours = 0.3;  // share of the distractors' surfaces

/// Returns the centre of its bounding box, object frame.
Eigen::Vector3d middle_of(const Asset& thing) {
  return mesh_bounds(thing.mesh).center().cast<double>();
}

/// Puts the object on the table in one of its attitudes, sometimes leaning. The middle of its box is above the group's
/// origin, wherever its own origin lies, since the place on the table is reserved about that.
AssetGroup put_down(const CalibrationSceneObject& object, const AssetPtr& thing, int id, Random& random) {
  constexpr double kLeaning = 0.2;
  Eigen::Matrix3d R = random_rotation(random);
  if (!object.ups.empty()) {
    R = Eigen::Quaterniond::FromTwoVectors(pick(random, object.ups), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    if (object.ups.size() > 1 && chance(random, kLeaning)) {
      const double towards = random.uniform(0.0, 2.0 * M_PI);
      const Eigen::Vector3d axis(std::cos(towards), std::sin(towards), 0.0);
      R = Eigen::AngleAxisd(random.uniform(0.15, 0.7), axis) * R;
    }
  }
  PlacedAsset placed{thing, Eigen::Isometry3d::Identity(), id, true};
  const Eigen::Vector3d beside = R * middle_of(*thing);
  placed.T_world_object.translate(Eigen::Vector3d(-beside.x(), -beside.y(), height_above_table(thing->mesh, R)));
  placed.T_world_object.rotate(R);
  return {placed};
}

/// Draws a camera with the field of view of any camera in use: 33 to 67 degrees wide.
Camera draw_camera(Random& random) {
  Camera camera = synthetic_camera();
  camera.fx = std::exp(random.uniform(std::log(480.0), std::log(1080.0)));
  camera.fy = camera.fx;
  return camera;
}

/// Draws the pose of a camera that looks at one of the objects, from anywhere above the table.
Eigen::Isometry3d draw_viewpoint(const World& world, Random& random) {
  std::vector<Eigen::Vector3d> places;
  for (const PlacedAsset& item : world.items) {
    if (item.object_id != 0) places.push_back(item.T_world_object * middle_of(*item.thing));
  }
  Eigen::Vector3d target = places.empty() ? Eigen::Vector3d(0.0, 0.0, 0.05) : pick(random, places);
  target += Eigen::Vector3d(random.uniform(-0.2, 0.2), random.uniform(-0.15, 0.15), random.uniform(-0.05, 0.1));
  // A narrower view is used from farther away, and yet shows everything larger.
  const double narrower = std::pow(world.camera.fx / synthetic_camera().fx, 0.4);
  const double distance = narrower * std::exp(random.uniform(std::log(0.5), std::log(1.8)));
  const double elevation = random.uniform(0.22, 1.25);
  const double azimuth = random.uniform(-0.9, 0.9);
  const Eigen::Vector3d eye =
      target + distance * Eigen::Vector3d(std::sin(azimuth) * std::cos(elevation),
                                          -std::cos(azimuth) * std::cos(elevation), std::sin(elevation));
  const double roll = 0.08 * random.normal();
  return Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()) * look_at(eye, target);
}

int draw_calibrated(const std::vector<CalibrationSceneObject>& objects, Random& random) {
  std::vector<int> calibrated;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].is_calibrated) calibrated.push_back(static_cast<int>(i));
  }
  return pick(random, calibrated);
}

}  // namespace

World CalibrationScenes::make_furnished_world(int room) const {
  const std::uint64_t scene_seed =
      aspect_seed(world_seed(DatasetSplit::kTraining, kFirstRoom + static_cast<std::uint64_t>(room)), seed_);
  World world;
  Room walls = make_room(static_cast<RoomStyle>(room % kRoomStyles), aspect_seed(scene_seed, 1));
  world.items = std::move(walls.items);
  set_lighting(world, room % 3 == 2 ? TimeOfDay::kEvening : TimeOfDay::kDay, aspect_seed(scene_seed, 2));
  Random lens(aspect_seed(scene_seed, 4));
  world.camera = settings_.camera ? *settings_.camera : draw_camera(lens);
  TableSetter setter(world, walls.table_half, aspect_seed(scene_seed, 3));
  Random& random = setter.random();
  const double reach = random.uniform(settings_.min_reach, settings_.max_reach);
  const Eigen::AlignedBox2d middle = setter.region(-reach, reach, -reach, 0.8 * reach);
  const Eigen::AlignedBox2d all = setter.region(-0.95, 0.95, -0.95, 0.95);
  const int first = draw_calibrated(objects_, random);
  const int count =
      std::min(static_cast<int>(objects_.size()), random.between(settings_.min_objects, settings_.max_objects));
  for (int i = 0; i < count; ++i) {
    const CalibrationSceneObject& object = objects_[static_cast<std::size_t>(first + i) % objects_.size()];
    const AssetPtr painted = object.has_colour ? object.thing : plainly_painted(*object.thing, random);
    Random shape(aspect_seed(scene_seed, 50U + static_cast<std::uint64_t>(i)));
    const AssetPtr instance = settings_.varies_instances ? make_instance_variant(*painted, shape) : painted;
    setter.put(put_down(object, instance, object.id, random), middle);
  }
  // The hard negatives are at most about half as many as the objects.
  const int max_look_alikes = std::min(kMaxLookAlikes, (count + 1) / 2);
  for (int i = random.between(0, max_look_alikes); i > 0; --i) {
    const CalibrationSceneObject& object = pick(random, objects_);
    setter.put(put_down(object, make_hard_negative(*object.thing, random), 0, random), all);
  }
  for (int i = random.between(3, kMaxDistractors); i > 0; --i) {
    const int kind = random.below(kDistractorKinds);
    setter.stand(make_distractor(kind, aspect_seed(scene_seed, 100U + static_cast<std::uint64_t>(i)), kTaughtColours),
                 all, M_PI, 0);
  }
  return world;
}

std::vector<RenderedFrame> CalibrationScenes::render(int room) const {
  const LitWorld lit_world = light_world(make_furnished_world(room));  // takes as long as a frame
  std::vector<RenderedFrame> frames(static_cast<std::size_t>(settings_.frames));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::uint64_t index = frames.size() * static_cast<std::uint64_t>(room) + i;
    const std::uint64_t scene_seed = aspect_seed(world_seed(DatasetSplit::kTraining, seed_), kFirstRoom + index);
    Random random(scene_seed);
    frames[i] = render_frame(lit_world, draw_viewpoint(lit_world.world, random), aspect_seed(scene_seed, 1));
  }
  return frames;
}

}  // namespace houghstream::world
