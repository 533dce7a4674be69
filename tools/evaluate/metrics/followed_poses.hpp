#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/evaluate/metrics/evaluated_frame.hpp"
#include "tools/evaluate/metrics/pose_metrics.hpp"

namespace houghstream {

/// Counts of one class over the frames of a scene. Poses of hs-pose --follow are published for each frame at once,
/// whether a detector inspects it or not, and are counted without any detection.
struct FollowedCount {
  int required = 0;   ///< objects with a known pose that are visible enough, over all frames, passed over or not
  int published = 0;  ///< poses, but those of objects that are hardly visible
  int correct = 0;    ///< of these by is_correct(), each object once
  int correct_up_to_shape = 0;
};

/// The poses of followed objects beside the ground truth.
struct FollowedPoses {
  int frames = 0;         ///< for which they were published
  int frames_missed = 0;  ///< passed over or lost; their objects count as required
  std::map<std::string, FollowedCount> by_class;

  /// Returns the sum over the classes.
  FollowedCount all() const;
};

/// Compares the poses of followed objects with the ground truth, for the listed classes that have a model. A published
/// pose belongs to the nearest object of its class, by strict_error(), that no nearer pose has; one without an object
/// left is wrong. An object that is visible by less than `min_visible` is neither required nor is its pose counted.
/// Returns nothing where no frame has followed poses.
std::optional<FollowedPoses> count_followed_poses(const std::vector<EvaluatedFrame>& frames,
                                                  const std::vector<std::string>& class_names,
                                                  const std::map<std::string, PoseModel>& models, double min_visible);

}  // namespace houghstream
