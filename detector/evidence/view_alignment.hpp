#pragma once

#include "detector/evidence/view_fit.hpp"

namespace houghstream {

/// How well a view agrees with the frame; larger is better.
float agreement(const ViewFit& fit);

/// Moves the view sideways, cell by cell of its relief and at most a few of them, to where it agrees best: votes meet
/// within a few centimetres only. `fit` is that at `centre_camera`; the result agrees at least as well.
ViewFit align_view(const TrainedView& view, Eigen::Vector3f centre_camera, ViewFit fit, const LabFrame& frame);

}  // namespace houghstream
