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
#include "pipeline/types/camera_timing.hpp"
#include "pose/following/camera_lag.hpp"
#include "pose/following/follow.hpp"
#include "pose/motion/smoothed_velocity.hpp"
#include "pose/pose_estimator.hpp"
#include "pose/seen/camera_colours.hpp"

namespace houghstream {

/// Settings that decide when an object is lost, and which detection belongs to which object.
struct FollowerSettings {
  FollowSettings follow;          ///< settings of following one object in one frame
  int max_failures = 3;           ///< consecutive frames without evidence after which it is lost
  float min_kept_quality = 0.3F;  ///< quality from which on a withheld pose is followed on
  double max_rejected_s = 1.0;    ///< time without a valid pose after which it is lost
  double max_hidden_s = 2.0;      ///< time without a valid pose while it is hidden
  /// Time after which an object that stays occluded or rejected is searched for again in its surroundings, which takes
  /// several times as long as following it.
  double retry_interval_s = 0.05;
  /// Distance between a detection's centre and a followed pose of its class that associates them.
  double reach_m = 0.07;
  double logit_gain = 0.3;      ///< fraction by which one detection moves the score's log odds
  float miss_score = 0.3F;      ///< score of a detector run that does not find an object in full view
  double missed_after_s = 1.0;  ///< time without a detection from which on such a run counts
  /// Time after which a detection's pose is estimated again, beside the followed one.
  double recheck_interval_s = 0.15;
  /// A pose of lower quality is rechecked whenever its object is detected, and before surer ones.
  float doubtful_quality = 0.85F;
  /// Log odds of quality by which the new pose must be better to replace the followed one.
  double better_log_odds = 0.3;
  double velocity_gain = 0.5;  ///< fraction by which the last step moves the velocity
  /// Standard deviation of the time by which cameras take depth later than colours. Of each camera it is learnt
  /// (CameraLag). Depth that was in the frame before already, as where colours come more often, is older by that frame.
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
  visit(number("retry_interval_s", &S::retry_interval_s, 0, 3600, "s"));
  visit(number("reach_m", &S::reach_m, 0, 10, "m"));
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
/// (FollowedCamera::clock_offset_us).
struct FollowedObject {
  std::int64_t number = 0;  ///< number in the order in which objects were found
  int class_id = 0;
  std::string class_name;
  double score_logit = 0.0;  ///< log odds of its detections' scores
  /// PoseEvidence::texture_probability of the detection's pose that it continues.
  float texture_probability = 1.0F;
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();  ///< metres
  std::int64_t clock_us = 0;                                          ///< time of the frame of T_camera_object
  SmoothedVelocity velocity;
  std::int64_t valid_us = 0;    ///< time of its last valid pose
  std::int64_t found_us = 0;    ///< time of its last detection
  std::int64_t recheck_us = 0;  ///< time at which it was last estimated as if it were not followed
  std::int64_t retry_us = 0;    ///< time at which it was last searched for in its surroundings
  int failures = 0;
  float shape_quality = 0.0F;              ///< shape quality of its last pose that was judged by depth
  std::optional<Verification> verified;    ///< verification by the last rendering
  std::optional<ComparedColours> colours;  ///< colours by which it was judged last
  FollowedAppearance appearance;           ///< appearance that its valid poses have taught
};

/// A frame's poses, with the numbers of their objects.
struct FollowedFrame {
  std::int64_t utime = 0;     ///< time stamp by which the frame is known
  std::int64_t clock_us = 0;  ///< time at which it was taken, on the camera's clock
  std::vector<std::int64_t> numbers;
  std::vector<FollowedPose> poses;
};

/// State of one camera.
struct FollowedCamera {
  std::vector<FollowedObject> objects;
  std::deque<FollowedFrame> recent_frames;  ///< frames that a detector may still answer
  CameraColours colours;                    ///< colours that its objects are judged by
  std::vector<ObjectPose> rejected;         ///< weak detections rejected in the last detections, see find_rejected()
  bool is_colourless = false;               ///< whether the last frame has no colours
  std::uint64_t depth_digest = 0;           ///< digest of the last frame's depth
  std::int64_t depth_us = 0;                ///< time at which that depth came first, on the camera's clock
  std::optional<CameraLag> lag;             ///< lag between depth and colours; there from the first frame on
  std::int64_t frames = 0;
  /// The camera's clock minus its frames' utimes, which jump where the host's clock is set or a stamp is wrong. The
  /// camera's clock does not.
  std::int64_t clock_offset_us = 0;
  std::int64_t interval_us = 0;  ///< time from the frame before to the last one
  /// Time stamp of the last frame that came, where newer ones had overtaken it.
  std::optional<std::int64_t> overtaken_utime;
};

/// The objects of each camera that hs-pose --follow follows from frame to frame. Each is registered from its predicted
/// pose (constant velocity; of rotations only what the last frame observed) for as long as the evidence lasts.
/// Detections come later and less often: they add objects, replace lost ones, and update the score of the followed
/// ones. Now and then a followed object is estimated as if it were new, since registration from the last pose alone
/// never corrects a wrong rotation. Every function may be called from any thread; process_detections() keeps follow()
/// waiting for short steps only.
class ObjectFollower {
 public:
  /// Throws InputError for settings out of their range.
  explicit ObjectFollower(FollowerSettings settings = {});

  /// Returns the followed objects in the newest frame of a camera, in the order in which they were found; each has no
  /// detection, and a reason where its pose is withheld. A lost object is reported once more, with its reason, and is
  /// gone from the next frame on. Returns nothing for a frame that newer ones have overtaken on its way. Objects are
  /// followed on where stamps jump (a clock that is set, one wrong stamp). The stage's time, pose.following, is
  /// appended to `stages` of the frame.
  std::optional<ObjectPoses> follow(const PoseEstimator& estimator, const RgbdFrame& frame);

  /// Returns the poses of the detections of a frame that follow() has had: those of followed objects as they were then,
  /// those of others as PoseEstimator::estimate finds them. A found object is followed from the next frame on.
  ObjectPoses process_detections(const PoseEstimator& estimator, const RgbdFrame& frame, const Detections& detections);

  /// Returns what the followed objects have shown of the colours of the camera with this channel.
  CameraChroma camera_colours(const std::string& channel);

  /// Returns by how much later than its colours the camera with this channel takes depth, as objects that move before
  /// it have shown; nothing where that is not known (CameraLag::is_known).
  std::optional<CameraTiming> camera_timing(const std::string& channel);

 private:
  std::vector<FollowedPose> follow_all(const PoseEstimator& estimator, const RgbdFrame& frame,
                                       FollowedCamera& camera) const;
  void retry_without_pose(const PoseEstimator& estimator, const RgbdFrame& frame, FollowedCamera& camera,
                          std::vector<FollowedPose>& poses) const;
  bool is_retry_due(const FollowedObject& object, std::int64_t clock_us) const;
  void merge_retry(const ExpectedObject& expected, FollowedPose found, FollowedPose& pose) const;
  void update_object(const PoseEstimator& estimator, const FollowedPose& result, std::int64_t clock_us,
                     FollowedObject& object) const;
  void learn_appearance(const PoseEstimator& estimator, const RgbdFrame& frame, bool is_refined,
                        FollowedObject& object) const;
  void remove_lost(const PoseEstimator& estimator, const RgbdFrame& frame, FollowedCamera& camera,
                   FollowedFrame& followed_frame) const;
  bool is_lost(const FollowedObject& object, const FollowedPose& result, std::int64_t clock_us) const;
  void add_object(const PoseEstimator& estimator, const RgbdFrame& frame, const ObjectPose& pose,
                  FollowedCamera& camera);
  static void propagate_to_latest(std::int64_t utime, const FollowedCamera& camera, FollowedObject& found);

  FollowerSettings settings_;
  std::mutex mutex_;
  std::map<std::string, FollowedCamera> cameras_;  // cameras by channel
  std::int64_t next_number_ = 0;
};

}  // namespace houghstream
