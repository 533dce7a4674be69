#include "tools/render/world/rooms/attitudes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/base/checks.hpp"

namespace houghstream::world {

Attitude parse_attitude(const std::string& name) {
  if (name == "upright") return Attitude::kUpright;
  if (name == "tilted") return Attitude::kTilted;
  if (name == "lying") return Attitude::kLying;
  fail("attitude \"{}\": expected one of upright, tilted, lying", name);
}

AttitudeChoice::AttitudeChoice(const Mesh& mesh) {
  for (const StablePoseFamily& family : lying_families(find_stable_poses(mesh)))
    turns_.insert(turns_.end(), family.size() > 1 ? 2 : 1, family);
}

Eigen::Matrix3d AttitudeChoice::lying(int index, Random& random) const {
  const StablePoseFamily& family = turns_[static_cast<std::size_t>(index) % turns_.size()];
  return family[static_cast<std::size_t>(random.below(static_cast<int>(family.size())))].R_table_object;
}

Eigen::Matrix3d AttitudeChoice::R_table_object(Attitude attitude, int index, Random& random) const {
  if (attitude == Attitude::kUpright) return Eigen::Matrix3d::Identity();
  if (attitude == Attitude::kLying) return lying(index, random);
  const bool upright = index % 2 == 0;
  const Eigen::Matrix3d R_level_object = upright ? Eigen::Matrix3d::Identity() : lying(index / 2, random);
  const double slant_rad = random.uniform(kMinTiltDeg, kMaxTiltDeg) * M_PI / 180.0;
  const double towards = random.uniform(0.0, 2.0 * M_PI);
  const Eigen::Vector3d axis(std::cos(towards), std::sin(towards), 0.0);
  return Eigen::AngleAxisd(slant_rad, axis) * R_level_object;
}

double height_above_table(const Mesh& mesh, const Eigen::Matrix3d& R_table_object) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    lowest = std::min(lowest, R_table_object.row(2).dot(vertex.cast<double>()));
  return -lowest;
}

}  // namespace houghstream::world
