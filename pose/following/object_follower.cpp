#include "pose/following/object_follower.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "pipeline/base/check_settings.hpp"
#include "pipeline/base/logit.hpp"
#include "pipeline/types/frame_id.hpp"
#include "pipeline/types/frame_results.hpp"
#include "pipeline/types/frame_time.hpp"
#include "pose/motion/twist.hpp"
#include "pose/verification/pose_decision.hpp"

namespace houghstream {
namespace {

constexpr std::int64_t kJumpUs = 10'000'000;        // interval to a later frame; a camera may be away for a moment
constexpr std::int64_t kMaxIntervalUs = 1'000'000;  // interval between frames of which one follows the other

/// Returns whether newer frames have overtaken this one on its way. Where the frame before it seemed overtaken too, and
/// was older, the clock was set back.
bool is_overtaken(std::int64_t utime, FollowedCamera& camera) {
  if (camera.recent_frames.empty()) return false;
  const double passed_s = seconds_between(camera.recent_frames.back().utime, utime);
  const bool is_older = passed_s < 0.0 && passed_s >= -kMaxOvertakenS;
  const bool is_set_back = camera.overtaken_utime && *camera.overtaken_utime < utime;
  camera.overtaken_utime.reset();
  if (is_older && !is_set_back) camera.overtaken_utime = utime;
  return camera.overtaken_utime.has_value();
}

/// Advances the camera's clock by the interval of the frame before where utimes jump.
void advance_clock(std::int64_t utime, FollowedCamera& camera) {
  if (camera.recent_frames.empty()) return;
  const FollowedFrame& last = camera.recent_frames.back();
  const std::int64_t passed_us = microseconds_between(last.utime, utime);
  if (passed_us >= 0 && passed_us <= kJumpUs) {
    camera.interval_us = std::min(passed_us, kMaxIntervalUs);
  } else {
    camera.clock_offset_us = microseconds_between(utime, shifted(last.clock_us, camera.interval_us));
  }
}

std::int64_t to_camera_time(std::int64_t utime, const FollowedCamera& camera) {
  return shifted(utime, camera.clock_offset_us);
}

/// Returns a digest of every fourth row: sensor noise makes those of two measurements differ. A polynomial in each of a
/// few lanes, so that vector units can compute it.
std::uint64_t depth_digest(const cv::Mat& depth) {
  constexpr int kEvery = 4;
  std::array<std::uint64_t, 8> lanes{};
  const auto add = [&](const char* bytes, std::size_t size) {
    std::array<std::uint64_t, 8> values{};
    std::memcpy(values.data(), bytes, size);
    for (std::size_t i = 0; i < lanes.size(); ++i) lanes[i] = (lanes[i] << 5U) - lanes[i] + values[i];
  };
  for (int row = 0; row < depth.rows; row += kEvery) {
    const auto* bytes = depth.ptr<char>(row);
    const std::size_t size = static_cast<std::size_t>(depth.cols) * depth.elemSize();
    std::size_t done = 0;
    for (; done + sizeof(lanes) <= size; done += sizeof(lanes)) add(bytes + done, sizeof(lanes));
    add(bytes + done, size - done);
  }
  std::uint64_t digest = 0;
  for (const std::uint64_t lane : lanes) digest = digest * 31 + lane;
  return digest;
}

/// Notes the time of the first frame that had this frame's depth, since a camera may repeat an image of depth.
void update_depth_time(const RgbdFrame& frame, std::int64_t clock_us, FollowedCamera& camera) {
  const std::uint64_t digest = depth_digest(frame.depth);
  const bool is_repeated = !camera.recent_frames.empty() && digest == camera.depth_digest;
  if (!is_repeated) camera.depth_us = clock_us;
  camera.depth_digest = digest;
}

float probability(double odds) {
  return static_cast<float>(logistic(odds));
}

ExpectedObject make_expected_object(const Eigen::Isometry3d& T_camera_object, const FollowedObject& object) {
  ExpectedObject expected;
  expected.class_id = object.class_id;
  expected.class_name = object.class_name;
  expected.score = probability(object.score_logit);
  expected.initial_poses = {T_camera_object};
  expected.texture_probability = object.texture_probability;
  expected.shape_quality = object.shape_quality;
  expected.appearance = object.appearance;
  return expected;
}

DepthLag depth_lag(double seconds, const SmoothedVelocity& velocity) {
  DepthLag lag;
  lag.rotation_rad = seconds * velocity.angular_velocity();
  lag.shift_m = seconds * velocity.linear_velocity();
  return lag;
}

/// Returns the map by which the object's colours are judged.
ChromaMap colours_for(const FollowedObject& object, const PoseEstimator& estimator, const FollowedCamera& camera) {
  if (!estimator.settings().learn_camera_colours) return {};
  if (camera.is_colourless) return colourless_camera();
  return camera.colours.map_without(object.class_name);
}

/// Learns the lag of poses that are surely right: others are not where colours or depth show the object.
void learn_lag(const FollowedFrame& followed_frame, double deviation_s, CameraLag& lag) {
  constexpr float kSure = 0.9F;
  for (const FollowedPose& followed : followed_frame.poses) {
    if (has_pose(followed.pose.status) && followed.pose.shape_quality >= kSure) lag.update(followed.lag, deviation_s);
  }
}

}  // namespace

ObjectFollower::ObjectFollower(FollowerSettings settings) : settings_(settings) {
  check_settings(settings_, "settings of a follower");
}

std::optional<ObjectPoses> ObjectFollower::follow(const PoseEstimator& estimator, const RgbdFrame& frame) {
  constexpr std::size_t kRecentFrames = 32;  // number of frames; a detector's answer comes a few frames late
  const std::lock_guard<std::mutex> lock(mutex_);
  StageClock clock;
  FollowedCamera& camera = cameras_[frame.id.channel];
  if (is_overtaken(frame.id.utime, camera)) return std::nullopt;
  advance_clock(frame.id.utime, camera);
  const std::int64_t clock_us = to_camera_time(frame.id.utime, camera);
  camera.is_colourless = is_colourless(frame.colour);
  update_depth_time(frame, clock_us, camera);
  if (!camera.lag) camera.lag.emplace(settings_.depth_lag_s);
  FollowedFrame followed_frame{frame.id.utime, clock_us, {}, follow_all(estimator, frame, camera)};
  for (std::size_t i = 0; i < camera.objects.size(); ++i) {
    update_object(estimator, followed_frame.poses[i], clock_us, camera.objects[i]);
    if (has_pose(followed_frame.poses[i].pose.status))
      learn_appearance(estimator, frame, followed_frame.poses[i].is_refined, camera.objects[i]);
    followed_frame.numbers.push_back(camera.objects[i].number);
  }
  if (camera.depth_us == clock_us) learn_lag(followed_frame, settings_.depth_lag_s, *camera.lag);
  remove_lost(estimator, frame, camera, followed_frame);
  ++camera.frames;
  ObjectPoses result{frame.id, {}, frame.stages};
  for (const FollowedPose& followed : followed_frame.poses) result.poses.push_back(followed.pose);
  if (!camera.is_colourless) camera.colours.update(result);
  camera.recent_frames.push_back(std::move(followed_frame));
  if (camera.recent_frames.size() > kRecentFrames) camera.recent_frames.pop_front();
  clock.mark(kFollowingStage);
  result.stages.push_back(clock.times().front());
  return result;
}

/// Follows each object from its pose at constant velocity, and retries the objects that are not found there.
std::vector<FollowedPose> ObjectFollower::follow_all(const PoseEstimator& estimator, const RgbdFrame& frame,
                                                     FollowedCamera& camera) const {
  constexpr double kMaxPrediction_s = 0.25;  // a velocity predicts nothing beyond this interval
  constexpr double kMaxDepthAge_s = 0.1;     // an image that repeats for longer is frozen, colours included
  // Refined and rendered in one frame of so many, not all objects in the same one.
  constexpr std::int64_t kRefineEvery = 4;
  const std::int64_t clock_us = to_camera_time(frame.id.utime, camera);
  const double lag_s = settings_.depth_lag_s + std::min(kMaxDepthAge_s, seconds_between(camera.depth_us, clock_us));
  std::vector<ExpectedObject> expected;
  for (const FollowedObject& object : camera.objects) {
    const double dt = seconds_between(object.clock_us, clock_us);
    const double predicted_s = dt <= kMaxPrediction_s ? dt : 0.0;
    const bool refine_by_texture = (camera.frames + object.number) % kRefineEvery == 0;
    ExpectedObject& next = expected.emplace_back(
        make_expected_object(object.velocity.predict(object.T_camera_object, predicted_s), object));
    next.refine_by_texture = refine_by_texture;
    next.depth_lag = depth_lag(lag_s, object.velocity);
    if (!refine_by_texture) {
      next.verified = object.verified;
      next.colours = object.colours;
    }
    next.camera_colours = colours_for(object, estimator, camera);
  }
  std::vector<FollowedPose> poses = follow_objects(estimator, settings_.follow, frame, expected);
  retry_without_pose(estimator, frame, camera, poses);
  return poses;
}

/// Retries objects without a valid pose from their last place, and from where the camera's motion has brought them.
void ObjectFollower::retry_without_pose(const PoseEstimator& estimator, const RgbdFrame& frame, FollowedCamera& camera,
                                        std::vector<FollowedPose>& poses) const {
  const std::int64_t clock_us = to_camera_time(frame.id.utime, camera);
  std::vector<Eigen::Isometry3d> motions;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (has_pose(poses[i].pose.status))
      motions.push_back(poses[i].T_camera_object * camera.objects[i].T_camera_object.inverse());
  }
  std::vector<std::size_t> retried;
  std::vector<ExpectedObject> expected;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (has_pose(poses[i].pose.status)) continue;
    FollowedObject& object = camera.objects[i];
    const std::optional<Eigen::Isometry3d> carried = predict_by_camera_motion(object.T_camera_object, motions);
    if (!is_retry_due(object, clock_us)) {
      if (poses[i].pose.shape_quality < settings_.min_kept_quality)
        poses[i].T_camera_object = carried.value_or(object.T_camera_object);
      continue;
    }
    object.retry_us = clock_us;
    ExpectedObject again = make_expected_object(object.T_camera_object, object);
    again.refine_by_texture = true;
    again.is_lost = true;
    again.camera_colours = colours_for(object, estimator, camera);
    // A camera that stands carries an object to where it was: the two are one place then, and searched once.
    const auto model = estimator.models().find(object.class_name);
    const bool is_elsewhere =
        carried && model != estimator.models().end() && !is_same_place(model->second, object.T_camera_object, *carried);
    if (is_elsewhere) again.initial_poses.insert(again.initial_poses.begin(), *carried);
    if (carried && !is_elsewhere) again.initial_poses = {*carried};
    // An object that stands was expected there the first time too, which has tested its occlusion.
    again.check_occlusion = is_elsewhere || !object.velocity.is_zero();
    retried.push_back(i);
    expected.push_back(std::move(again));
  }
  if (retried.empty()) return;
  std::vector<FollowedPose> found = follow_objects(estimator, settings_.follow, frame, expected);
  for (std::size_t k = 0; k < retried.size(); ++k) merge_retry(expected[k], std::move(found[k]), poses[retried[k]]);
}

/// Returns whether an object without a valid pose is registered a second time in this frame: always when it was valid
/// in the previous frame or failed there (FollowedObject::failures), else every retry_interval_s.
bool ObjectFollower::is_retry_due(const FollowedObject& object, std::int64_t clock_us) const {
  return object.valid_us == object.clock_us || object.failures > 0 ||
         seconds_between(object.retry_us, clock_us) >= settings_.retry_interval_s;
}

/// Replaces the result of the first attempt by that of the second where this one is better.
void ObjectFollower::merge_retry(const ExpectedObject& expected, FollowedPose found, FollowedPose& pose) const {
  const PoseStatus before = pose.pose.status;
  const PoseStatus after = found.pose.status;
  const bool better = found.pose.shape_quality > pose.pose.shape_quality;
  if (better) pose = std::move(found);
  if (has_pose(pose.pose.status)) return;
  if (before == PoseStatus::kOccluded || (!better && after == PoseStatus::kOccluded))
    pose.pose.status = PoseStatus::kOccluded;
  if (pose.pose.shape_quality < settings_.min_kept_quality) pose.T_camera_object = expected.initial_poses.front();
}

/// Updates the object's pose, velocity, times and failures from the result of this frame. Without evidence it stays
/// where it was, or where the camera's motion has brought it.
void ObjectFollower::update_object(const PoseEstimator& estimator, const FollowedPose& result, std::int64_t clock_us,
                                   FollowedObject& object) const {
  const bool valid = has_pose(result.pose.status);
  const bool kept = valid || result.pose.shape_quality >= settings_.min_kept_quality;
  const double dt = seconds_between(object.clock_us, clock_us);
  if (valid && dt > 0.0)
    object.velocity.update(object.T_camera_object, result.T_camera_object, dt, settings_.velocity_gain);
  if (!kept) object.velocity.reset();
  const auto model = estimator.models().find(object.class_name);
  if (valid && model != estimator.models().end()) {
    object.velocity.limit_rotation(observed_rotation(result.information, model->second.radius, settings_.follow.joint));
  }
  object.failures = kept || result.pose.status == PoseStatus::kOccluded ? 0 : object.failures + 1;
  object.T_camera_object = orthonormalised(result.T_camera_object);
  object.verified = result.verified;
  object.colours = result.colours;
  object.clock_us = clock_us;
  if (valid) object.valid_us = clock_us;
  if (valid && result.has_depth) object.shape_quality = result.pose.shape_quality;
  if (result.silhouette) object.appearance.silhouette = result.silhouette;
}

/// Learns colours and texture at the object's pose. Texture is kept from one refined frame to the next, so that it does
/// not drift in between.
void ObjectFollower::learn_appearance(const PoseEstimator& estimator, const RgbdFrame& frame, bool is_refined,
                                      FollowedObject& object) const {
  const JointSettings& settings = settings_.follow.joint;
  const auto found = estimator.models().find(object.class_name);
  if (found == estimator.models().end() || settings.region.lines == 0) return;
  const ObjectModel& model = found->second;
  const RegionView view{frame, model, estimator.settings().noise};
  const Eigen::Isometry3d& T = object.T_camera_object;
  FollowedAppearance& known = object.appearance;
  if (!known.silhouette || !is_silhouette_of(*known.silhouette, model, T))
    known.silhouette = std::make_shared<const Silhouette>(make_silhouette(model, T, settings.region.lines));
  auto colours =
      known.colours ? std::make_shared<ColourStatistics>(*known.colours) : std::make_shared<ColourStatistics>();
  learn_colours(view, *known.silhouette, T, settings.region, *colours);
  if (!colours->empty()) known.colours = std::move(colours);
  if (settings.texture.points == 0 || (known.texture && !is_refined)) return;
  const BrightnessImage image = make_brightness(frame, silhouette_box(view, *known.silhouette, T));
  known.texture = std::make_shared<const TextureKeyframe>(make_texture_keyframe(view, image, T, settings.texture));
}

/// Removes lost objects, and the weaker of two that have become one.
void ObjectFollower::remove_lost(const PoseEstimator& estimator, const RgbdFrame& frame, FollowedCamera& camera,
                                 FollowedFrame& followed_frame) const {
  std::vector<bool> lost(camera.objects.size());
  for (std::size_t i = 0; i < lost.size(); ++i)
    lost[i] = is_lost(camera.objects[i], followed_frame.poses[i], followed_frame.clock_us);
  for (std::size_t i = 0; i < lost.size(); ++i) {
    for (std::size_t j = i + 1; j < lost.size(); ++j) {
      const FollowedPose& a = followed_frame.poses[i];
      const FollowedPose& b = followed_frame.poses[j];
      if (lost[i] || lost[j] || !a.pose.T_camera_object || !b.pose.T_camera_object) continue;
      const PlacedObject here{a.pose.class_name, a.T_camera_object};
      if (!estimator.is_same_object(frame, here, {b.pose.class_name, b.T_camera_object})) continue;
      const bool is_first_weaker = a.pose.shape_quality < b.pose.shape_quality;
      const std::size_t weaker = is_first_weaker ? i : j;
      lost[weaker] = true;
      withhold_duplicate(is_first_weaker ? b.pose : a.pose, followed_frame.poses[weaker].pose);
    }
  }
  for (std::size_t i = lost.size(); i-- > 0;) {
    if (lost[i]) camera.objects.erase(camera.objects.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

bool ObjectFollower::is_lost(const FollowedObject& object, const FollowedPose& result, std::int64_t clock_us) const {
  const bool is_occluded = result.pose.status == PoseStatus::kOccluded;
  const double timeout_s = is_occluded ? settings_.max_hidden_s : settings_.max_rejected_s;
  return object.failures >= settings_.max_failures || result.pose.status == PoseStatus::kNoModel ||
         seconds_between(object.valid_us, clock_us) > timeout_s;
}

namespace {

/// A frame's detections, associated with the objects that were followed in it.
struct DetectionAssociation {
  FollowedFrame followed_frame;
  std::vector<int> matches;  ///< index into `followed_frame` of each detection's object, or -1
  /// Index into `followed_frame` of the object that is estimated again as if it were not followed, or -1.
  int recheck = -1;

  bool needs_estimate(std::size_t detection) const { return matches[detection] < 0 || matches[detection] == recheck; }
};

/// Returns the object of a number, or null where it is not followed any more.
FollowedObject* find_followed(std::int64_t number, FollowedCamera& camera) {
  const auto found = std::find_if(camera.objects.begin(), camera.objects.end(),
                                  [&](const FollowedObject& one) { return one.number == number; });
  return found == camera.objects.end() ? nullptr : &*found;
}

/// Returns each detection's index into `followed_frame`, or -1. The nearest pairs come first and each pose belongs to
/// one detection; withheld poses belong to none.
std::vector<int> match_detections(const PoseEstimator& estimator, const Detections& detections,
                                  const FollowedFrame& followed_frame, double reach_m) {
  struct Pair {
    double distance = 0.0;
    std::size_t detection = 0;
    std::size_t pose = 0;
  };
  std::vector<Pair> pairs;
  for (std::size_t d = 0; d < detections.detections.size(); ++d) {
    for (std::size_t p = 0; p < followed_frame.poses.size(); ++p) {
      const ObjectPose& pose = followed_frame.poses[p].pose;
      const Detection& detection = detections.detections[d];
      if (!pose.T_camera_object || pose.class_name != detection.class_name) continue;
      const Eigen::Vector3d centre = estimator.vote_centre({pose.class_name, *pose.T_camera_object});
      const double distance = (centre - detection.centre_camera.cast<double>()).norm();
      if (distance <= reach_m) pairs.push_back({distance, d, p});  // false for NaN
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  std::vector<int> matches(detections.detections.size(), -1);
  std::vector<bool> taken(followed_frame.poses.size());
  for (const Pair& pair : pairs) {
    if (matches[pair.detection] >= 0 || taken[pair.pose]) continue;
    matches[pair.detection] = static_cast<int>(pair.pose);
    taken[pair.pose] = true;
  }
  return matches;
}

/// Updates the scores of the objects that were followed: each is found with a score, or is missed though in full view.
/// What occludes an object lowers its detections' scores, and says nothing against it.
void update_from_detections(const Detections& detections, const DetectionAssociation& association,
                            const FollowerSettings& settings, FollowedCamera& camera) {
  constexpr float kFullView = 0.7F;  // visible fraction
  const FollowedFrame& followed_frame = association.followed_frame;
  for (std::size_t p = 0; p < followed_frame.poses.size(); ++p) {
    FollowedObject* object = find_followed(followed_frame.numbers[p], camera);
    if (object == nullptr) continue;
    const auto found = std::find(association.matches.begin(), association.matches.end(), static_cast<int>(p));
    double score = settings.miss_score;
    if (found != association.matches.end()) {
      score = detections.detections[static_cast<std::size_t>(found - association.matches.begin())].score;
      object->found_us = followed_frame.clock_us;
    } else if (seconds_between(object->found_us, followed_frame.clock_us) < settings.missed_after_s) {
      continue;
    }
    const double difference = logit(score) - object->score_logit;
    if (difference < 0.0 && followed_frame.poses[p].pose.visible_fraction < kFullView) continue;
    object->score_logit += settings.logit_gain * difference;
  }
}

/// Returns the index into `followed_frame` of the detected object whose recheck is most overdue, or -1 where none is
/// due. A doubtful pose is rechecked more often: one that following started the wrong way round stays so until then.
int choose_recheck(const DetectionAssociation& association, const FollowerSettings& settings, FollowedCamera& camera) {
  constexpr double kDoubtfulWeight = 3.0;
  const FollowedFrame& followed_frame = association.followed_frame;
  FollowedObject* selected = nullptr;
  int place = -1;
  double longest_s = 0.0;
  for (const int match : association.matches) {
    FollowedObject* object =
        match >= 0 ? find_followed(followed_frame.numbers[static_cast<std::size_t>(match)], camera) : nullptr;
    if (object == nullptr) continue;
    const bool is_doubtful =
        followed_frame.poses[static_cast<std::size_t>(match)].pose.quality < settings.doubtful_quality;
    const double waited_s = seconds_between(object->recheck_us, followed_frame.clock_us);
    if (waited_s < (is_doubtful ? 0.0 : settings.recheck_interval_s)) continue;
    const double weighted_s = (is_doubtful ? kDoubtfulWeight : 1.0) * waited_s;
    if (selected != nullptr && weighted_s <= longest_s) continue;
    selected = object;
    place = match;
    longest_s = weighted_s;
  }
  if (selected != nullptr) selected->recheck_us = followed_frame.clock_us;
  return place;
}

/// Associates the detections of a frame with the objects that were followed in it. Updates their scores
/// (update_from_detections), and notes the one that is rechecked.
DetectionAssociation associate_detections(const PoseEstimator& estimator, const Detections& detections,
                                          const FollowerSettings& settings, FollowedCamera& camera) {
  DetectionAssociation association{{}, std::vector<int>(detections.detections.size(), -1), -1};
  const auto earlier_frame =
      std::find_if(camera.recent_frames.rbegin(), camera.recent_frames.rend(),
                   [&](const FollowedFrame& one) { return one.utime == detections.frame.utime; });
  if (earlier_frame == camera.recent_frames.rend()) return association;
  association.followed_frame = *earlier_frame;
  association.matches = match_detections(estimator, detections, association.followed_frame, settings.reach_m);
  update_from_detections(detections, association, settings, camera);
  association.recheck = choose_recheck(association, settings, camera);
  return association;
}

/// Returns the followed poses that are not estimated again.
ObjectPoses known_poses(const DetectionAssociation& association) {
  ObjectPoses known;
  for (std::size_t i = 0; i < association.followed_frame.poses.size(); ++i) {
    if (static_cast<int>(i) != association.recheck) known.poses.push_back(association.followed_frame.poses[i].pose);
  }
  return known;
}

/// Withholds the pose of a detection where an object of its class was followed already, which has a pose.
void withhold_where_followed(const PoseEstimator& estimator, const FollowedFrame& followed_frame, ObjectPose& pose) {
  const PlacedObject here{pose.class_name, *pose.T_camera_object};
  for (const FollowedPose& followed : followed_frame.poses) {
    if (!followed.pose.T_camera_object || followed.pose.class_name != pose.class_name) continue;
    if (estimator.is_duplicate(here, {pose.class_name, *followed.pose.T_camera_object}))
      return withhold_duplicate(followed.pose, pose);
  }
}

/// Continues an object from a detection's pose where that is better than the followed one of its frame: the motion
/// between the two frames stays the same in the object's own frame.
void adopt_better_pose(const ObjectPose& pose, const FollowedPose& followed, const FollowerSettings& settings,
                       FollowedObject& object) {
  // Quality is compared by shape alone, or with texture, which following does not examine.
  const double by_shape =
      logit(pose.shape_quality, kQualityMargin) - logit(followed.pose.shape_quality, kQualityMargin);
  const double by_all = logit(pose.quality, kQualityMargin) - logit(followed.pose.quality, kQualityMargin);
  if (std::max(by_shape, by_all) < settings.better_log_odds) return;
  object.T_camera_object =
      orthonormalised(object.T_camera_object * followed.T_camera_object.inverse() * *pose.T_camera_object);
  object.texture_probability = texture_probability_of(pose);
  object.appearance.texture.reset();  // the keyframe was made at the wrong pose, and so were outline and colours
  object.verified.reset();
  object.colours.reset();
}

}  // namespace

ObjectPoses ObjectFollower::process_detections(const PoseEstimator& estimator, const RgbdFrame& frame,
                                               const Detections& detections) {
  DetectionAssociation association;
  std::vector<ChromaPair> remembered;
  ObjectPoses rejected;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    FollowedCamera& camera = cameras_[detections.frame.channel];
    association = associate_detections(estimator, detections, settings_, camera);
    remembered = camera.colours.pairs();
    rejected.poses.swap(camera.rejected);
  }
  Detections to_estimate{detections.frame, {}, detections.stages};
  for (std::size_t i = 0; i < detections.detections.size(); ++i) {
    if (association.needs_estimate(i)) to_estimate.detections.push_back(detections.detections[i]);
  }
  ObjectPoses found = estimator.estimate(frame, to_estimate, rejected, remembered, known_poses(association));
  ObjectPoses result{detections.frame, {}, found.stages};
  const std::lock_guard<std::mutex> lock(mutex_);
  FollowedCamera& camera = cameras_[detections.frame.channel];
  std::size_t next = 0;
  for (std::size_t i = 0; i < detections.detections.size(); ++i) {
    ObjectPose pose = association.needs_estimate(i) ? std::move(found.poses[next++]) : ObjectPose();
    if (pose.T_camera_object && association.matches[i] < 0)
      withhold_where_followed(estimator, association.followed_frame, pose);
    if (association.matches[i] >= 0) {
      const auto place = static_cast<std::size_t>(association.matches[i]);
      FollowedObject* object = find_followed(association.followed_frame.numbers[place], camera);
      if (pose.T_camera_object && object != nullptr)
        adopt_better_pose(pose, association.followed_frame.poses[place], settings_, *object);
      pose = association.followed_frame.poses[place].pose;
    } else if (pose.T_camera_object) {
      add_object(estimator, frame, pose, camera);
    } else if (pose.rejected_search) {
      camera.rejected.push_back(pose);
    }
    pose.detection_index = static_cast<int>(i);
    pose.detection_score = detections.detections[i].score;
    result.poses.push_back(std::move(pose));
  }
  return result;
}

/// Adds an object in place of a withheld one of its class, or of a less certain one of another class. Where one of its
/// class is followed there, it is known already.
void ObjectFollower::add_object(const PoseEstimator& estimator, const RgbdFrame& frame, const ObjectPose& pose,
                                FollowedCamera& camera) {
  FollowedObject found;
  found.number = next_number_++;
  found.class_id = pose.class_id;
  found.class_name = pose.class_name;
  found.score_logit = logit(pose.detection_score);
  found.texture_probability = texture_probability_of(pose);
  found.T_camera_object = *pose.T_camera_object;
  const auto earlier_frame =
      std::find_if(camera.recent_frames.rbegin(), camera.recent_frames.rend(),
                   [&](const FollowedFrame& followed_frame) { return followed_frame.utime == frame.id.utime; });
  found.clock_us =
      earlier_frame == camera.recent_frames.rend() ? to_camera_time(frame.id.utime, camera) : earlier_frame->clock_us;
  found.valid_us = found.found_us = found.recheck_us = found.clock_us;
  found.shape_quality = pose.shape_quality;
  learn_appearance(estimator, frame, true, found);
  propagate_to_latest(frame.id.utime, camera, found);
  const PlacedObject here{found.class_name, found.T_camera_object};
  std::vector<FollowedObject> others;
  for (const FollowedObject& object : camera.objects) {
    const bool is_here = estimator.is_duplicate(here, {object.class_name, object.T_camera_object});
    const bool is_valid = object.valid_us == object.clock_us;
    if (is_here && is_valid && object.class_name == found.class_name) return;
    if (!is_here || is_valid) others.push_back(object);  // follow() removes the weaker of two valid ones
  }
  camera.objects = std::move(others);
  camera.objects.push_back(std::move(found));
}

/// Moves an object that was found in an earlier frame as the camera has moved since, as far as that is known.
void ObjectFollower::propagate_to_latest(std::int64_t utime, const FollowedCamera& camera, FollowedObject& found) {
  const auto earlier_frame = std::find_if(camera.recent_frames.rbegin(), camera.recent_frames.rend(),
                                          [&](const FollowedFrame& one) { return one.utime == utime; });
  if (earlier_frame == camera.recent_frames.rend() || earlier_frame == camera.recent_frames.rbegin()) return;
  const FollowedFrame& now = camera.recent_frames.back();
  std::vector<Eigen::Isometry3d> motions;
  for (std::size_t i = 0; i < now.poses.size(); ++i) {
    const auto place = std::find(earlier_frame->numbers.begin(), earlier_frame->numbers.end(), now.numbers[i]);
    if (place == earlier_frame->numbers.end()) continue;
    const FollowedPose& before = earlier_frame->poses[static_cast<std::size_t>(place - earlier_frame->numbers.begin())];
    if (!before.pose.T_camera_object || !now.poses[i].pose.T_camera_object) continue;
    motions.push_back(now.poses[i].T_camera_object * before.T_camera_object.inverse());
  }
  const std::optional<Eigen::Isometry3d> carried = predict_by_camera_motion(found.T_camera_object, motions);
  if (!carried) return;
  found.T_camera_object = *carried;
  found.clock_us = found.valid_us = now.clock_us;
}

CameraChroma ObjectFollower::camera_colours(const std::string& channel) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto camera = cameras_.find(channel);
  return camera == cameras_.end() ? CameraChroma{} : camera->second.colours.chroma();
}

std::optional<CameraTiming> ObjectFollower::camera_timing(const std::string& channel) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = cameras_.find(channel);
  if (found == cameras_.end() || found->second.recent_frames.empty()) return std::nullopt;
  const CameraLag& lag = *found->second.lag;
  if (!lag.is_known()) return std::nullopt;
  return CameraTiming{{channel, found->second.recent_frames.back().utime}, lag.seconds(), lag.sigma_s()};
}

}  // namespace houghstream
