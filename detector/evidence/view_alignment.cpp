#include "detector/evidence/view_alignment.hpp"

#include <algorithm>
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
  std::size_t back = moves.size();  // the move to where it came from, which was worse; moves lie in opposite pairs
  for (int step = 0; step < kSteps; ++step) {
    std::size_t best = moves.size();
    for (std::size_t m = 0; m < moves.size(); ++m) {
      if (m == back) continue;
      const ViewFit moved = fit_view(view, centre_camera + moves[m], frame);
      if (agreement(moved) <= agreement(fit)) continue;
      fit = moved;
      best = m;
    }
    if (best == moves.size()) break;
    centre_camera += moves[best];
    back = best ^ 1U;
  }
  return fit;
}

const ComparedView& best_unaligned(const std::vector<ComparedView>& compared) {
  const auto worse = [](const ComparedView& a, const ComparedView& b) { return agreement(a.fit) < agreement(b.fit); };
  return *std::max_element(compared.begin(), compared.end(), worse);
}

ViewFit best_aligned(const std::vector<TrainedView>& views, const std::vector<ComparedView>& compared,
                     const Eigen::Vector3f& centre_camera, const LabFrame& frame) {
  constexpr float kFarBehind = 0.3F;  // in agreement: aligning gains less
  ViewFit best = best_unaligned(compared).fit;
  const float least = agreement(best) - kFarBehind;
  for (const ComparedView& seen : compared) {
    if (agreement(seen.fit) < least) continue;
    const ViewFit aligned = align_view(views[seen.view], centre_camera, seen.fit, frame);
    if (agreement(aligned) > agreement(best)) best = aligned;
  }
  return best;
}

}  // namespace houghstream
