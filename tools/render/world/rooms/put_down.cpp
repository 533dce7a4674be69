#include "tools/render/world/rooms/put_down.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"
#include "tools/render/world/rooms/attitudes.hpp"

namespace houghstream::world {
namespace {

constexpr double kMinSlopeDeg = 12.0;
constexpr double kMaxSlopeDeg = 20.0;
constexpr double kReserveRad = 0.02;  // margin over the angle that the slope requires
constexpr double kThinEndM = 0.004;
constexpr double kBesideM = 0.015;  // width of the wedge beyond the asset, on each side

double radians(double degrees) {
  return degrees * M_PI / 180.0;
}

// An attitude that stays on the slope; first the family, since a can has many sides and two ends.
StablePose steady_attitude(const Asset& thing, double slope_rad, Random& random) {
  std::vector<StablePoseFamily> steady;
  for (const StablePoseFamily& family : find_stable_poses(thing.mesh)) {
    if (family.front().steepest_slope_rad() >= slope_rad + kReserveRad) steady.push_back(family);
  }
  require(!steady.empty(), "{}: no attitude that stays on a slope of {:.2f} rad", thing.name, slope_rad);
  const StablePoseFamily& family = steady[static_cast<std::size_t>(random.below(static_cast<int>(steady.size())))];
  return family[static_cast<std::size_t>(random.below(static_cast<int>(family.size())))];
}

PlacedAsset on_plane(const AssetPtr& thing, int object_id, const Eigen::Matrix3d& R_plane_object) {
  PlacedAsset placed{thing, Eigen::Isometry3d::Identity(), object_id, true};
  placed.T_world_object.translate(Eigen::Vector3d(0, 0, height_above_table(thing->mesh, R_plane_object)));
  placed.T_world_object.rotate(R_plane_object);
  return placed;
}

// Rises towards +x; `half`: what its upper side holds, along the slope and across it.
AssetPtr make_wedge(const Eigen::Vector2d& half, double slope_rad, Random& random) {
  const double x = half.x() * std::cos(slope_rad);
  const double rise = 2.0 * half.x() * std::sin(slope_rad);
  const cv::Mat cover =
      plain({256, 256}, hsv(random.uniform(0, 360), random.uniform(0.1, 0.5), random.uniform(0.3, 0.8)), 0.05, random);
  const Mesh mesh = prism({{-x, 0}, {x, 0}, {x, kThinEndM + rise}, {-x, kThinEndM}}, 2.0 * half.y(), cover, cover);
  return make_asset("wedge", finish_object(mesh), 0.1F);
}

}  // namespace

AssetGroup put_lying(const AssetPtr& thing, int object_id, Random& random) {
  const int index = random.below(1 << 20);
  return {on_plane(thing, object_id, AttitudeChoice(thing->mesh).R_table_object(Attitude::kLying, index, random))};
}

AssetGroup put_on_wedge(const AssetPtr& thing, int object_id, Random& random) {
  const double slope_rad = radians(random.uniform(kMinSlopeDeg, kMaxSlopeDeg));
  const StablePose attitude = steady_attitude(*thing, slope_rad, random);
  const Eigen::AngleAxisd rotation(random.uniform(-M_PI, M_PI), Eigen::Vector3d::UnitZ());
  PlacedAsset placed = on_plane(thing, object_id, rotation * attitude.R_table_object);
  const Eigen::Vector2d half = half_extent({placed}) + Eigen::Vector2d::Constant(kBesideM);
  PlacedAsset wedge{make_wedge(half, slope_rad, random), Eigen::Isometry3d::Identity(), 0, true};
  const double middle_height = kThinEndM + half.x() * std::sin(slope_rad);
  wedge.T_world_object.translate(Eigen::Vector3d(0, 0, 0.5 * mesh_bounds(wedge.thing->mesh).sizes().z()));
  placed.T_world_object = Eigen::Translation3d(0, 0, middle_height) *
                          Eigen::AngleAxisd(-slope_rad, Eigen::Vector3d::UnitY()) * placed.T_world_object;
  return {wedge, placed};
}

Eigen::Vector2d half_extent(const AssetGroup& group) {
  Eigen::Vector2d half = Eigen::Vector2d::Zero();
  for (const PlacedAsset& placed : group) {
    for (const Eigen::Vector3f& vertex : placed.thing->mesh.vertices) {
      const Eigen::Vector3d point = placed.T_world_object * vertex.cast<double>();
      half = half.cwiseMax(point.head<2>().cwiseAbs());
    }
  }
  return half;
}

}  // namespace houghstream::world
