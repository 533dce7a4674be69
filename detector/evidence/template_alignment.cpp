#include "detector/evidence/template_alignment.hpp"

#include <algorithm>
#include <array>

namespace houghstream {

float match_quality(const TemplateMatch& fit) {
  return fit.visible_fraction + 0.5F * fit.no_depth_fraction - fit.free_space_violation +
         0.5F * fit.colour_correlation - 0.25F * fit.rim_continuation - 0.2F * fit.hue_mismatch;
}

PlacedTemplate align_template(const std::vector<ViewTemplate>& views, PlacedTemplate placed, const LabFrame& frame,
                              float step_cells) {
  constexpr int kSteps = 4;
  const ViewTemplate& view = views[placed.view];
  // A step to the right and one down are in metres at the centre's depth.
  const float right = step_cells * (view.box[2] - view.box[0]) / TemplateGrid::kBoxSide;
  const float down = step_cells * (view.box[3] - view.box[1]) / TemplateGrid::kBoxSide;
  const std::array<Eigen::Vector3f, 4> moves = {Eigen::Vector3f(right, 0, 0), Eigen::Vector3f(-right, 0, 0),
                                                Eigen::Vector3f(0, down, 0), Eigen::Vector3f(0, -down, 0)};
  std::size_t back = moves.size();  // the move to where it came from, which was worse; moves lie in opposite pairs
  for (int step = 0; step < kSteps; ++step) {
    std::size_t best = moves.size();
    for (std::size_t m = 0; m < moves.size(); ++m) {
      if (m == back) continue;
      const TemplateMatch moved = match_template(view, placed.centre_camera + moves[m], frame);
      if (match_quality(moved) <= match_quality(placed.fit)) continue;
      placed.fit = moved;
      best = m;
    }
    if (best == moves.size()) break;
    placed.centre_camera += moves[best];
    back = best ^ 1U;
  }
  return placed;
}

const PlacedTemplate& best_match(const std::vector<PlacedTemplate>& compared) {
  return *std::min_element(compared.begin(), compared.end(), matches_better);
}

PlacedTemplate align_best_templates(const std::vector<ViewTemplate>& views, const LabFrame& frame,
                                    std::vector<PlacedTemplate>& compared) {
  constexpr std::size_t kFew = 4;
  std::stable_sort(compared.begin(), compared.end(), matches_better);
  PlacedTemplate best = compared.front();
  for (std::size_t i = 0; i < std::min(kFew, compared.size()); ++i) {
    compared[i] = align_template(views, compared[i], frame);
    if (matches_better(compared[i], best)) best = compared[i];
  }
  return best;
}

float alternative_scale_gain(const ViewTemplate& view, const PlacedTemplate& placed, const LabFrame& frame) {
  constexpr float kSmaller = 0.7F;
  constexpr float kLarger = 1.4F;
  const float smaller = match_quality(match_template(view, placed.centre_camera, frame, {kSmaller}));
  const float larger = match_quality(match_template(view, placed.centre_camera, frame, {kLarger}));
  return std::max(smaller, larger) - match_quality(placed.fit);
}

}  // namespace houghstream
