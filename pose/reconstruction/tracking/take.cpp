#include "pose/reconstruction/tracking/take.hpp"

namespace houghstream::reconstruction {

Eigen::Isometry3d Take::pose_of(const RegisteredFrame& frame) const {
  return frame.T_camera_keyframe * keyframes[static_cast<std::size_t>(frame.keyframe)].T_camera_world;
}

std::vector<LostSpan> find_unrecovered_spans(const Take& take) {
  std::vector<LostSpan> still;
  for (const LostSpan& span : take.lost) {
    for (int i = span.from; i <= span.to; ++i) {
      if (take.frames[static_cast<std::size_t>(i)].tracked) continue;
      if (!still.empty() && still.back().to == i - 1 && i != span.from) {
        still.back().to = i;
      } else {
        still.push_back({i, i, span.why});
      }
    }
  }
  return still;
}

}  // namespace houghstream::reconstruction
