#include "pose/verification/swapped_texture.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace houghstream {
namespace {

/// Returns the view with the colours of each point's opposite.
ModelView with_opposite_colours(const ModelView& view) {
  ModelView swapped = view;
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& point : view.points) middle += point / static_cast<float>(view.points.size());
  std::vector<Eigen::Vector3f> offsets;  // offsets from the middle, across the line of sight
  offsets.reserve(view.points.size());
  for (const Eigen::Vector3f& point : view.points) {
    const Eigen::Vector3f from_middle = point - middle;
    offsets.emplace_back(from_middle - from_middle.dot(view.direction) * view.direction);
  }
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const Eigen::Vector3f opposite = -offsets[i];
    const auto nearest = std::min_element(offsets.begin(), offsets.end(), [&](const auto& a, const auto& b) {
      return (a - opposite).squaredNorm() < (b - opposite).squaredNorm();
    });
    swapped.colours[i] = view.colours[static_cast<std::size_t>(nearest - offsets.begin())];
  }
  return swapped;
}

/// Returns L*, a*, b* of each point, less their means.
Eigen::MatrixX3d subtract_mean(const std::vector<LabColour>& colours) {
  Eigen::MatrixX3d out(static_cast<Eigen::Index>(colours.size()), 3);
  for (std::size_t i = 0; i < colours.size(); ++i)
    out.row(static_cast<Eigen::Index>(i)) << colours[i][0], colours[i][1], colours[i][2];
  out.rowwise() -= out.colwise().mean().eval();
  return out;
}

/// Returns the correlation of two textures of the same points, which is near 1 for two uniform ones too.
double correlation(const std::vector<LabColour>& a, const std::vector<LabColour>& b) {
  constexpr double kVarianceFloor = 30.0;  // keeps what varies without texture from mattering
  const Eigen::MatrixX3d centred_a = subtract_mean(a);
  const Eigen::MatrixX3d centred_b = subtract_mean(b);
  const double floor = kVarianceFloor * static_cast<double>(a.size());
  return (centred_a.cwiseProduct(centred_b).sum() + floor) / (centred_a.norm() * centred_b.norm() + floor);
}

}  // namespace

std::optional<PoseEvidence> evidence_with_swapped_texture(const ObjectObservation& observation,
                                                          const Eigen::Isometry3d& T_camera_object,
                                                          const PoseEvidence& original,
                                                          const VerificationSettings& settings) {
  constexpr double kMaxTextureCorrelation = 0.5;
  const ProjectedView projected = project_view(observation.frame, observation.model, T_camera_object, settings.points);
  if (projected.view.colours.empty()) return std::nullopt;
  const ModelView view = with_opposite_colours(projected.view);
  if (correlation(projected.view.colours, view.colours) > kMaxTextureCorrelation) return std::nullopt;
  const DepthTolerance tolerance{settings.tolerance_m, observation.noise};
  const ProjectedView swapped{view, projected.T, projected.depth, projected.points};
  PoseEvidence evidence = original;
  evidence.colour = compare_texture(observation, swapped, tolerance);
  if (!evidence.colour) return std::nullopt;
  return evidence;
}

}  // namespace houghstream
