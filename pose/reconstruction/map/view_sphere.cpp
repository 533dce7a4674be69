#include "pose/reconstruction/map/view_sphere.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace houghstream::reconstruction {
namespace {

/// Returns the name of a part of the sphere, for a person.
const char* part_of(const Eigen::Vector3d& direction, const Eigen::Vector3d& front) {
  constexpr double kPi = 3.14159265358979323846;
  if (direction.z() > 0.75) return "above";
  if (direction.z() < -0.75) return "below";
  if (direction.z() < -0.2) return "low";
  double angle = std::atan2(direction.y(), direction.x()) - std::atan2(front.y(), front.x());
  angle = std::remainder(angle, 2.0 * kPi);
  if (std::abs(angle) < kPi / 4) return "in front";
  if (std::abs(angle) > 3 * kPi / 4) return "behind";
  return angle > 0.0 ? "the right" : "the left";
}

}  // namespace

const std::array<Eigen::Vector3d, kSphereDirections>& view_directions() {
  static const std::array<Eigen::Vector3d, kSphereDirections> directions = [] {
    std::array<Eigen::Vector3d, kSphereDirections> made;
    const double golden = 2.39996322972865332;
    for (int i = 0; i < kSphereDirections; ++i) {
      const double z = 1.0 - (2.0 * i + 1.0) / kSphereDirections;
      const double flat = std::sqrt(1.0 - z * z);
      made[static_cast<std::size_t>(i)] = {flat * std::cos(golden * i), flat * std::sin(golden * i), z};
    }
    return made;
  }();
  return directions;
}

void mark_covered(const Eigen::Vector3d& towards_camera, ViewCoverage& coverage) {
  constexpr double kCosine = 0.6428;  // cosine of 50 degrees
  const Eigen::Vector3d unit = towards_camera.normalized();
  const auto& directions = view_directions();
  for (std::size_t i = 0; i < directions.size(); ++i) coverage[i] = coverage[i] || directions[i].dot(unit) > kCosine;
}

int count_covered(const ViewCoverage& coverage) {
  return static_cast<int>(std::count(coverage.begin(), coverage.end(), true));
}

std::string describe_coverage(const ViewCoverage& coverage, const Eigen::Vector3d& front) {
  std::string text = fmt::format("seen from {} of {} directions", count_covered(coverage), kSphereDirections);
  std::vector<std::string> missing;
  const auto& directions = view_directions();
  for (const char* part : {"in front", "the right", "behind", "the left", "above", "low", "below"}) {
    bool any = false;
    for (std::size_t i = 0; i < directions.size(); ++i)
      any = any || (coverage[i] && std::string(part_of(directions[i], front)) == part);
    if (!any) missing.emplace_back(part);
  }
  if (missing.empty()) return text;
  text += "; from ";
  for (std::size_t i = 0; i < missing.size(); ++i)
    text += (i == 0 ? "" : i + 1 == missing.size() ? " and from " : ", from ") + missing[i];
  return text + " nothing yet";
}

}  // namespace houghstream::reconstruction
