#pragma once

#include <cstdint>
#include <vector>

#include "detector/evidence/view_fit.hpp"

namespace houghstream {

/// How well a view agrees with the frame; larger is better.
float agreement(const ViewFit& fit);

/// Moves the view sideways, cell by cell of its relief and at most a few of them, to where it agrees best: votes meet
/// within a few centimetres only. `fit` is that at `centre_camera`; the result agrees at least as well.
ViewFit align_view(const TrainedView& view, Eigen::Vector3f centre_camera, ViewFit fit, const LabFrame& frame);

/// A remembered view, put at a hypothesis' centre.
struct ComparedView {
  std::uint32_t view = 0;  ///< in the forest's
  ViewFit fit;
};

/// The one that agrees best where it stands; ties go to the first. `compared` is not empty.
const ComparedView& best_unaligned(const std::vector<ComparedView>& compared);

/// That of the views, each aligned, which then agrees best. Those that agree far worse than the best where they stand
/// are left out.
ViewFit best_aligned(const std::vector<TrainedView>& views, const std::vector<ComparedView>& compared,
                     const Eigen::Vector3f& centre_camera, const LabFrame& frame);

}  // namespace houghstream
