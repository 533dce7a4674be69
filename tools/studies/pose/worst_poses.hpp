#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/frame.hpp"
#include "tools/studies/pose/pose_trials.hpp"

namespace houghstream {

/// The published poses that are worst, at most `count`: those of false detections before those of true ones, each by
/// ADD-S, the largest first and unknown before all. Ignored detections are left out.
std::vector<PoseTrial> worst_poses(const std::vector<PoseTrial>& trials, std::size_t count);

/// The surroundings of a trial's box in its frame with the outline of its model, and below it what it is. The trial
/// has a pose. Pictures of all trials have one size, CV_8UC3.
cv::Mat draw_trial(const PoseTrial& trial, const RgbdFrame& frame, const Mesh& mesh);

}  // namespace houghstream
