#include "tools/evaluate/metrics/followed_poses.hpp"

#include <algorithm>
#include <tuple>

namespace houghstream {
namespace {

using Transforms = std::vector<Eigen::Isometry3d>;

/// An object of the class in one frame.
struct FollowedTarget {
  Eigen::Isometry3d T_camera_object;
  bool is_required = true;
};

std::vector<FollowedTarget> targets_in(const EvaluatedFrame& frame, const std::string& class_name, double min_visible) {
  std::vector<FollowedTarget> targets;
  for (const NamedObject& object : frame.objects) {
    if (object.class_name != class_name || !object.truth.has_pose) continue;
    const bool is_required = object.is_target.value_or(object.truth.visible_fraction >= min_visible);
    targets.push_back({object.truth.T_camera_object, is_required});
  }
  return targets;
}

Transforms followed_in(const EvaluatedFrame& frame, const std::string& class_name) {
  Transforms poses;
  if (!frame.followed) return poses;
  for (const ObjectPose& pose : frame.followed->poses) {
    if (pose.class_name == class_name && pose.T_camera_object) poses.push_back(*pose.T_camera_object);
  }
  return poses;
}

/// Returns for each pose the index of its target, or nothing: the pairs of the smallest errors first, each pose and
/// each target in one pair at most.
std::vector<std::optional<std::size_t>> assign(const Transforms& poses, const std::vector<FollowedTarget>& targets,
                                               const PoseModel& model) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;  // error, pose, target
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t k = 0; k < targets.size(); ++k)
      pairs.emplace_back(strict_error(model, poses[i], targets[k].T_camera_object), i, k);
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::optional<std::size_t>> target_of(poses.size());
  std::vector<bool> is_assigned(targets.size());
  for (const auto& [error, pose, target] : pairs) {
    if (target_of[pose] || is_assigned[target]) continue;
    target_of[pose] = target;
    is_assigned[target] = true;
  }
  return target_of;
}

void count_frame(const Transforms& poses, const std::vector<FollowedTarget>& targets, const PoseModel& model,
                 FollowedCount& count) {
  for (const FollowedTarget& target : targets) count.required += target.is_required ? 1 : 0;
  const std::vector<std::optional<std::size_t>> target_of = assign(poses, targets, model);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (target_of[i] && !targets[*target_of[i]].is_required) continue;
    ++count.published;
    if (!target_of[i]) continue;
    const Eigen::Isometry3d& T_ground_truth = targets[*target_of[i]].T_camera_object;
    count.correct += is_correct(model, poses[i], T_ground_truth) ? 1 : 0;
    count.correct_up_to_shape += is_correct_up_to_shape(model, poses[i], T_ground_truth) ? 1 : 0;
  }
}

}  // namespace

FollowedCount FollowedPoses::all() const {
  FollowedCount sum;
  for (const auto& [name, count] : by_class) {
    sum.required += count.required;
    sum.published += count.published;
    sum.correct += count.correct;
    sum.correct_up_to_shape += count.correct_up_to_shape;
  }
  return sum;
}

std::optional<FollowedPoses> count_followed_poses(const std::vector<EvaluatedFrame>& frames,
                                                  const std::vector<std::string>& class_names,
                                                  const std::map<std::string, PoseModel>& models, double min_visible) {
  FollowedPoses out;
  for (const EvaluatedFrame& frame : frames) ++(frame.followed ? out.frames : out.frames_missed);
  if (out.frames == 0) return std::nullopt;
  for (const std::string& name : class_names) {
    const auto model = models.find(name);
    if (model == models.end()) continue;
    FollowedCount& count = out.by_class[name];
    for (const EvaluatedFrame& frame : frames)
      count_frame(followed_in(frame, name), targets_in(frame, name, min_visible), model->second, count);
  }
  return out;
}

}  // namespace houghstream
