#include "tools/render/world/rooms/stable_poses.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/rooms/tipping.hpp"

namespace houghstream::world {
namespace {

constexpr int kDrops = 400;  // attitudes from which it is let go
constexpr double kMinSlopeRad = 1.0 * M_PI / 180.0;
constexpr double kSame = 0.9998;       // cosine between two directions that are one: 1.1 degrees
constexpr double kSameHeightM = 5e-4;  // height of the centre of mass, within a family
constexpr double kSameUpright = 0.03;  // cosine between down and the object's z axis, within a family

/// Returns directions evenly spread over the sphere (Fibonacci's spiral).
Eigen::Vector3d spread_direction(int index, int count) {
  const double z = 1.0 - (2.0 * index + 1.0) / count;
  const double angle = index * M_PI * (3.0 - std::sqrt(5.0));
  const double radius = std::sqrt(1.0 - z * z);
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

// Returns the shortest rotation that brings `down` to -z; an upside-down object is rotated over its x axis first.
Eigen::Matrix3d face_down(Eigen::Vector3d down) {
  Eigen::Matrix3d over = Eigen::Matrix3d::Identity();
  if (down.z() > 0.0) over.diagonal() = Eigen::Vector3d(1.0, -1.0, -1.0);
  down = over * down;
  return Eigen::Quaterniond::FromTwoVectors(down, -Eigen::Vector3d::UnitZ()).toRotationMatrix() * over;
}

StablePose attitude_of(const TippingBody& body, const Eigen::Vector3d& down, double nearly_m) {
  const Support support = body.support(down);
  StablePose attitude;
  attitude.R_table_object = face_down(down);
  attitude.centre_height_m = support.height_m;
  attitude.origin_height_m = support.height_m + down.dot(body.centre_of_mass());
  attitude.margin_m = nearly_m > 0.0 ? body.support(down, nearly_m).margin_m() : support.margin_m();
  return attitude;
}

/// Returns the object's upward direction at rest, in the object frame.
Eigen::Vector3d up_of(const StablePose& attitude) {
  return attitude.R_table_object.row(2);
}

bool akin(const StablePose& a, const StablePose& b) {
  return std::abs(a.centre_height_m - b.centre_height_m) < kSameHeightM &&
         std::abs(up_of(a).z() - up_of(b).z()) < kSameUpright;
}

void add_to_family(const StablePose& attitude, std::vector<StablePoseFamily>& families) {
  const auto own = std::find_if(families.begin(), families.end(),
                                [&](const StablePoseFamily& family) { return akin(family.front(), attitude); });
  if (own == families.end()) {
    families.push_back({attitude});
    return;
  }
  const bool known = std::any_of(own->begin(), own->end(),
                                 [&](const StablePose& other) { return up_of(other).dot(up_of(attitude)) > kSame; });
  if (!known) own->push_back(attitude);
}

}  // namespace

double StablePose::steepest_slope_rad() const {
  return std::atan2(margin_m, centre_height_m);
}

std::vector<StablePoseFamily> find_stable_poses(const Mesh& mesh, double nearly_m) {
  const TippingBody body(mesh);
  std::vector<StablePoseFamily> families;
  for (int i = 0; i < kDrops; ++i) {
    const StablePose attitude = attitude_of(body, body.settled(spread_direction(i, kDrops)), nearly_m);
    if (attitude.steepest_slope_rad() >= kMinSlopeRad) add_to_family(attitude, families);
  }
  return families;
}

std::vector<StablePoseFamily> lying_families(const std::vector<StablePoseFamily>& families) {
  std::vector<StablePoseFamily> lying;
  std::copy_if(families.begin(), families.end(), std::back_inserter(lying),
               [](const StablePoseFamily& family) { return up_of(family.front()).z() < kSame; });
  require(!lying.empty(), "resting attitudes: {} families, expected one that does not stand upright", families.size());
  return lying;
}

}  // namespace houghstream::world
