#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/object_pose.hpp"
#include "pose/pose_settings.hpp"
#include "tools/studies/pose/pose_rivals.hpp"

namespace houghstream {

/// Gives the pose of one detection of a frame, or the reason why there is none, on the calling thread.
using PoseMaker = std::function<ObjectPose(const RgbdFrame&, const Detection&)>;

/// PoseEstimator on one thread. Models by class name, metres.
PoseMaker estimator_maker(const std::map<std::string, Mesh>& models, PoseSettings settings);

/// A rival; where it finds a pose, that is published, else the status is kNotConverged.
PoseMaker baseline_maker(std::unique_ptr<BaselineEstimator> rival);

/// The poses of a frame's detections, in their order, and the CPU time that each took, milliseconds.
struct TimedPoses {
  ObjectPoses poses;
  std::vector<double> ms;
};

/// One detection at a time, so that each has a time of its own. CPU time of the calling thread: what else the machine
/// does lengthens it little.
TimedPoses make_poses(const PoseMaker& maker, const RgbdFrame& frame, const Detections& detections);

}  // namespace houghstream
