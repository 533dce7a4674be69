#include "pose/following/detection_look.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/base/log_odds.hpp"
#include "pipeline/types/frame_id.hpp"

namespace houghstream {
namespace {

/// Beside another one's of the same object, where small differences count.
double quality_log_odds(double quality) {
  return log_odds(quality, 1e-6);
}

/// Each detection's place in `shown`, or -1. The nearest ones first, each pose of one detection; withheld ones are
/// nobody's.
std::vector<int> match_detections(const PoseEstimator& estimator, const Detections& detections, const ShownFrame& shown,
                                  double reach_m) {
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
      if (distance <= reach_m) pairs.push_back({distance, d, p});  // false for NaN
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  std::vector<int> matches(detections.detections.size(), -1);
  std::vector<bool> taken(shown.poses.size());
  for (const Pair& pair : pairs) {
    if (matches[pair.detection] >= 0 || taken[pair.pose]) continue;
    matches[pair.detection] = static_cast<int>(pair.pose);
    taken[pair.pose] = true;
  }
  return matches;
}

/// What the look says of those that were there: found, with this score, or not found though in full view.
void note_look(const Detections& detections, const DetectionLook& look, const FollowerSettings& settings,
               FollowedCamera& camera) {
  constexpr float kFullView = 0.7F;  // visible fraction
  const ShownFrame& shown = look.shown;
  for (std::size_t p = 0; p < shown.poses.size(); ++p) {
    FollowedObject* object = find_followed(shown.numbers[p], camera);
    if (object == nullptr) continue;
    const auto found = std::find(look.matches.begin(), look.matches.end(), static_cast<int>(p));
    double score = settings.missed_score;
    if (found != look.matches.end()) {
      score = detections.detections[static_cast<std::size_t>(found - look.matches.begin())].score;
      object->found_us = shown.clock_us;
    } else if (shown.poses[p].pose.visible_fraction < kFullView ||
               seconds_between(object->found_us, shown.clock_us) < settings.missed_after_s) {
      continue;
    }
    object->log_odds += settings.score_gain * (score_log_odds(score) - object->log_odds);
  }
}

/// The place in `shown` of the detected object whose last doubt lies farthest back, if it is time; else -1.
int choose_doubted(const DetectionLook& look, const FollowerSettings& settings, FollowedCamera& camera) {
  const ShownFrame& shown = look.shown;
  FollowedObject* chosen = nullptr;
  int place = -1;
  for (const int match : look.matches) {
    FollowedObject* object =
        match >= 0 ? find_followed(shown.numbers[static_cast<std::size_t>(match)], camera) : nullptr;
    if (object == nullptr || seconds_between(object->doubted_us, shown.clock_us) < settings.doubted_after_s) continue;
    if (chosen != nullptr && chosen->doubted_us <= object->doubted_us) continue;
    chosen = object;
    place = match;
  }
  if (chosen != nullptr) chosen->doubted_us = shown.clock_us;
  return place;
}

}  // namespace

double score_log_odds(double score) {
  return log_odds(score, 1e-3);
}

FollowedObject* find_followed(std::int64_t number, FollowedCamera& camera) {
  const auto found = std::find_if(camera.objects.begin(), camera.objects.end(),
                                  [&](const FollowedObject& one) { return one.number == number; });
  return found == camera.objects.end() ? nullptr : &*found;
}

DetectionLook look_at_detections(const PoseEstimator& estimator, const Detections& detections,
                                 const FollowerSettings& settings, FollowedCamera& camera) {
  DetectionLook look{{}, std::vector<int>(detections.detections.size(), -1), -1};
  const auto then = std::find_if(camera.shown.rbegin(), camera.shown.rend(),
                                 [&](const ShownFrame& one) { return one.utime == detections.frame.utime; });
  if (then == camera.shown.rend()) return look;
  look.shown = *then;
  look.matches = match_detections(estimator, detections, look.shown, settings.reach_m);
  note_look(detections, look, settings, camera);
  look.doubted = choose_doubted(look, settings, camera);
  return look;
}

void settle_doubt(const ObjectPose& pose, const FollowedPose& followed, const FollowerSettings& settings,
                  FollowedObject& object) {
  const double better = quality_log_odds(pose.quality) - quality_log_odds(followed.pose.quality);
  if (better < settings.better_log_odds) return;
  object.T_camera_object = object.T_camera_object * followed.T_camera_object.inverse() * *pose.T_camera_object;
}

}  // namespace houghstream
