#include "detector/evidence/boxes.hpp"

#include <algorithm>

#include "pipeline/base/weighted_median.hpp"

namespace houghstream {
namespace {

/// Left, top, right and bottom of a box, frame pixels; 0 is the left edge of the first pixel.
using Sides = std::array<float, 4>;

/// Returns the sides of the box about the supporting patches. Patches that support the object weakly lie beside it;
/// weak is relative to the median of the supporting patches.
Sides supporting_sides(const Hypothesis& hypothesis, const PatchGrid& patches, BoxWorkspace& workspace) {
  std::vector<float>& weights = workspace.weights;
  std::array<std::vector<float>, 4>& values = workspace.sides;
  weights.clear();
  for (const auto& [patch, weight] : hypothesis.patches) weights.push_back(weight);
  std::nth_element(weights.begin(), weights.begin() + static_cast<std::ptrdiff_t>(weights.size() / 2), weights.end());
  const float minimum = 0.3F * weights[weights.size() / 2];
  for (std::vector<float>& side : values) side.clear();
  for (const auto& [patch, weight] : hypothesis.patches) {
    if (weight < minimum) continue;
    const cv::Rect2f& cell = patches.cell_px[patch];
    values[0].push_back(cell.x);
    values[1].push_back(cell.y);
    values[2].push_back(cell.br().x);
    values[3].push_back(cell.br().y);
  }
  Sides sides{};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const std::size_t outliers = values[i].size() / 50;
    const std::size_t rank = i < 2 ? outliers : values[i].size() - 1 - outliers;
    std::nth_element(values[i].begin(), values[i].begin() + static_cast<std::ptrdiff_t>(rank), values[i].end());
    sides[i] = values[i][rank];
  }
  return sides;
}

/// Returns the sides that the view templates have: weighted medians.
Sides template_sides(const Forest& forest, const Hypothesis& hypothesis, const Camera& camera,
                     BoxWorkspace& workspace) {
  const Eigen::Vector3d centre = hypothesis.centre_camera.cast<double>();
  const Eigen::Vector2d centre_px = camera.project(centre);
  const auto px_per_metre = static_cast<float>(1.0 / camera.metres_per_px(centre.z()));
  std::vector<std::pair<float, float>>& values = workspace.template_values;
  Sides sides{};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    values.clear();
    for (const auto& [view, weight] : hypothesis.views) {
      values.emplace_back(forest.views[view].box[i], weight);
    }
    // pixel centres are whole numbers to the camera, while a box counts from the first pixel's edge
    const auto origin_px = static_cast<float>(centre_px[static_cast<Eigen::Index>(i % 2)]) + 0.5F;
    sides[i] = origin_px + px_per_metre * weighted_median(values);
  }
  return sides;
}

}  // namespace

cv::Rect2f backproject_box(const Forest& forest, const Hypothesis& hypothesis, const PatchGrid& patches,
                           const Camera& camera, BoxWorkspace& workspace) {
  if (hypothesis.patches.empty() || hypothesis.views.empty()) return {};
  // Fraction of the object's width or height by which the patches may end before the template; beyond it the side is
  // taken to be occluded.
  constexpr float kMaxGapFraction = 0.3F;
  const Sides supported = supporting_sides(hypothesis, patches, workspace);
  const Sides templates = template_sides(forest, hypothesis, camera, workspace);
  Sides sides{};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const float size = templates[(i % 2) + 2] - templates[i % 2];
    const float outwards = i < 2 ? supported[i] - templates[i] : templates[i] - supported[i];
    sides[i] = outwards < kMaxGapFraction * size ? templates[i] : supported[i];
  }
  const cv::Rect2f box(sides[0], sides[1], sides[2] - sides[0], sides[3] - sides[1]);
  return box & cv::Rect2f(0.0F, 0.0F, static_cast<float>(camera.width), static_cast<float>(camera.height));
}

}  // namespace houghstream
