#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/base/settings_fields.hpp"
#include "pose/following/follow.hpp"
#include "pose/motion/smoothed_velocity.hpp"
#include "pose/pose_estimator.hpp"
#include "pose/seen/camera_colours.hpp"

namespace houghstream {

/// When what is followed is given up, and which detection is of it.
struct FollowerSettings {
  FollowSettings follow;          ///< how one object is found again in one frame
  int max_failures = 3;           ///< frames one after the other without evidence: it is lost
  float min_kept_quality = 0.3F;  ///< a pose that is withheld is followed on from this quality on
  double max_rejected_s = 1.0;    ///< but no longer without a valid pose
  double max_hidden_s = 2.0;      ///< the same while it is hidden
  double reach_m = 0.07;          ///< between a detection's centre and a followed pose of its class: it is of that one
  double duplicate_distance_ratio = 0.5;  ///< of the smaller radius: closer together two objects are one
  double logit_gain = 0.3;                ///< how much one look moves the score's log odds
  float miss_score = 0.3F;                ///< what a look is worth that does not find an object in full view...
  double missed_after_s = 1.0;            ///< ...once none has found it for so long
  double recheck_interval_s = 0.15;       ///< a detection's pose is looked for anew, beside the followed one...
  float doubtful_quality = 0.85F;         ///< below it that does not wait: the next detection of it is posed anew
  double better_log_odds = 0.3;           ///< ...and takes its place where its quality is so much better
  double velocity_gain = 0.5;             ///< how much the last step moves the speed
  /// By which a camera's depth and colours may be apart in time. Depth that was in the frame before already, as where
  /// colours come more often, is older by that frame.
  double depth_lag_s = 0.01;
};

template <typename Visit>
void fields(const FollowerSettings& /*settings*/, const Visit& visit) {
  using S = FollowerSettings;
  visit(group("follow", &S::follow));
  visit(number("max_failures", &S::max_failures, 0, 100000));
  visit(number("min_kept_quality", &S::min_kept_quality, 0, 1));
  visit(number("max_rejected_s", &S::max_rejected_s, 0, 3600, "s"));
  visit(number("max_hidden_s", &S::max_hidden_s, 0, 3600, "s"));
  visit(number("reach_m", &S::reach_m, 0, 10, "m"));
  visit(number("duplicate_distance_ratio", &S::duplicate_distance_ratio, 0, 10));
  visit(number("logit_gain", &S::logit_gain, 0, 1));
  visit(number("miss_score", &S::miss_score, 0, 1));
  visit(number("missed_after_s", &S::missed_after_s, 0, 3600, "s"));
  visit(number("recheck_interval_s", &S::recheck_interval_s, 0, 3600, "s"));
  visit(number("doubtful_quality", &S::doubtful_quality, 0, 1));
  visit(number("better_log_odds", &S::better_log_odds, 0, 100));
  visit(number("velocity_gain", &S::velocity_gain, 0, 1));
  visit(number("depth_lag_s", &S::depth_lag_s, 0, 1, "s"));
}

/// An object that is followed from frame to frame of one camera. Its times are on the camera's clock
/// (FollowedCamera::ahead_us).
struct FollowedObject {
  std::int64_t number = 0;  ///< in the order in which they were found
  int class_id = 0;
  std::string class_name;
  double score_logit = 0.0;  ///< log odds of its detections' scores
  /// Of the detection's pose that it goes on from: PoseEvidence::texture_probability.
  float texture_probability = 1.0F;
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();  ///< metres
  std::int64_t clock_us = 0;                                          ///< of the frame in which it was there
  SmoothedVelocity velocity;
  std::int64_t valid_us = 0;    ///< of its last valid pose
  std::int64_t found_us = 0;    ///< of its last detection
  std::int64_t recheck_us = 0;  ///< when it was last looked for as if it were not followed
  int failures = 0;
  float shape_quality = 0.0F;            ///< of its last pose for which depth spoke
  std::optional<Verification> verified;  ///< of the last rendering
  FollowedAppearance appearance;         ///< learnt from its valid poses
};

/// A frame's poses, and whose they are.
struct FollowedFrame {
  std::int64_t utime = 0;     ///< names it
  std::int64_t clock_us = 0;  ///< when it was taken, on the camera's clock
  std::vector<std::int64_t> numbers;
  std::vector<FollowedPose> poses;
};

/// What is remembered of a camera.
struct FollowedCamera {
  std::vector<FollowedObject> objects;
  std::deque<FollowedFrame> recent_frames;  ///< the last ones
  CameraColours colours;                    ///< that its objects are judged by
  bool is_colourless = false;               ///< of the last frame: they say nothing
  std::uint64_t depth_digest = 0;           ///< of the last frame's depth
  std::int64_t depth_us = 0;                ///< when that depth came first, on the camera's clock
  std::int64_t frames = 0;
  /// The camera's clock minus its frames' utimes, which jump where the host's clock is set or a stamp is wrong. The
  /// camera's clock does not.
  std::int64_t ahead_us = 0;
  std::int64_t interval_us = 0;                 ///< from the frame before to the last one
  std::optional<std::int64_t> overtaken_utime;  ///< of the last frame that came, where newer ones had overtaken it
};

/// What hs-pose --follow remembers: the objects of each camera that are followed from frame to frame by registration
/// from where they are expected (constant velocity, of rotations those that the last frame observed), each for as long
/// as the evidence lasts. Detections, which come
/// later and seldom, add objects, take the place of lost ones, and say how sure it is that those are there that are
/// followed. Now and then one that is followed is looked for as if it were not, since registration from the last pose
/// alone never leaves a wrong turn. Every function may be called from any thread; answer() keeps follow() waiting for
/// short steps only.
class ObjectFollower {
 public:
  /// Throws InputError for settings out of their range.
  explicit ObjectFollower(FollowerSettings settings = {});

  /// The followed objects in the newest frame of a camera, in the order in which they were found; each without a
  /// detection, and with the reason where its pose is withheld. What is lost is told once more, with its reason, and is
  /// gone from the next frame on. Nothing for a frame that newer ones have overtaken on its way. Where stamps jump (a
  /// clock that is set, one wrong stamp) the objects are followed on. The stage's time, pose.following, is appended to
  /// `stages` of the frame.
  std::optional<ObjectPoses> follow(const PoseEstimator& estimator, const RgbdFrame& frame);

  /// The poses of the detections of a frame that follow() has had: of followed objects as they were then, of others as
  /// PoseEstimator::estimate finds them. What is found is followed from the next frame on.
  ObjectPoses process_detections(const PoseEstimator& estimator, const RgbdFrame& frame, const Detections& detections);

  /// What the followed objects have told of the colours of the camera with this channel.
  CameraChroma camera_colours(const std::string& channel);

 private:
  std::vector<FollowedPose> follow_all(const PoseEstimator& estimator, const RgbdFrame& frame,
                                       FollowedCamera& camera) const;
  void retry_lost(const PoseEstimator& estimator, const RgbdFrame& frame, const FollowedCamera& camera,
                  std::vector<FollowedPose>& poses) const;
  void note_result(const PoseEstimator& estimator, const FollowedPose& result, std::int64_t clock_us,
                   FollowedObject& object) const;
  void learn_appearance(const PoseEstimator& estimator, const RgbdFrame& frame, bool is_refined,
                        FollowedObject& object) const;
  bool is_lost(const FollowedObject& object, const FollowedPose& result, std::int64_t clock_us) const;
  void remove_lost(const PoseEstimator& estimator, FollowedCamera& camera, FollowedFrame& followed_frame) const;
  void add_object(const PoseEstimator& estimator, const RgbdFrame& frame, const ObjectPose& pose,
                  FollowedCamera& camera);
  static void propagate_to_latest(std::int64_t utime, const FollowedCamera& camera, FollowedObject& found);

  FollowerSettings settings_;
  std::mutex mutex_;
  std::map<std::string, FollowedCamera> cameras_;  // by channel
  std::int64_t found_ = 0;
};

}  // namespace houghstream
