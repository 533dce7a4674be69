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

/// Moves the view sideways, by cells of its relief or parts of them and at most a few times, to where it agrees best:
/// votes meet within a few centimetres only. The result agrees at least as well.
PlacedView align_view(const std::vector<TrainedView>& views, PlacedView placed, const LabFrame& frame,
                      float step_cells = 1.0F);

/// The one that agrees best where it stands; ties go to the first. `compared` is not empty.
const PlacedView& best_unaligned(const std::vector<PlacedView>& compared);

/// Sorts the views by how they agree where they stand, best first, aligns the first few, and returns that which then
/// agrees best. `compared` is not empty.
PlacedView align_best_few(const std::vector<TrainedView>& views, const LabFrame& frame,
                          std::vector<PlacedView>& compared);

/// How much better the view agrees where it stands if it is taken for one of a smaller or larger object, whichever
/// agrees better; mostly below 0 if the object has its own size.
float gain_of_other_size(const TrainedView& view, const PlacedView& placed, const LabFrame& frame);

}  // namespace houghstream
