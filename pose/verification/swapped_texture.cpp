#include "pose/verification/swapped_texture.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace houghstream {
namespace {

/// Returns the view with the colours of each point's opposite.
ModelView with_opposite_colours(const ModelView& view) {
  ModelView other = view;
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& point : view.points) middle += point / static_cast<float>(view.points.size());
  std::vector<Eigen::Vector3f> across;  // offsets from the middle, across the line of sight
  across.reserve(view.points.size());
  for (const Eigen::Vector3f& point : view.points) {
    const Eigen::Vector3f from_middle = point - middle;
    across.emplace_back(from_middle - from_middle.dot(view.direction) * view.direction);
  }
  for (std::size_t i = 0; i < across.size(); ++i) {
    const Eigen::Vector3f opposite = -across[i];
    const auto nearest = std::min_element(across.begin(), across.end(), [&](const auto& a, const auto& b) {
      return (a - opposite).squaredNorm() < (b - opposite).squaredNorm();
    });
    other.colours[i] = view.colours[static_cast<std::size_t>(nearest - across.begin())];
  }
  return other;
}

/// Returns L*, a*, b* of each point, less their means.
Eigen::MatrixX3d about_mean(const std::vector<LabColour>& colours) {
  Eigen::MatrixX3d out(static_cast<Eigen::Index>(colours.size()), 3);
  for (std::size_t i = 0; i < colours.size(); ++i)
    out.row(static_cast<Eigen::Index>(i)) << colours[i][0], colours[i][1], colours[i][2];
  out.rowwise() -= out.colwise().mean().eval();
  return out;
}

/// Returns the correlation of two textures of the same points, which is near 1 for plain ones too.
double correlation(const std::vector<LabColour>& a, const std::vector<LabColour>& b) {
  constexpr double kPlain = 30.0;  // variance without texture
  const Eigen::MatrixX3d one = about_mean(a);
  const Eigen::MatrixX3d two = about_mean(b);
  const double plain = kPlain * static_cast<double>(a.size());
  return (one.cwiseProduct(two).sum() + plain) / (one.norm() * two.norm() + plain);
}

}  // namespace

std::optional<PoseEvidence> evidence_with_swapped_texture(const ObjectObservation& observation,
                                                          const Eigen::Isometry3d& T_camera_object,
                                                          const PoseEvidence& original,
                                                          const VerificationSettings& settings) {
  constexpr double kMaxTextureCorrelation = 0.5;
  const ProjectedView look = project_view(observation.frame, observation.model, T_camera_object, settings.points);
  if (look.view.colours.empty()) return std::nullopt;
  const ModelView view = with_opposite_colours(look.view);
  if (correlation(look.view.colours, view.colours) > kMaxTextureCorrelation) return std::nullopt;
  const DepthTolerance tolerance{settings.tolerance_m, observation.noise};
  const ProjectedView other{view, look.T, look.depth, look.points};
  PoseEvidence evidence = original;
  evidence.colour = compare_texture(observation, other, tolerance);
  if (!evidence.colour) return std::nullopt;
  return evidence;
}

}  // namespace houghstream
