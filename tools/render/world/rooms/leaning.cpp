#include "tools/render/world/rooms/leaning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"
#include "tools/render/world/objects/pixel_noise.hpp"
#include "tools/render/world/rooms/attitudes.hpp"
#include "tools/render/world/rooms/tipping.hpp"

namespace houghstream::world {
namespace {

constexpr double kReserveM = 0.004;  // margin by which the centre of mass lies inside the support
constexpr double kMinHeightM = 0.008;
constexpr double kMaxHeightM = 0.22;

/// Gives a tilted asset, its lowest point at z = 0, and the block that it leans on towards +x.
struct Leaning {
  double edge_m = 0.0;    ///< x of the block's near side
  double height_m = 0.0;  ///< height of the block
};

/// Returns the maximum towards +x that the mesh reaches up to that height.
double reach_below(const Mesh& mesh, const std::vector<Eigen::Vector3d>& points, double height_m) {
  double farthest = -std::numeric_limits<double>::infinity();
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d& a = points[triangle[i]];
      const Eigen::Vector3d& b = points[triangle[(i + 1) % 3]];
      if (a.z() <= height_m) farthest = std::max(farthest, a.x());
      if ((a.z() < height_m) == (b.z() < height_m)) continue;
      farthest = std::max(farthest, a.x() + (b.x() - a.x()) * (height_m - a.z()) / (b.z() - a.z()));
    }
  }
  return farthest;
}

std::optional<Leaning> lean(const Mesh& mesh, const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& centre,
                            Random& random) {
  const auto farthest =
      std::max_element(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x() < b.x(); });
  const double height_m = random.uniform(0.4, 0.95) * farthest->z();
  if (height_m < kMinHeightM || height_m > kMaxHeightM) return std::nullopt;
  const double edge_m = reach_below(mesh, points, height_m);
  if (centre.x() > edge_m - kReserveM) return std::nullopt;  // it would fall over the block
  return Leaning{edge_m, height_m};
}

PlacedAsset make_block(const Leaning& leaning, const Eigen::AlignedBox3d& object, Random& random) {
  const double thick = random.uniform(0.03, 0.09);
  const double beside = random.uniform(0.0, 0.03);
  const Eigen::Vector3d size(thick, object.sizes().y() + beside, leaning.height_m);
  const cv::Mat cover =
      chance(random, 0.4)
          ? wood({256, 256}, random)
          : plain({256, 256}, hsv(random.uniform(0, 360), random.uniform(0.1, 0.7), random.uniform(0.3, 0.9)), 0.05,
                  random);
  PlacedAsset block{make_asset("block", finish_object(box(size, cover)), 0.1F), Eigen::Isometry3d::Identity(), 0, true};
  block.T_world_object.translation() << leaning.edge_m + 0.5 * size.x() + 1e-5, object.center().y(), 0.5 * size.z();
  return block;
}

/// Returns the group moved to its middle.
AssetGroup centred(AssetGroup group) {
  Eigen::AlignedBox2d extent;
  for (const PlacedAsset& placed : group) {
    for (const Eigen::Vector3f& vertex : placed.thing->mesh.vertices) {
      extent.extend((placed.T_world_object * vertex.cast<double>()).head<2>().eval());
    }
  }
  const Eigen::Vector3d to_middle(-extent.center().x(), -extent.center().y(), 0.0);
  for (PlacedAsset& placed : group) placed.T_world_object = Eigen::Translation3d(to_middle) * placed.T_world_object;
  return group;
}

}  // namespace

AssetGroup put_leaning(const AssetPtr& thing, int object_id, Random& random) {
  constexpr int kTries = 400;
  const Mesh& mesh = thing->mesh;
  const AttitudeChoice choice(mesh);
  const Eigen::Vector3d centre_of_mass = TippingBody(mesh).centre_of_mass();
  const bool upright = chance(random, 0.5);
  for (int i = 0; i < kTries; ++i) {
    const Attitude attitude = upright ? Attitude::kUpright : Attitude::kLying;
    const Eigen::Matrix3d R_rest = choice.R_table_object(attitude, random.below(1 << 20), random);
    const double slant_rad = random.uniform(kMinLeanDeg, kMaxLeanDeg) * M_PI / 180.0;
    const double towards = random.uniform(-M_PI, M_PI);
    // Either over its lower edge towards the block, or back onto its base, one end of which lies on the block.
    const double sign = chance(random, 0.5) ? 1.0 : -1.0;
    PlacedAsset placed{thing, Eigen::Isometry3d::Identity(), object_id, true};
    placed.T_world_object.linear() = Eigen::AngleAxisd(sign * slant_rad, Eigen::Vector3d::UnitY()) *
                                     Eigen::AngleAxisd(towards, Eigen::Vector3d::UnitZ()) * R_rest;
    placed.T_world_object.translation().z() = height_above_table(mesh, placed.T_world_object.linear());
    std::vector<Eigen::Vector3d> points;
    points.reserve(mesh.vertices.size());
    for (const Eigen::Vector3f& vertex : mesh.vertices) points.push_back(placed.T_world_object * vertex.cast<double>());
    const Eigen::Vector3d centre = placed.T_world_object * centre_of_mass;
    const auto lowest =
        std::min_element(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.z() < b.z(); });
    if (centre.x() < lowest->x() + kReserveM) continue;  // it would fall to the other side
    const std::optional<Leaning> leaning = lean(mesh, points, centre, random);
    if (!leaning) continue;
    Eigen::AlignedBox3d extent;
    for (const Eigen::Vector3d& point : points) extent.extend(point);
    return centred({make_block(*leaning, extent, random), placed});
  }
  fail("{}: no attitude in which it leans on something, after {} tries", thing->name, kTries);
}

}  // namespace houghstream::world
