#include "pose/registration/turn_check.hpp"

#include <algorithm>

#include "pose/model/surface_colour.hpp"

namespace houghstream {
namespace {

bool has_colours(const Mesh& mesh) {
  return !mesh.colours.empty() || (!mesh.texture.empty() && !mesh.uvs.empty());
}

/// BGR at a point of the surface, from the texture where there is one.
Eigen::Vector3f colour_at(const Mesh& mesh, const SurfaceHit& hit) {
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

}  // namespace

TurnCheck::TurnCheck(const Mesh& mesh, const Eigen::Vector3d& centre, const SymmetrySearch& settings)
    : mesh_(mesh),
      settings_(settings),
      tree_(mesh),
      centre_(centre),
      tolerance_m_(static_cast<float>(settings.tolerance * mesh_diameter(mesh))) {
  constexpr int kPoints = 1000;
  constexpr std::uint64_t kSeed = 1;
  samples_ = sample_surface(mesh, kPoints, kSeed).points;
  constexpr std::size_t kMostCorners = 2000;
  const std::size_t step = mesh.vertices.size() / kMostCorners + 1;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += step) corners_.push_back(mesh.vertices[i]);
  if (!settings.compare_colours || !has_colours(mesh)) return;
  for (const Eigen::Vector3f& point : samples_) colours_.push_back(colour_at(mesh, tree_.nearest(point)));
}

Eigen::Isometry3d TurnCheck::turn(const Eigen::Vector3d& axis, double angle_rad) const {
  return Eigen::Translation3d(centre_) * Eigen::AngleAxisd(angle_rad, axis) * Eigen::Translation3d(-centre_);
}

bool TurnCheck::fits(const Eigen::Vector3d& axis, double angle_rad) const {
  const Eigen::Isometry3f T = turn(axis, angle_rad).cast<float>();
  const auto near = [&](const Eigen::Vector3f& point) { return tree_.nearest(T * point).distance <= tolerance_m_; };
  return std::all_of(corners_.begin(), corners_.end(), near) && std::all_of(samples_.begin(), samples_.end(), near) &&
         differing_share(T) <= settings_.largest_differing;
}

double TurnCheck::differing_share(const Eigen::Isometry3f& T) const {
  int differing = 0;
  for (std::size_t i = 0; i < colours_.size(); ++i) {
    const Eigen::Vector3f there = colour_at(mesh_, tree_.nearest(T * samples_[i]));
    const double difference = static_cast<double>((there - colours_[i]).cwiseAbs().mean()) / 255.0;
    differing += difference > settings_.colour_difference ? 1 : 0;
  }
  return static_cast<double>(differing) / static_cast<double>(samples_.size());
}

}  // namespace houghstream
