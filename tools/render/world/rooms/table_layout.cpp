#include "tools/render/world/rooms/table_layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/render/world/objects/mesh_parts.hpp"

namespace houghstream::world {
namespace {

constexpr double kGapM = 0.006;
constexpr int kAttempts = 60;

std::array<Eigen::Vector2d, 4> corners(const Footprint& footprint) {
  const Eigen::Rotation2Dd turn(footprint.yaw_rad);
  const Eigen::Vector2d& h = footprint.half;
  return {footprint.centre + turn * Eigen::Vector2d(h.x(), h.y()),
          footprint.centre + turn * Eigen::Vector2d(-h.x(), h.y()),
          footprint.centre + turn * Eigen::Vector2d(-h.x(), -h.y()),
          footprint.centre + turn * Eigen::Vector2d(h.x(), -h.y())};
}

// Whether an axis of `a` separates the two.
bool separated_by(const Footprint& a, const Footprint& b, double gap_m) {
  const Eigen::Rotation2Dd back(-a.yaw_rad);
  Eigen::AlignedBox2d extent;
  for (const Eigen::Vector2d& corner : corners(b)) extent.extend((back * (corner - a.centre)).eval());
  return (extent.min().array() > a.half.array() + gap_m).any() ||
         (extent.max().array() < -a.half.array() - gap_m).any();
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
                                            double turn_rad, Random& random) {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Footprint footprint;
    const double x = random.uniform(region.min().x(), region.max().x());
    const double y = random.uniform(region.min().y(), region.max().y());
    footprint.centre = {x, y};
    footprint.half = half;
    footprint.yaw_rad = random.uniform(-turn_rad, turn_rad);
    const auto touches = [&footprint](const Footprint& other) { return footprints_touch(footprint, other, kGapM); };
    if (!on_table(footprint) || std::any_of(taken_.begin(), taken_.end(), touches)) continue;
    taken_.push_back(footprint);
    return footprint;
  }
  return std::nullopt;
}

std::optional<Eigen::Isometry3d> TableLayout::place(const Thing& thing, const Eigen::AlignedBox2d& region,
                                                    double turn_rad, Random& random) {
  const Eigen::AlignedBox3d bounds = mesh_bounds(thing.mesh).cast<double>();
  const auto footprint = claim(0.5 * bounds.sizes().head<2>(), region, turn_rad, random);
  if (!footprint) return std::nullopt;
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  T_world_object.translate(Eigen::Vector3d(footprint->centre.x(), footprint->centre.y(), -bounds.min().z()));
  T_world_object.rotate(Eigen::AngleAxisd(footprint->yaw_rad, Eigen::Vector3d::UnitZ()));
  return T_world_object;
}

}  // namespace houghstream::world
