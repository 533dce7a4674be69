#include "tools/render/world/rooms/tipping.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "pipeline/base/checks.hpp"

namespace houghstream::world {
namespace {

constexpr double kTouchM = 2e-5;  // above the lowest point and yet on the plane: vertices are floats
constexpr double kRollM = 3e-4;   // an edge that raises the centre of mass by less is part of a round surface
constexpr double kLowerM = 5e-6;
constexpr int kMaxSteps = 2000;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Computes the hull by Andrew's monotone chain: counter-clockwise, without points on the sides.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return std::tuple(a.x(), a.y()) < std::tuple(b.x(), b.y()); });
  std::vector<Eigen::Vector2d> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Eigen::Vector2d& point : points) {
      while (hull.size() >= start + 2 &&
             cross(hull.back() - hull[hull.size() - 2], point - hull[hull.size() - 2]) <= kTouchM * kTouchM)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();  // it begins the other half
    std::reverse(points.begin(), points.end());
  }
  return hull.empty() ? std::vector<Eigen::Vector2d>{points.front()} : hull;
}

/// Returns the point between a and b that is nearest to the origin.
Eigen::Vector2d nearest_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d side = b - a;
  const double length_sq = side.squaredNorm();
  const double fraction = length_sq > 0.0 ? std::clamp(-a.dot(side) / length_sq, 0.0, 1.0) : 0.0;
  return a + fraction * side;
}

Eigen::Vector2d nearest_on_border(const std::vector<Eigen::Vector2d>& corners) {
  Eigen::Vector2d nearest = corners.front();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d point = nearest_between(corners[i], corners[(i + 1) % corners.size()]);
    if (point.norm() < nearest.norm()) nearest = point;
  }
  return nearest;
}

/// Returns the direction from the pivot towards the centre of mass's foot; for a body balanced on an edge or a point, a
/// direction to one side of it.
Eigen::Vector2d falls_towards(const std::vector<Eigen::Vector2d>& corners, const Eigen::Vector2d& pivot) {
  if (pivot.norm() > 1e-9) return -pivot.normalized();
  const Eigen::Vector2d edge = corners.back() - corners.front();
  return edge.norm() > 0.0 ? Eigen::Vector2d(edge.y(), -edge.x()).normalized() : Eigen::Vector2d::UnitX();
}

}  // namespace

double Support::margin_m() const {
  double inside = corners.size() < 3 ? 0.0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size() && corners.size() >= 3; ++i) {
    const Eigen::Vector2d& from = corners[i];
    inside = std::min(inside, cross((corners[(i + 1) % corners.size()] - from).normalized(), -from));
  }
  return inside > 0.0 ? inside : -nearest_on_border(corners).norm();
}

TippingBody::TippingBody(const Mesh& mesh) {
  double volume = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d pa = mesh.vertices[a].cast<double>();
    const Eigen::Vector3d pb = mesh.vertices[b].cast<double>();
    const Eigen::Vector3d pc = mesh.vertices[c].cast<double>();
    const double part = pa.dot(pb.cross(pc)) / 6.0;  // tetrahedron with the origin
    volume += part;
    centre_of_mass_ += 0.25 * part * (pa + pb + pc);
  }
  require(volume > 0.0, "mesh encloses {} cubic metres, expected more than none", volume);
  centre_of_mass_ /= volume;
  points_.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) points_.emplace_back(vertex.cast<double>() - centre_of_mass_);
}

Support TippingBody::support(const Eigen::Vector3d& down, double nearly_m) const {
  Support support;
  // The centre of mass of an open surface may lie below all of it.
  support.height_m = down.dot(points_.front());
  for (const Eigen::Vector3d& point : points_) support.height_m = std::max(support.height_m, down.dot(point));
  support.along = down.unitOrthogonal();
  support.across = support.along.cross(down);
  std::vector<Eigen::Vector2d> touching;
  for (const Eigen::Vector3d& point : points_) {
    if (down.dot(point) < support.height_m - std::max(kTouchM, nearly_m)) continue;
    touching.emplace_back(support.along.dot(point), support.across.dot(point));
  }
  support.corners = convex_hull(std::move(touching));
  return support;
}

// Rotates about `pivot` until the next point touches the plane.
Eigen::Vector3d TippingBody::tipped(const Eigen::Vector3d& down, const Support& support, const Eigen::Vector2d& pivot,
                                    const Eigen::Vector2d& towards) const {
  const Eigen::Vector3d forward = support.in_object(towards);
  const double pivot_ahead = pivot.dot(towards);
  // Cotangent of the turn: an angle for each point takes long.
  double steepest = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point : points_) {
    const double above = support.height_m - down.dot(point);
    const double ahead = forward.dot(point) - pivot_ahead;
    if (above > kTouchM) steepest = std::max(steepest, ahead / above);
  }
  const double minimum = std::atan2(1.0, steepest);
  return (std::cos(minimum) * down + std::sin(minimum) * forward).normalized();
}

// Tips over as long as the centre of mass is not above what it stands on.
Eigen::Vector3d TippingBody::fallen(Eigen::Vector3d down) const {
  for (int step = 0; step < kMaxSteps; ++step) {
    const Support now = support(down);
    if (now.corners.size() >= 3 && now.margin_m() >= 0.0) return down;
    const Eigen::Vector2d pivot = nearest_on_border(now.corners);
    down = tipped(down, now, pivot, falls_towards(now.corners, pivot));
  }
  fail("mesh does not come to rest in {} steps", kMaxSteps);
}

std::optional<Eigen::Vector3d> TippingBody::rolled(const Eigen::Vector3d& down, const Support& support) const {
  const std::vector<Eigen::Vector2d>& corners = support.corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d side = (corners[(i + 1) % corners.size()] - corners[i]).normalized();
    const Eigen::Vector2d outwards(side.y(), -side.x());
    const double margin = outwards.dot(corners[i]);
    if (std::hypot(support.height_m, margin) - support.height_m > kRollM) continue;
    const Eigen::Vector3d next = fallen(tipped(down, support, corners[i], outwards));
    if (this->support(next).height_m < support.height_m - kLowerM) return next;
  }
  return std::nullopt;
}

Eigen::Vector3d TippingBody::settled(Eigen::Vector3d down) const {
  down = fallen(down.normalized());
  for (int step = 0; step < kMaxSteps; ++step) {
    const auto next = rolled(down, support(down));
    if (!next) return down;
    down = *next;
  }
  fail("mesh rolls on after {} edges", kMaxSteps);
}

}  // namespace houghstream::world
