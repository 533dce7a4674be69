#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "pose/following/detection_look.hpp"
#include "pose/following/followed_objects.hpp"
#include "pose/pose_estimator.hpp"

namespace houghstream {

/// What hs-pose --follow remembers: the objects of each camera that are followed from frame to frame by registration
/// from where they are expected (constant velocity), each for as long as the evidence lasts. Detections, which come
/// later and seldom, add objects, take the place of lost ones, and say how sure it is that those are there that are
/// followed. Now and then one that is followed is looked for as if it were not, since registration from the last pose
/// alone never leaves a wrong turn. Every function may be called from any thread; answer() keeps follow() waiting for
/// short steps only.
class ObjectFollower {
 public:
  explicit ObjectFollower(FollowerSettings settings = {}) : settings_(settings) {}

  /// The followed objects in the newest frame of a camera, in the order in which they were found; each without a
  /// detection, and with the reason where its pose is withheld. What is lost is told once more, with its reason, and
  /// is gone from the next frame on. Nothing for a frame that newer ones have overtaken on its way. Where stamps jump
  /// (a clock that is set, one wrong stamp) the objects are followed on. The stage's time, pose.following, is appended
  /// to `stages` of the frame.
  std::optional<ObjectPoses> follow(const PoseEstimator& estimator, const RgbdFrame& frame);

  /// The poses of the detections of a frame that follow() has had: of followed objects as they were then, of others
  /// as PoseEstimator::estimate finds them. What is found is followed from the next frame on.
  ObjectPoses answer(const PoseEstimator& estimator, const RgbdFrame& frame, const Detections& detections);

 private:
  std::vector<FollowedPose> follow_all(const PoseEstimator& estimator, const RgbdFrame& frame,
                                       FollowedCamera& camera) const;
  void follow_again(const PoseEstimator& estimator, const RgbdFrame& frame, const FollowedCamera& camera,
                    std::vector<FollowedPose>& poses) const;
  void note_result(const FollowedPose& result, std::int64_t clock_us, FollowedObject& object) const;
  bool is_lost(const FollowedObject& object, const FollowedPose& result, std::int64_t clock_us) const;
  void give_up(const PoseEstimator& estimator, FollowedCamera& camera, ShownFrame& shown) const;
  DetectionLook begin_look(const PoseEstimator& estimator, const Detections& detections);
  void take_up(const PoseEstimator& estimator, const FrameId& frame, const ObjectPose& pose, FollowedCamera& camera);
  static void bring_up_to_date(std::int64_t utime, const FollowedCamera& camera, FollowedObject& found);

  FollowerSettings settings_;
  std::mutex mutex_;
  std::map<std::string, FollowedCamera> cameras_;  // by channel
  std::int64_t found_ = 0;
};

}  // namespace houghstream
