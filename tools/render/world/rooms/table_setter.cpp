#include "tools/render/world/rooms/table_setter.hpp"

#include <cmath>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/objects.hpp"
#include "tools/render/world/rooms/leaning.hpp"

namespace houghstream::world {
namespace {

// The truth does not name look-alikes.
int true_id(int id) {
  return id > kClassCount && id <= kTaughtObjectCount ? 0 : id;
}

}  // namespace

bool TableSetter::stand(const ThingPtr& thing, const Eigen::AlignedBox2d& region, double turn_rad, int object_id) {
  const auto T_world_object = layout_.place(*thing, region, turn_rad, random_);
  if (T_world_object) world_.items.push_back({thing, *T_world_object, object_id, true});
  return T_world_object.has_value();
}

bool TableSetter::put(const Group& group, const Eigen::AlignedBox2d& region) {
  const auto footprint = layout_.claim(half_extent(group), region, M_PI, random_);
  if (!footprint) return false;
  Eigen::Isometry3d T_world_group = Eigen::Isometry3d::Identity();
  T_world_group.translate(Eigen::Vector3d(footprint->centre.x(), footprint->centre.y(), 0.0));
  T_world_group.rotate(Eigen::AngleAxisd(footprint->yaw_rad, Eigen::Vector3d::UnitZ()));
  for (Placed placed : group) {
    placed.T_world_object = T_world_group * placed.T_world_object;
    world_.items.push_back(placed);
  }
  return true;
}

void TableSetter::stand_object(int id, const Eigen::AlignedBox2d& where) {
  const TaughtObject object = make_taught_object(id);
  require(stand(object.thing, where, M_PI, true_id(id)), "scene: no place left for {}", object.name);
}

void TableSetter::lay_object(int id, const Eigen::AlignedBox2d& where) {
  const TaughtObject object = make_taught_object(id);
  require(put(put_lying(object.thing, true_id(id), random_), where), "scene: no place left for {}", object.name);
}

void TableSetter::tilt_object(int id, const Eigen::AlignedBox2d& where) {
  const TaughtObject object = make_taught_object(id);
  require(put(put_on_wedge(object.thing, true_id(id), random_), where), "scene: no place left for {}", object.name);
}

void TableSetter::lean_object(int id, const Eigen::AlignedBox2d& where) {
  const TaughtObject object = make_taught_object(id);
  require(put(put_leaning(object.thing, true_id(id), random_), where), "scene: no place left for {}", object.name);
}

void TableSetter::hold_object(int id, const HeldPlace& place) {
  for (const Placed& placed : hold(make_taught_object(id).thing, true_id(id), place, random_)) {
    const Eigen::Vector3d towards = placed.T_world_object.linear().col(0);
    Footprint footprint;
    footprint.yaw_rad = std::atan2(towards.y(), towards.x());
    const Eigen::Rotation2Dd back(-footprint.yaw_rad);
    Eigen::AlignedBox2d extent;
    for (const Eigen::Vector3f& vertex : placed.thing->mesh.vertices) {
      extent.extend((back * (placed.T_world_object * vertex.cast<double>()).head<2>()).eval());
    }
    footprint.half = 0.5 * extent.sizes();
    footprint.centre = Eigen::Rotation2Dd(footprint.yaw_rad) * extent.center();
    layout_.take(footprint);
    world_.items.push_back(placed);
  }
}

}  // namespace houghstream::world
