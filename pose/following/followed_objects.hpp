#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "pose/following/follow.hpp"
#include "pose/motion/smoothed_velocity.hpp"

namespace houghstream {

/// When what is followed is given up, and which detection is of it.
struct FollowerSettings {
  FollowSettings follow;            ///< how one object is found again in one frame
  int most_failures = 3;            ///< frames one after the other without evidence: it is lost
  float least_kept_quality = 0.3F;  ///< a pose that is withheld is followed on from this quality on
  double longest_withheld_s = 1.0;  ///< but no longer without a valid pose
  double longest_hidden_s = 2.0;    ///< the same while it is hidden
  double reach_m = 0.07;          ///< between a detection's centre and a followed pose of its class: it is of that one
  double apart = 0.5;             ///< of the smaller radius: closer together two objects are one
  double score_gain = 0.3;        ///< how much one look moves the score's log odds
  float missed_score = 0.3F;      ///< what a look is worth that does not find an object in full view...
  double missed_after_s = 1.0;    ///< ...once none has found it for so long
  double doubted_after_s = 0.15;  ///< a detection's pose is looked for anew, beside the followed one...
  double better_log_odds = 0.3;   ///< ...and takes its place where its quality is so much better
  double speed_gain = 0.5;        ///< how much the last step moves the speed
};

/// An object that is followed from frame to frame of one camera. Its times are on the camera's clock
/// (FollowedCamera::ahead_us).
struct FollowedObject {
  std::int64_t number = 0;  ///< in the order in which they were found
  int class_id = 0;
  std::string class_name;
  double log_odds = 0.0;                                              ///< of its detections' scores
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();  ///< metres
  std::int64_t clock_us = 0;                                          ///< of the frame in which it was there
  SmoothedVelocity velocity;
  std::int64_t valid_us = 0;    ///< of its last valid pose
  std::int64_t found_us = 0;    ///< of its last detection
  std::int64_t doubted_us = 0;  ///< when it was last looked for as if it were not followed
  int failures = 0;
  std::optional<Verification> verified;  ///< of the last rendering
};

/// A frame's poses, and whose they are.
struct ShownFrame {
  std::int64_t utime = 0;     ///< names it
  std::int64_t clock_us = 0;  ///< when it was taken, on the camera's clock
  std::vector<std::int64_t> numbers;
  std::vector<FollowedPose> poses;
};

/// What is remembered of a camera.
struct FollowedCamera {
  std::vector<FollowedObject> objects;
  std::deque<ShownFrame> shown;  ///< the last ones
  std::int64_t frames = 0;
  /// The camera's clock minus its frames' utimes, which jump where the host's clock is set or a stamp is wrong. The
  /// camera's clock does not.
  std::int64_t ahead_us = 0;
  std::int64_t interval_us = 0;                 ///< from the frame before to the last one
  std::optional<std::int64_t> overtaken_utime;  ///< of the last frame that came, where newer ones had overtaken it
};

}  // namespace houghstream
