#pragma once

#include <cstdint>
#include <vector>

#include "detector/evidence/view_fit.hpp"

namespace houghstream {

/// How well a view agrees with the frame; larger is better.
float agreement(const ViewFit& fit);

/// A remembered view, and how it agrees with the frame where it stands.
struct PlacedView {
  std::uint32_t view = 0;  ///< in the forest's
  Eigen::Vector3f centre_camera = Eigen::Vector3f::Zero();
  ViewFit fit;
};

/// Moves the view sideways, cell by cell of its relief and at most a few of them, to where it agrees best: votes meet
/// within a few centimetres only. The result agrees at least as well.
PlacedView align_view(const std::vector<TrainedView>& views, PlacedView placed, const LabFrame& frame);

/// The one that agrees best where it stands; ties go to the first. `compared` is not empty.
const PlacedView& best_unaligned(const std::vector<PlacedView>& compared);

/// That of the views, each aligned, which then agrees best. Those that agree far worse than the best where they stand
/// are left out.
PlacedView best_aligned(const std::vector<TrainedView>& views, const std::vector<PlacedView>& compared,
                        const LabFrame& frame);

/// How much better the view agrees where it stands if it is taken for one of a smaller or larger object, whichever
/// agrees better; mostly below 0 if the object has its own size.
float gain_of_other_size(const TrainedView& view, const PlacedView& placed, const LabFrame& frame);

}  // namespace houghstream
