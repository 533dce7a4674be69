#include "tools/studies/pose/pose_makers.hpp"

#include <ctime>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "pose/pose_estimator.hpp"

namespace houghstream {
namespace {

double thread_cpu_ms() {
  timespec now{};
  require(clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now) == 0, "the clock of the thread's CPU time cannot be read");
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace

PoseMaker estimator_maker(const std::map<std::string, Mesh>& models, PoseSettings settings) {
  settings.threads = 1;
  const auto estimator = std::make_shared<const PoseEstimator>(models, settings);
  return [estimator](const RgbdFrame& frame, const Detection& detection) {
    Detections one;
    one.frame = frame.id;
    one.detections = {detection};
    return estimator->estimate(frame, one).poses.front();
  };
}

PoseMaker baseline_maker(std::unique_ptr<BaselineEstimator> rival) {
  const std::shared_ptr<const BaselineEstimator> shared = std::move(rival);
  return [shared](const RgbdFrame& frame, const Detection& detection) {
    ObjectPose pose;
    pose.class_id = detection.class_id;
    pose.class_name = detection.class_name;
    pose.detection_score = detection.score;
    pose.residual = std::numeric_limits<float>::quiet_NaN();
    pose.T_camera_object = shared->estimate(frame, detection);
    pose.status = pose.T_camera_object ? PoseStatus::kValid : PoseStatus::kNotConverged;
    return pose;
  };
}

TimedPoses make_poses(const PoseMaker& maker, const RgbdFrame& frame, const Detections& detections) {
  TimedPoses out;
  out.poses.frame = frame.id;
  for (const Detection& detection : detections.detections) {
    const double start_ms = thread_cpu_ms();
    ObjectPose pose = maker(frame, detection);
    out.ms.push_back(thread_cpu_ms() - start_ms);
    pose.detection_index = static_cast<int>(out.poses.poses.size());
    out.poses.poses.push_back(std::move(pose));
  }
  return out;
}

}  // namespace houghstream
