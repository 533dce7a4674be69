#include "pose/model/symmetry_search.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/base/checks.hpp"
#include "pose/model/angles.hpp"
#include "pose/model/surface_colour.hpp"

namespace houghstream {
namespace {

constexpr double kSameDirection = 0.985;  // cosine of 10 degrees

bool has_colours(const Mesh& mesh) {
  return !mesh.colours.empty() || (!mesh.texture.empty() && !mesh.uvs.empty());
}

/// BGR at a point of the surface, from the texture where there is one.
Eigen::Vector3f colour_at(const Mesh& mesh, const ClosestPoint& hit) {
  const auto& triangle = mesh.triangles[hit.triangle];
  if (mesh.texture.empty() || mesh.uvs.empty()) {
    Eigen::Vector3f colour = Eigen::Vector3f::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      const cv::Vec3b& corner = mesh.colours[triangle[i]];
      colour += hit.weights[i] * Eigen::Vector3f(corner[0], corner[1], corner[2]);
    }
    return colour;
  }
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();
  for (std::size_t i = 0; i < 3; ++i) uv += hit.weights[i] * mesh.uvs[triangle[i]];
  const cv::Vec3b& colour = texel_at(mesh.texture, uv);
  return {static_cast<float>(colour[0]), static_cast<float>(colour[1]), static_cast<float>(colour[2])};
}

/// Centroid and principal axes of the surface, exact for triangles of even thickness.
struct Moments {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns
};

Moments surface_moments(const Mesh& mesh) {
  double area = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>();
    const double own = 0.5 * (b - a).cross(c - a).norm();
    const Eigen::Vector3d sum = a + b + c;
    area += own;
    first += own / 3.0 * sum;
    second += own / 12.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  require(area > 0.0, "mesh of {} triangles with surface area 0, expected a surface", mesh.triangles.size());
  Moments out;
  out.centroid = first / area;
  const Eigen::Matrix3d covariance = second / area - out.centroid * out.centroid.transpose();
  out.axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors();
  return out;
}

/// Box axes first: where a principal axis is nearly one of them, the mesh was drawn along it.
std::vector<Eigen::Vector3d> candidate_axes(const Moments& moments) {
  std::vector<Eigen::Vector3d> axes = {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX()};
  for (int i = 0; i < 3; ++i) axes.emplace_back(moments.axes.col(i));
  return axes;
}

/// No n-fold axis has more than a few of these angles among its own.
bool fits_any_angle(const RotationSymmetryTest& check, const Eigen::Vector3d& axis) {
  constexpr std::array<double, 8> kAngles_deg = {23, 37, 53, 71, 97, 113, 139, 163};
  return std::all_of(kAngles_deg.begin(), kAngles_deg.end(),
                     [&](double angle) { return check.fits(axis, angle * kRadPerDeg); });
}

std::vector<ContinuousSymmetry> continuous_axes(const RotationSymmetryTest& check, const Moments& moments) {
  std::vector<ContinuousSymmetry> found;
  for (const Eigen::Vector3d& axis : candidate_axes(moments)) {
    const bool known = std::any_of(found.begin(), found.end(), [&](const ContinuousSymmetry& other) {
      return std::abs(other.axis.dot(axis)) > kSameDirection;
    });
    if (!known && fits_any_angle(check, axis)) found.push_back({axis, moments.centroid});
    if (found.size() == 2) break;  // a ball
  }
  return found;
}

/// One turn per axis: the smallest that fits, of which the others are multiples.
std::vector<Eigen::Isometry3d> min_turns(const RotationSymmetryTest& check, const Moments& moments) {
  constexpr int kMaxFold = 6;
  std::vector<Eigen::Isometry3d> turns;
  std::vector<Eigen::Vector3d> known;
  for (const Eigen::Vector3d& axis : candidate_axes(moments)) {
    const auto same = [&](const Eigen::Vector3d& other) { return std::abs(other.dot(axis)) > kSameDirection; };
    if (std::any_of(known.begin(), known.end(), same)) continue;
    for (int fold = kMaxFold; fold >= 2; --fold) {
      if (!check.fits(axis, 2.0 * M_PI / fold)) continue;
      turns.push_back(check.turn(axis, 2.0 * M_PI / fold));
      known.push_back(axis);
      break;
    }
  }
  return turns;
}

/// All that the turns combine to, without the identity.
std::vector<Eigen::Isometry3d> group_of(const std::vector<Eigen::Isometry3d>& turns) {
  constexpr std::size_t kMaxGroup = 60;  // the icosahedron's
  std::vector<Eigen::Isometry3d> group = {Eigen::Isometry3d::Identity()};
  for (std::size_t i = 0; i < group.size(); ++i) {
    for (const Eigen::Isometry3d& turn : turns) {
      const Eigen::Isometry3d product = turn * group[i];
      const bool known = std::any_of(group.begin(), group.end(), [&](const Eigen::Isometry3d& other) {
        return Eigen::AngleAxisd(other.linear().transpose() * product.linear()).angle() < 10.0 * kRadPerDeg;
      });
      if (!known && group.size() < kMaxGroup) group.push_back(product);
    }
  }
  group.erase(group.begin());
  return group;
}

}  // namespace

RotationSymmetryTest::RotationSymmetryTest(const Mesh& mesh, const Eigen::Vector3d& centre,
                                           const SymmetrySearch& settings)
    : mesh_(mesh),
      settings_(settings),
      tree_(mesh),
      centre_(centre),
      tolerance_m_(static_cast<float>(settings.tolerance * mesh_diameter(mesh))) {
  constexpr int kPoints = 1000;
  constexpr std::uint64_t kSeed = 1;
  samples_ = sample_surface(mesh, kPoints, kSeed).points;
  constexpr std::size_t kMaxCorners = 2000;
  const std::size_t step = mesh.vertices.size() / kMaxCorners + 1;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += step) corners_.push_back(mesh.vertices[i]);
  if (!settings.compare_colours || !has_colours(mesh)) return;
  for (const Eigen::Vector3f& point : samples_) colours_.push_back(colour_at(mesh, tree_.nearest(point)));
}

Eigen::Isometry3d RotationSymmetryTest::turn(const Eigen::Vector3d& axis, double angle_rad) const {
  return Eigen::Translation3d(centre_) * Eigen::AngleAxisd(angle_rad, axis) * Eigen::Translation3d(-centre_);
}

bool RotationSymmetryTest::fits(const Eigen::Vector3d& axis, double angle_rad) const {
  const Eigen::Isometry3f T = turn(axis, angle_rad).cast<float>();
  const auto near = [&](const Eigen::Vector3f& point) { return tree_.nearest(T * point).distance <= tolerance_m_; };
  return std::all_of(corners_.begin(), corners_.end(), near) && std::all_of(samples_.begin(), samples_.end(), near) &&
         differing_fraction(T) <= settings_.largest_differing;
}

double RotationSymmetryTest::differing_fraction(const Eigen::Isometry3f& T) const {
  int differing = 0;
  for (std::size_t i = 0; i < colours_.size(); ++i) {
    const Eigen::Vector3f there = colour_at(mesh_, tree_.nearest(T * samples_[i]));
    const double difference = static_cast<double>((there - colours_[i]).cwiseAbs().mean()) / 255.0;
    differing += difference > settings_.colour_difference ? 1 : 0;
  }
  return static_cast<double>(differing) / static_cast<double>(samples_.size());
}

Symmetries find_symmetries(const Mesh& mesh, const SymmetrySearch& settings) {
  const Moments moments = surface_moments(mesh);
  const RotationSymmetryTest check(mesh, moments.centroid, settings);
  Symmetries found;
  found.continuous = continuous_axes(check, moments);
  if (found.continuous.empty()) {
    found.discrete = group_of(min_turns(check, moments));
  } else if (found.continuous.size() == 1) {
    const Eigen::Vector3d across = found.continuous.front().axis.unitOrthogonal();
    if (check.fits(across, M_PI)) found.discrete = {check.turn(across, M_PI)};
  }
  return found;
}

}  // namespace houghstream
