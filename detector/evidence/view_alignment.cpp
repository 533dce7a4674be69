#include "detector/evidence/view_alignment.hpp"

#include <array>

namespace houghstream {

float agreement(const ViewFit& fit) {
  return fit.visible + 0.5F * fit.unknown - fit.seen_through + 0.5F * fit.likeness - 0.25F * fit.continued -
         0.2F * fit.hue_conflict;
}

ViewFit align_view(const TrainedView& view, Eigen::Vector3f centre_camera, ViewFit fit, const LabFrame& frame) {
  constexpr int kSteps = 4;
  const float right = (view.box[2] - view.box[0]) / Appearance::kBoxSide;
  const float down = (view.box[3] - view.box[1]) / Appearance::kBoxSide;
  const std::array<Eigen::Vector3f, 4> moves = {Eigen::Vector3f(right, 0, 0), Eigen::Vector3f(-right, 0, 0),
                                                Eigen::Vector3f(0, down, 0), Eigen::Vector3f(0, -down, 0)};
  for (int step = 0; step < kSteps; ++step) {
    Eigen::Vector3f better = centre_camera;
    for (const Eigen::Vector3f& move : moves) {
      const ViewFit moved = fit_view(view, centre_camera + move, frame);
      if (agreement(moved) <= agreement(fit)) continue;
      fit = moved;
      better = centre_camera + move;
    }
    if (better == centre_camera) break;
    centre_camera = better;
  }
  return fit;
}

}  // namespace houghstream
