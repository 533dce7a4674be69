#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/types/detection.hpp"
#include "pose/following/followed_objects.hpp"
#include "pose/pose_estimator.hpp"

namespace houghstream {

/// A frame's detections beside what was followed in it.
struct DetectionLook {
  ShownFrame shown;
  std::vector<int> matches;  ///< each detection's followed object: its place in `shown`, or -1
  int doubted = -1;          ///< the place in `shown` of what is looked for as if it were not followed

  bool is_looked_for(std::size_t detection) const { return matches[detection] < 0 || matches[detection] == doubted; }
};

/// What was followed in the frame of the detections, and which of them are of that. Notes in the camera's objects what
/// the look says of them: found, with this score, or not found though in full view; and which one is doubted.
DetectionLook look_at_detections(const PoseEstimator& estimator, const Detections& detections,
                                 const FollowerSettings& settings, FollowedCamera& camera);

/// Where the pose of a detection is better than the followed one of that frame, the object goes on from it: what is
/// between the two stays the same in the object's own frame.
void settle_doubt(const ObjectPose& pose, const FollowedPose& followed, const FollowerSettings& settings,
                  FollowedObject& object);

/// The object of a number; null where it is not followed any more.
FollowedObject* find_followed(std::int64_t number, FollowedCamera& camera);

/// Log odds of a detection's score: exactly 0 or 1 is not certainty.
double score_log_odds(double score);

}  // namespace houghstream
