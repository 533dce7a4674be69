#include "pose/following/object_follower.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/types/frame_id.hpp"
#include "pipeline/types/frame_results.hpp"
#include "pose/following/motion.hpp"

namespace houghstream {
namespace {

double log_odds(double probability, double margin) {
  const double p = std::clamp(probability, margin, 1.0 - margin);
  return std::log(p / (1.0 - p));
}

/// A score of exactly 0 or 1 is not certainty.
double score_log_odds(double score) {
  return log_odds(score, 1e-3);
}

/// Beside another one's of the same object, where small differences count.
double quality_log_odds(double quality) {
  return log_odds(quality, 1e-6);
}

float probability(double odds) {
  return static_cast<float>(1.0 / (1.0 + std::exp(-odds)));
}

}  // namespace

ObjectPoses ObjectFollower::follow(const PoseEstimator& estimator, const RgbdFrame& frame) {
  constexpr std::size_t kShown = 32;  // frames; a detector's answer takes a few
  const std::lock_guard<std::mutex> lock(mutex_);
  StageClock clock;
  Camera& camera = cameras_[frame.id.channel];
  if (!camera.shown.empty() && frame.id.utime < camera.shown.back().utime) camera = Camera();
  Shown shown{frame.id.utime, {}, follow_all(estimator, frame, camera)};
  for (std::size_t i = 0; i < camera.objects.size(); ++i) {
    note_result(shown.poses[i], frame.id.utime, camera.objects[i]);
    shown.numbers.push_back(camera.objects[i].number);
  }
  give_up(estimator, camera, shown);
  ++camera.frames;
  ObjectPoses result{frame.id, {}, frame.stages};
  for (const FollowedPose& followed : shown.poses) result.poses.push_back(followed.pose);
  camera.shown.push_back(std::move(shown));
  if (camera.shown.size() > kShown) camera.shown.pop_front();
  clock.mark(kFollowingStage);
  result.stages.push_back(clock.times().front());
  return result;
}

/// Each from where it is expected at constant speed; those that are not found there once more.
std::vector<FollowedPose> ObjectFollower::follow_all(const PoseEstimator& estimator, const RgbdFrame& frame,
                                                     Camera& camera) const {
  constexpr double kLongest = 0.25;    // seconds; no speed says anything about a later frame
  constexpr std::int64_t kSettle = 4;  // settled and rendered in one frame of so many, not all objects in the same one
  std::vector<ExpectedObject> expected;
  for (const Followed& object : camera.objects) {
    const double dt = seconds_between(object.utime, frame.id.utime);
    const double used = dt <= kLongest ? dt : 0.0;
    const bool settle = (camera.frames + object.number) % kSettle == 0;
    expected.push_back({object.class_id,
                        object.class_name,
                        probability(object.log_odds),
                        {moved_on(object.T_camera_object, used * object.speed, used * object.turn_rate)},
                        settle,
                        false,
                        true,
                        settle ? std::nullopt : object.verified});
  }
  std::vector<FollowedPose> poses = estimator.follow(frame, expected);
  follow_again(estimator, frame, camera, poses);
  return poses;
}

/// Those without a valid pose from where they were last, and from where the camera's motion has brought them.
void ObjectFollower::follow_again(const PoseEstimator& estimator, const RgbdFrame& frame, const Camera& camera,
                                  std::vector<FollowedPose>& poses) const {
  std::vector<Eigen::Isometry3d> motions;
  std::vector<std::size_t> failed;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (poses[i].pose.status != PoseStatus::kValid) {
      failed.push_back(i);
    } else {
      motions.push_back(poses[i].T_camera_object * camera.objects[i].T_camera_object.inverse());
    }
  }
  if (failed.empty()) return;
  std::vector<ExpectedObject> expected;
  for (const std::size_t i : failed) {
    const Followed& object = camera.objects[i];
    const float score = probability(object.log_odds);
    ExpectedObject again{object.class_id, object.class_name, score, {object.T_camera_object}, true, true, true, {}};
    const std::optional<Eigen::Isometry3d> carried = carried_along(object.T_camera_object, motions);
    if (carried) again.starts.insert(again.starts.begin(), *carried);
    // What stands was expected there the first time too, and it has been told whether it is hidden there.
    again.tell_hidden = carried || !object.speed.isZero(0.0) || !object.turn_rate.isZero(0.0);
    expected.push_back(std::move(again));
  }
  std::vector<FollowedPose> found = estimator.follow(frame, expected);
  for (std::size_t k = 0; k < failed.size(); ++k) {
    FollowedPose& pose = poses[failed[k]];
    const PoseStatus before = pose.pose.status;
    const bool better = found[k].pose.quality > pose.pose.quality;
    if (better) pose = std::move(found[k]);
    if (pose.pose.status == PoseStatus::kValid) continue;
    if (before == PoseStatus::kOccluded || (!better && found[k].pose.status == PoseStatus::kOccluded)) {
      pose.pose.status = PoseStatus::kOccluded;
    }
    if (pose.pose.quality < settings_.least_kept_quality) pose.T_camera_object = expected[k].starts.front();
  }
}

/// Goes on from the result; without evidence it stays where it was, or where the camera's motion has brought it.
void ObjectFollower::note_result(const FollowedPose& result, std::int64_t utime, Followed& object) const {
  const bool valid = result.pose.status == PoseStatus::kValid;
  const bool kept = valid || result.pose.quality >= settings_.least_kept_quality;
  const double dt = seconds_between(object.utime, utime);
  if (valid && dt > 0.0) {
    const Eigen::Vector3d speed = (result.T_camera_object.translation() - object.T_camera_object.translation()) / dt;
    const Eigen::Vector3d turn_rate =
        turn_of(result.T_camera_object.linear() * object.T_camera_object.linear().transpose()) / dt;
    object.speed += settings_.speed_gain * (speed - object.speed);
    object.turn_rate += settings_.speed_gain * (turn_rate - object.turn_rate);
  }
  if (!kept) object.speed = object.turn_rate = Eigen::Vector3d::Zero();
  object.failures = kept || result.pose.status == PoseStatus::kOccluded ? 0 : object.failures + 1;
  object.T_camera_object = result.T_camera_object;
  object.verified = result.verified;
  object.utime = utime;
  if (valid) object.valid_utime = utime;
}

bool ObjectFollower::is_lost(const Followed& object, const FollowedPose& result, std::int64_t utime) const {
  const bool hidden = result.pose.status == PoseStatus::kOccluded;
  const double longest = hidden ? settings_.longest_hidden_s : settings_.longest_withheld_s;
  return object.failures >= settings_.most_failures || result.pose.status == PoseStatus::kNoModel ||
         seconds_between(object.valid_utime, utime) > longest;
}

/// What is lost, and the weaker of two that have become one.
void ObjectFollower::give_up(const PoseEstimator& estimator, Camera& camera, Shown& shown) const {
  std::vector<bool> lost(camera.objects.size());
  for (std::size_t i = 0; i < lost.size(); ++i) lost[i] = is_lost(camera.objects[i], shown.poses[i], shown.utime);
  for (std::size_t i = 0; i < lost.size(); ++i) {
    for (std::size_t j = i + 1; j < lost.size(); ++j) {
      const FollowedPose& a = shown.poses[i];
      const FollowedPose& b = shown.poses[j];
      if (lost[i] || lost[j] || !a.pose.T_camera_object || !b.pose.T_camera_object) continue;
      const PlacedObject here{a.pose.class_name, a.T_camera_object};
      if (!estimator.are_one(here, {b.pose.class_name, b.T_camera_object}, settings_.apart)) continue;
      const std::size_t weaker = a.pose.quality < b.pose.quality ? i : j;
      lost[weaker] = true;
      shown.poses[weaker].pose.T_camera_object.reset();
      shown.poses[weaker].pose.status = PoseStatus::kLowScore;
    }
  }
  for (std::size_t i = lost.size(); i-- > 0;) {
    if (lost[i]) camera.objects.erase(camera.objects.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

ObjectPoses ObjectFollower::answer(const PoseEstimator& estimator, const RgbdFrame& frame,
                                   const Detections& detections) {
  const Look look = begin_look(estimator, detections);
  Detections looked_for{detections.frame, {}, detections.stages};
  for (std::size_t i = 0; i < detections.detections.size(); ++i) {
    if (look.is_looked_for(i)) looked_for.detections.push_back(detections.detections[i]);
  }
  ObjectPoses found = estimator.estimate(frame, looked_for);
  ObjectPoses result{detections.frame, {}, found.stages};
  const std::lock_guard<std::mutex> lock(mutex_);
  Camera& camera = cameras_[detections.frame.channel];
  std::size_t next = 0;
  for (std::size_t i = 0; i < detections.detections.size(); ++i) {
    ObjectPose pose = look.is_looked_for(i) ? std::move(found.poses[next++]) : ObjectPose();
    if (look.matches[i] >= 0) {
      const auto place = static_cast<std::size_t>(look.matches[i]);
      Followed* object = find(look.shown.numbers[place], camera);
      if (pose.T_camera_object && object != nullptr) settle_doubt(pose, look.shown.poses[place], *object);
      pose = look.shown.poses[place].pose;
    } else if (pose.T_camera_object) {
      take_up(estimator, detections.frame, pose, camera);
    }
    pose.detection_index = static_cast<int>(i);
    pose.detection_score = detections.detections[i].score;
    result.poses.push_back(std::move(pose));
  }
  return result;
}

/// What was followed in the frame of the detections, and which of them are of that. Notes what the look says of it.
ObjectFollower::Look ObjectFollower::begin_look(const PoseEstimator& estimator, const Detections& detections) {
  Look look{{}, Matches(detections.detections.size(), -1), -1};
  const std::lock_guard<std::mutex> lock(mutex_);
  Camera& camera = cameras_[detections.frame.channel];
  const auto then = std::find_if(camera.shown.rbegin(), camera.shown.rend(),
                                 [&](const Shown& one) { return one.utime == detections.frame.utime; });
  if (then == camera.shown.rend()) return look;
  look.shown = *then;
  look.matches = match(estimator, detections, look.shown);
  note_look(detections, look.matches, look.shown, camera);
  look.doubted = choose_doubted(look.matches, look.shown, camera);
  return look;
}

ObjectFollower::Followed* ObjectFollower::find(std::int64_t number, Camera& camera) {
  const auto found = std::find_if(camera.objects.begin(), camera.objects.end(),
                                  [&](const Followed& one) { return one.number == number; });
  return found == camera.objects.end() ? nullptr : &*found;
}

/// The place in `shown` of the detected object whose last doubt lies farthest back, if it is time; else -1.
int ObjectFollower::choose_doubted(const Matches& matches, const Shown& shown, Camera& camera) const {
  Followed* chosen = nullptr;
  int place = -1;
  for (const int match : matches) {
    Followed* object = match >= 0 ? find(shown.numbers[static_cast<std::size_t>(match)], camera) : nullptr;
    if (object == nullptr || seconds_between(object->doubted_utime, shown.utime) < settings_.doubted_after_s) continue;
    if (chosen != nullptr && chosen->doubted_utime <= object->doubted_utime) continue;
    chosen = object;
    place = match;
  }
  if (chosen != nullptr) chosen->doubted_utime = shown.utime;
  return place;
}

/// Where the pose of a detection is better than the followed one of that frame, the object goes on from it: what is
/// between the two stays the same in the object's own frame.
void ObjectFollower::settle_doubt(const ObjectPose& pose, const FollowedPose& followed, Followed& object) const {
  const double better = quality_log_odds(pose.quality) - quality_log_odds(followed.pose.quality);
  if (better < settings_.better_log_odds) return;
  object.T_camera_object = object.T_camera_object * followed.T_camera_object.inverse() * *pose.T_camera_object;
}

/// The nearest ones first, each pose of one detection; withheld ones are nobody's.
ObjectFollower::Matches ObjectFollower::match(const PoseEstimator& estimator, const Detections& detections,
                                              const Shown& shown) const {
  struct Pair {
    double distance = 0.0;
    std::size_t detection = 0;
    std::size_t pose = 0;
  };
  std::vector<Pair> pairs;
  for (std::size_t d = 0; d < detections.detections.size(); ++d) {
    for (std::size_t p = 0; p < shown.poses.size(); ++p) {
      const ObjectPose& pose = shown.poses[p].pose;
      const Detection& detection = detections.detections[d];
      if (!pose.T_camera_object || pose.class_name != detection.class_name) continue;
      const Eigen::Vector3d centre = estimator.vote_centre({pose.class_name, *pose.T_camera_object});
      const double distance = (centre - detection.centre_camera.cast<double>()).norm();
      if (distance <= settings_.reach_m) pairs.push_back({distance, d, p});  // false for NaN
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  Matches matches(detections.detections.size(), -1);
  std::vector<bool> taken(shown.poses.size());
  for (const Pair& pair : pairs) {
    if (matches[pair.detection] >= 0 || taken[pair.pose]) continue;
    matches[pair.detection] = static_cast<int>(pair.pose);
    taken[pair.pose] = true;
  }
  return matches;
}

/// What the look says of those that were there: found, with this score, or not found though in full view.
void ObjectFollower::note_look(const Detections& detections, const Matches& matches, const Shown& shown,
                               Camera& camera) const {
  constexpr float kFullView = 0.7F;  // visible fraction
  for (std::size_t p = 0; p < shown.poses.size(); ++p) {
    Followed* object = find(shown.numbers[p], camera);
    if (object == nullptr) continue;
    const auto found = std::find(matches.begin(), matches.end(), static_cast<int>(p));
    double score = settings_.missed_score;
    if (found != matches.end()) {
      score = detections.detections[static_cast<std::size_t>(found - matches.begin())].score;
      object->found_utime = shown.utime;
    } else if (shown.poses[p].pose.visible_fraction < kFullView ||
               seconds_between(object->found_utime, shown.utime) < settings_.missed_after_s) {
      continue;
    }
    object->log_odds += settings_.score_gain * (score_log_odds(score) - object->log_odds);
  }
}

/// Takes the place of one of its class that is withheld, or of one of another class that is less sure; is known where
/// one of its class is followed there.
void ObjectFollower::take_up(const PoseEstimator& estimator, const FrameId& frame, const ObjectPose& pose,
                             Camera& camera) {
  Followed found;
  found.number = found_++;
  found.class_id = pose.class_id;
  found.class_name = pose.class_name;
  found.log_odds = score_log_odds(pose.detection_score);
  found.T_camera_object = *pose.T_camera_object;
  found.utime = found.valid_utime = found.found_utime = found.doubted_utime = frame.utime;
  bring_up_to_date(frame.utime, camera, found);
  const PlacedObject here{found.class_name, found.T_camera_object};
  std::vector<Followed> others;
  for (const Followed& object : camera.objects) {
    const bool is_here = estimator.are_one(here, {object.class_name, object.T_camera_object}, settings_.apart);
    const bool is_valid = object.valid_utime == object.utime;
    if (is_here && is_valid && object.class_name == found.class_name) return;
    if (!is_here || is_valid) others.push_back(object);  // of two valid ones follow() gives the weaker one up
  }
  camera.objects = std::move(others);
  camera.objects.push_back(std::move(found));
}

/// Moves what was found in an earlier frame as the camera has moved since, as far as that can be told.
void ObjectFollower::bring_up_to_date(std::int64_t utime, const Camera& camera, Followed& found) {
  const auto then =
      std::find_if(camera.shown.rbegin(), camera.shown.rend(), [&](const Shown& one) { return one.utime == utime; });
  if (then == camera.shown.rend() || then == camera.shown.rbegin()) return;
  const Shown& now = camera.shown.back();
  std::vector<Eigen::Isometry3d> motions;
  for (std::size_t i = 0; i < now.poses.size(); ++i) {
    const auto place = std::find(then->numbers.begin(), then->numbers.end(), now.numbers[i]);
    if (place == then->numbers.end()) continue;
    const FollowedPose& before = then->poses[static_cast<std::size_t>(place - then->numbers.begin())];
    if (!before.pose.T_camera_object || !now.poses[i].pose.T_camera_object) continue;
    motions.push_back(now.poses[i].T_camera_object * before.T_camera_object.inverse());
  }
  const std::optional<Eigen::Isometry3d> carried = carried_along(found.T_camera_object, motions);
  if (!carried) return;
  found.T_camera_object = *carried;
  found.utime = found.valid_utime = now.utime;
}

}  // namespace houghstream
