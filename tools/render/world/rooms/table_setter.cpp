#include "tools/render/world/rooms/table_setter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"
#include "tools/render/world/objects/objects.hpp"
#include "tools/render/world/rooms/leaning.hpp"

namespace houghstream::world {
namespace {

constexpr double kGapM = 0.006;
constexpr int kAttempts = 60;

std::array<Eigen::Vector2d, 4> corners(const Footprint& footprint) {
  const Eigen::Rotation2Dd rotation(footprint.yaw_rad);
  const Eigen::Vector2d& h = footprint.half;
  return {footprint.centre + rotation * Eigen::Vector2d(h.x(), h.y()),
          footprint.centre + rotation * Eigen::Vector2d(-h.x(), h.y()),
          footprint.centre + rotation * Eigen::Vector2d(-h.x(), -h.y()),
          footprint.centre + rotation * Eigen::Vector2d(h.x(), -h.y())};
}

// Returns whether an axis of `a` separates the two.
bool separated_by(const Footprint& a, const Footprint& b, double gap_m) {
  const Eigen::Rotation2Dd back(-a.yaw_rad);
  Eigen::AlignedBox2d extent;
  for (const Eigen::Vector2d& corner : corners(b)) extent.extend((back * (corner - a.centre)).eval());
  return (extent.min().array() > a.half.array() + gap_m).any() ||
         (extent.max().array() < -a.half.array() - gap_m).any();
}

// Returns the id for the ground truth, which does not name hard negatives.
int ground_truth_id(int id) {
  return id > kClassCount && id <= kTaughtObjectCount ? 0 : id;
}

}  // namespace

bool footprints_touch(const Footprint& a, const Footprint& b, double gap_m) {
  return !separated_by(a, b, gap_m) && !separated_by(b, a, gap_m);
}

bool TableLayout::on_table(const Footprint& footprint) const {
  const auto points = corners(footprint);
  return std::all_of(points.begin(), points.end(), [this](const Eigen::Vector2d& corner) {
    return (corner.cwiseAbs().array() <= table_half_.array() - 0.005).all();
  });
}

std::optional<Footprint> TableLayout::claim(const Eigen::Vector2d& half, const Eigen::AlignedBox2d& region,
                                            double angle_rad, Random& random) {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Footprint footprint;
    const double x = random.uniform(region.min().x(), region.max().x());
    const double y = random.uniform(region.min().y(), region.max().y());
    footprint.centre = {x, y};
    footprint.half = half;
    footprint.yaw_rad = random.uniform(-angle_rad, angle_rad);
    const auto touches = [&footprint](const Footprint& other) { return footprints_touch(footprint, other, kGapM); };
    if (!on_table(footprint) || std::any_of(taken_.begin(), taken_.end(), touches)) continue;
    taken_.push_back(footprint);
    return footprint;
  }
  return std::nullopt;
}

std::optional<Eigen::Isometry3d> TableLayout::place(const Asset& thing, const Eigen::AlignedBox2d& region,
                                                    double angle_rad, Random& random) {
  const Eigen::AlignedBox3d bounds = mesh_bounds(thing.mesh).cast<double>();
  const auto footprint = claim(0.5 * bounds.sizes().head<2>(), region, angle_rad, random);
  if (!footprint) return std::nullopt;
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  T_world_object.translate(Eigen::Vector3d(footprint->centre.x(), footprint->centre.y(), -bounds.min().z()));
  T_world_object.rotate(Eigen::AngleAxisd(footprint->yaw_rad, Eigen::Vector3d::UnitZ()));
  return T_world_object;
}

bool TableSetter::stand(const AssetPtr& thing, const Eigen::AlignedBox2d& region, double angle_rad, int object_id) {
  const auto T_world_object = layout_.place(*thing, region, angle_rad, random_);
  if (T_world_object) world_.items.push_back({thing, *T_world_object, object_id, true});
  return T_world_object.has_value();
}

bool TableSetter::put(const AssetGroup& group, const Eigen::AlignedBox2d& region) {
  const auto footprint = layout_.claim(half_extent(group), region, M_PI, random_);
  if (!footprint) return false;
  Eigen::Isometry3d T_world_group = Eigen::Isometry3d::Identity();
  T_world_group.translate(Eigen::Vector3d(footprint->centre.x(), footprint->centre.y(), 0.0));
  T_world_group.rotate(Eigen::AngleAxisd(footprint->yaw_rad, Eigen::Vector3d::UnitZ()));
  for (PlacedAsset placed : group) {
    placed.T_world_object = T_world_group * placed.T_world_object;
    world_.items.push_back(placed);
  }
  return true;
}

void TableSetter::stand_object(int id, const Eigen::AlignedBox2d& where) {
  const TaughtObject object = make_taught_object(id);
  require(stand(object.thing, where, M_PI, ground_truth_id(id)), "scene: no place left for {}", object.name);
}

void TableSetter::lay_object(int id, const Eigen::AlignedBox2d& where) {
  const TaughtObject object = make_taught_object(id);
  require(put(put_lying(object.thing, ground_truth_id(id), random_), where), "scene: no place left for {}",
          object.name);
}

void TableSetter::tilt_object(int id, const Eigen::AlignedBox2d& where) {
  const TaughtObject object = make_taught_object(id);
  require(put(put_on_wedge(object.thing, ground_truth_id(id), random_), where), "scene: no place left for {}",
          object.name);
}

void TableSetter::lean_object(int id, const Eigen::AlignedBox2d& where) {
  const TaughtObject object = make_taught_object(id);
  require(put(put_leaning(object.thing, ground_truth_id(id), random_), where), "scene: no place left for {}",
          object.name);
}

void TableSetter::hold_object(int id, const HeldPlace& place) {
  for (const PlacedAsset& placed : hold(make_taught_object(id).thing, ground_truth_id(id), place, random_)) {
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
