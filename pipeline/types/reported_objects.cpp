#include "pipeline/types/reported_objects.hpp"

#include <algorithm>
#include <utility>

namespace houghstream {
namespace {

const ObjectPose* pose_of(const FrameResult& result, std::size_t detection) {
  return result.poses ? find_pose(*result.poses, detection) : nullptr;
}

/// Returns whether a detection counts. Candidates that no pose has confirmed are not objects of the frame. If hs-pose
/// has not answered a detection result, the followed poses are more reliable than detections of the same class.
bool is_counted(const FrameResult& result, std::size_t index, const std::vector<ObjectPose>& followed) {
  const Detection& detection = result.detections.detections[index];
  const auto is_same_class = [&](const ObjectPose& pose) { return pose.class_name == detection.class_name; };
  if (!result.poses && std::any_of(followed.begin(), followed.end(), is_same_class)) return false;
  return is_reported(detection, pose_of(result, index));
}

bool is_same_object(const ObjectPose& a, const ObjectPose& b) {
  if (a.class_name != b.class_name || a.status != b.status) return false;
  if (!a.T_camera_object || !b.T_camera_object) return !a.T_camera_object && !b.T_camera_object;
  return a.T_camera_object->isApprox(*b.T_camera_object, 1e-9);
}

/// Returns the followed poses that answer no detection: the detection of a followed object is answered with the
/// followed pose (object_poses_t).
std::vector<ObjectPose> find_undetected(const FrameResult& result, const ObjectPoses& followed) {
  std::vector<ObjectPose> answers;
  for (std::size_t i = 0; i < result.detections.detections.size(); ++i) {
    const ObjectPose* pose = pose_of(result, i);
    if (pose != nullptr && is_reported(result.detections.detections[i], pose)) answers.push_back(*pose);
  }
  std::vector<ObjectPose> others;
  for (const ObjectPose& pose : followed.poses) {
    const auto same = std::find_if(answers.begin(), answers.end(),
                                   [&](const ObjectPose& answer) { return is_same_object(answer, pose); });
    if (same == answers.end()) {
      others.push_back(pose);
    } else {
      answers.erase(same);
    }
  }
  return others;
}

void add_detected(const FrameResult& result, const std::vector<ObjectPose>& followed, ReportedObjects& report) {
  for (std::size_t i = 0; i < result.detections.detections.size(); ++i) {
    if (!is_counted(result, i, followed)) continue;
    ReportedObject object;
    object.detection_index = static_cast<int>(i);
    object.detection = result.detections.detections[i];
    if (const ObjectPose* pose = pose_of(result, i)) object.pose = *pose;
    report.objects.push_back(std::move(object));
  }
  // The poses' stages begin with the detections'.
  const bool posed = result.poses && !result.poses->stages.empty();
  report.stages = posed ? result.poses->stages : result.detections.stages;
}

}  // namespace

std::optional<ReportedObjects> report_objects(const FrameResults& results) {
  const std::optional<FrameResult> merged = results.merge();
  if (!merged && !results.followed()) return std::nullopt;
  ReportedObjects report;
  report.frame = merged ? merged->detections.frame : results.followed()->frame;
  std::vector<ObjectPose> followed;
  if (results.followed()) {
    followed = merged ? find_undetected(*merged, *results.followed()) : results.followed()->poses;
    report.stages = results.followed()->stages;
  }
  if (merged) add_detected(*merged, followed, report);
  for (ObjectPose& pose : followed) {
    ReportedObject object;
    object.pose = std::move(pose);
    report.objects.push_back(std::move(object));
  }
  return report;
}

}  // namespace houghstream
