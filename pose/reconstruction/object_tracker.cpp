#include "pose/reconstruction/object_tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/checks.hpp"

namespace houghstream::reconstruction {
namespace {

constexpr double kDegrees = 57.29577951308232;

double agreement_of(const Alignment& alignment) {
  return alignment.inlier_share * std::min(1.0, alignment.seen_share / 0.4) - 0.5 * alignment.light_rms;
}

/// The statistics of an alignment without any.
Alignment look_at(const LevelPoints& points, const FrameLevels& frame, const Eigen::Isometry3d& T, int level) {
  AlignmentLimits limits;
  limits.iterations = 0;
  limits.coarsest = level;
  limits.finest = level;
  return align_frame(points, frame, T, {}, limits);
}

/// Of the pixels with a clear edge in the first picture, where `mask` is set: the share that looks the same now.
double unchanged_share(const cv::Mat& light, const cv::Mat& first, const cv::Mat& mask) {
  constexpr float kEdge_sq = 0.16F;
  constexpr float kSame = 0.4F;
  int edges = 0;
  int same = 0;
  for (int y = 1; y + 1 < first.rows; ++y) {
    for (int x = 1; x + 1 < first.cols; ++x) {
      if (mask.at<std::uint8_t>(y, x) == 0) continue;
      const float gx = first.at<float>(y, x + 1) - first.at<float>(y, x - 1);
      const float gy = first.at<float>(y + 1, x) - first.at<float>(y - 1, x);
      if (gx * gx + gy * gy < kEdge_sq) continue;
      ++edges;
      same += std::abs(light.at<float>(y, x) - first.at<float>(y, x)) < kSame ? 1 : 0;
    }
  }
  return edges > 0 ? static_cast<double>(same) / edges : 1.0;
}

/// Where the object is seen; empty where the camera is too near for that.
cv::Rect box_of(const ChosenObject& object, const Camera& camera, const Eigen::Isometry3d& T_camera_world) {
  const double half = object.radius_m * 0.8;
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-half, -half, 0.0), Eigen::Vector3d(half, half, object.height_m));
  return seen_box(box, camera, T_camera_world).value_or(cv::Rect()) & cv::Rect(0, 0, camera.width, camera.height);
}

}  // namespace

Eigen::Isometry3d Take::pose_of(const FrameTrack& frame) const {
  return frame.T_camera_keyframe * keyframes[static_cast<std::size_t>(frame.keyframe)].T_camera_world;
}

/// Masks, levels and boxes of the first frame are laid over all others.
void ObjectTracker::require_same_size(const RgbdFrame& frame) {
  const cv::Size size = frame.depth.size();
  if (take_.frames.empty()) size_ = size;
  require(size == size_ && frame.colour.size() == size_,
          "frame {}: colour {}x{} and depth {}x{}, expected {}x{} as of the first frame: a take is of one camera",
          to_string(frame.id), frame.colour.cols, frame.colour.rows, size.width, size.height, size_.width,
          size_.height);
}

const TrackerState& ObjectTracker::process(const RgbdFrame& frame) {
  constexpr std::size_t kMostUnplaced = 100;
  const auto begin = std::chrono::steady_clock::now();
  require_same_size(frame);
  take_.frames.push_back({frame.id, false, false, -1, Eigen::Isometry3d::Identity()});
  ++state_.frames;
  if (map_.empty()) {
    choose(frame);
  } else {
    FrameLevels levels = make_levels(frame, levels_);
    FlowFrame now;
    if (motion_ != Motion::kObject) now = make_flow_frame(frame);
    take_.frames.back().left_out = !is_fit_for_model(levels.quality);
    std::optional<Alignment> found;
    if (motion_ == Motion::kObject) mark_what_stays(levels);
    if (state_.state == TrackState::kTracking) found = follow(now, levels);
    if (found && motion_ == Motion::kUnknown) {
      see_what_moves(now, levels, found->T_camera_world);
      if (motion_ == Motion::kObject) {  // of the object only, from here on
        levels = make_levels(frame, levels_);
        found = follow(now, levels);
      }
    }
    KnownCorners corners;
    if (!found) found = find_again(frame, levels, false, corners);
    if (found) {
      accept(static_cast<int>(take_.frames.size()) - 1, frame, std::move(levels), *found);
      last_flow_ = std::move(now);
    } else {
      note_lost(levels);
      if (unplaced_.size() < kMostUnplaced)
        unplaced_.push_back({static_cast<int>(take_.frames.size()) - 1, frame, std::move(corners)});
    }
  }
  describe();
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return state_;
}

void ObjectTracker::choose(const RgbdFrame& frame) {
  Choice choice = choose_object(frame, settings_.choice);
  if (!choice.object) {
    state_.message = choice.reason;
    require(state_.frames < settings_.most_frames_to_choose && !settings_.choice.box_px, "{}", choice.reason);
    return;
  }
  chosen_ = std::move(*choice.object);
  map_.settings().middle = {0.0, 0.0, 0.5 * chosen_.height_m};
  first_number_ = state_.frames - 1;
  FrameLevels levels = make_levels(frame, levels_);
  const cv::Mat on_it = object_pixels(levels.levels[0], chosen_.T_camera_stand);
  T_last_ = T_before_ = chosen_.T_camera_stand;
  state_.state = TrackState::kTracking;
  round_.assign(36, false);
  first_light_ = levels.levels[0].light;
  cv::dilate(on_it, about_object_, cv::getStructuringElement(cv::MORPH_ELLIPSE, {5, 5}));
  cv::dilate(on_it, away_from_object_, cv::getStructuringElement(cv::MORPH_ELLIPSE, {41, 41}));
  away_from_object_ = away_from_object_ == 0;
  cv::Mat away;
  cv::resize(away_from_object_, away, frame.colour.size(), 0.0, 0.0, cv::INTER_NEAREST);
  first_flow_ = last_flow_ = make_flow_frame(frame);
  first_corners_ = corners_to_follow(first_flow_, away);
  first_rest_ = choose_points(levels, away_from_object_, {});
  const Eigen::Isometry3f T_world_camera = chosen_.T_camera_stand.inverse().cast<float>();
  for (std::vector<SurfacePoint>& level : first_rest_) {
    for (SurfacePoint& point : level) {
      point.point = T_world_camera * point.point;
      point.normal = T_world_camera.linear() * point.normal;
    }
  }
  Alignment at_start;
  at_start.T_camera_world = chosen_.T_camera_stand;
  accept(static_cast<int>(take_.frames.size()) - 1, frame, std::move(levels), at_start);
}

bool ObjectTracker::is_fit_for_model(const PictureQuality& quality) {
  constexpr std::size_t kAround = 31;
  std::vector<double> around(sharpness_.begin(), sharpness_.end());
  sharpness_.push_back(quality.sharpness);
  if (sharpness_.size() > kAround) sharpness_.pop_front();
  const bool badly_exposed =
      quality.dark_share > settings_.most_dark_share || quality.bright_share > settings_.most_bright_share;
  take_.badly_exposed += badly_exposed ? 1 : 0;
  if (badly_exposed) return false;
  if (around.size() < 3) return true;
  std::nth_element(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2), around.end());
  const bool blurred = quality.sharpness < settings_.least_sharpness * around[around.size() / 2];
  take_.blurred += blurred ? 1 : 0;
  return !blurred;
}

Alignment ObjectTracker::lay_on_map(const FrameLevels& levels, const Eigen::Isometry3d& T_start, int coarsest) {
  AlignmentLimits limits;
  limits.coarsest = coarsest;
  return align_frame(map_.local_map(T_start), levels, T_start, {map_.settings().plane, corners_}, limits);
}

/// From the frame before, whose corners say how the camera moved, or as it went on until then.
std::optional<Alignment> ObjectTracker::follow(const FlowFrame& now, const FrameLevels& levels) {
  constexpr double kMostTurn = 0.15;     // radians a frame, from rest
  constexpr double kMostEver = 0.4;      // radians a frame
  constexpr double kMostShift_m = 0.02;  // a frame, of an object that turns where it stands
  const Eigen::Isometry3d T_goes_on =
      motion_ == Motion::kObject ? T_last_ * (T_before_.inverse() * T_last_) : T_last_ * T_before_.inverse() * T_last_;
  const LevelPoints& points = map_.local_map(T_last_);
  const bool goes_on = agreement_of(look_at(points, levels, T_goes_on, map_.settings().coarsest)) >
                       agreement_of(look_at(points, levels, T_last_, map_.settings().coarsest));
  const std::optional<LandmarkMatch> flow =
      motion_ == Motion::kObject ? std::nullopt : follow_corners(last_flow_, corners_to_follow(last_flow_, {}), now);
  corners_.clear();
  if (flow && flow->inliers.size() >= map_.settings().fewest_corners) {
    for (const auto& [before, after] : flow->inliers) corners_.push_back({T_last_.inverse() * before, after});
  }
  const Eigen::Isometry3d T_likely = !corners_.empty() ? flow->T_b_a * T_last_ : goes_on ? T_goes_on : T_last_;
  const int coarsest = map_.settings().coarsest;
  Alignment best = lay_on_map(levels, T_likely, coarsest);
  // Stripes and tiles repeat: what suddenly agrees less has slipped by one.
  if (!map_.is_good(best) || best.light_rms > 1.4 * usual_light_rms_ + 0.03) {
    for (const Alignment& other :
         {lay_on_map(levels, T_likely, 0), lay_on_map(levels, goes_on ? T_last_ : T_goes_on, coarsest),
          lay_on_map(levels, goes_on ? T_last_ : T_goes_on, 1)}) {
      if (agreement_of(other) > agreement_of(best)) best = other;
    }
  }
  const double most = std::min(kMostTurn + 2.0 * map_.difference(T_last_, T_before_), kMostEver);
  const double shift = (T_last_.inverse() * best.T_camera_world).translation().norm();
  const bool too_far = motion_ == Motion::kObject && shift > kMostShift_m;
  if (!map_.is_good(best) || too_far || map_.difference(T_last_, best.T_camera_world) > most) return std::nullopt;
  usual_light_rms_ += 0.2 * (best.light_rms - usual_light_rms_);
  return best;
}

/// How a keyframe's corners lie on those of the frame.
const KnownCorners::Place& ObjectTracker::place_by_corners(int keyframe, KnownCorners& corners) const {
  const auto [known, is_new] = corners.by_keyframe.try_emplace(keyframe);
  KnownCorners::Place& place = known->second;
  if (!is_new) return place;
  const Landmarks& of_keyframe = map_.keyframes()[static_cast<std::size_t>(keyframe)].landmarks;
  if (const std::optional<LandmarkMatch> match = match_landmarks(of_keyframe, *corners.seen))
    place = {match->inliers.size(), match->T_b_a};
  return place;
}

std::optional<Alignment> ObjectTracker::find_again(const RgbdFrame& frame, const FrameLevels& levels, bool everywhere,
                                                   KnownCorners& corners) {
  constexpr std::size_t kTriedByPose = 4;
  constexpr double kSure = 0.85;  // share of inliers: a plane and a pattern on it may agree with a wrong pose by half
  const std::size_t tried_by_landmarks = everywhere ? map_.keyframes().size() : 12;
  const std::vector<Keyframe>& keyframes = map_.keyframes();
  std::vector<std::pair<double, int>> by_distance;
  for (std::size_t k = 0; k < keyframes.size(); ++k)
    by_distance.emplace_back(map_.difference(T_last_, keyframes[k].T_camera_world), static_cast<int>(k));
  std::sort(by_distance.begin(), by_distance.end());
  // What is round or a box looks alike from several sides.
  const double farthest = motion_ == Motion::kObject ? 0.5 : 1e9;
  AlignmentLimits limits;
  limits.coarsest = map_.settings().coarsest;
  for (std::size_t i = 0; i < std::min(kTriedByPose, by_distance.size()); ++i) {
    const int k = by_distance[i].second;
    if (by_distance[i].first > farthest) break;
    const Alignment found =
        align_frame(map_.points_of({k}), levels, keyframes[static_cast<std::size_t>(k)].T_camera_world,
                    {map_.settings().plane, {}}, limits);
    if (map_.is_good(found) && found.inlier_share > kSure) return found;
  }
  if (motion_ == Motion::kObject) corners = {};  // they are of where the object is believed to be
  if (!corners.seen) corners.seen = find_landmarks(frame, landmark_mask(frame, T_last_));
  KnownCorners::Place best;
  int best_keyframe = -1;
  for (std::size_t i = 0; i < std::min(tried_by_landmarks, by_distance.size()); ++i) {
    // The nearest half, and the others in turn.
    const std::size_t at = i < tried_by_landmarks / 2 ? i : next_to_try_++ % by_distance.size();
    const int k = by_distance[at].second;
    const KnownCorners::Place& place = place_by_corners(k, corners);
    if (place.corners <= best.corners) continue;
    best = place;
    best_keyframe = k;
  }
  if (best_keyframe < 0 || best.corners < map_.settings().sure_corners) return std::nullopt;
  const Eigen::Isometry3d T = best.T_frame_keyframe * keyframes[static_cast<std::size_t>(best_keyframe)].T_camera_world;
  if (map_.difference(T, T_last_) > farthest) return std::nullopt;
  const Alignment found = align_frame(map_.points_of({best_keyframe}), levels, T, {map_.settings().plane, {}}, limits);
  if (map_.is_good(found) && found.inlier_share > kSure) return found;
  return std::nullopt;
}

void ObjectTracker::accept(int number, const RgbdFrame& frame, FrameLevels levels, const Alignment& alignment) {
  const bool was_lost = state_.state == TrackState::kLost;
  state_.state = TrackState::kTracking;
  T_before_ = was_lost ? alignment.T_camera_world : T_last_;
  T_last_ = alignment.T_camera_world;
  FrameTrack& track = take_.frames[static_cast<std::size_t>(number)];
  const bool fit = !track.left_out;
  const int nearest = map_.nearest(T_last_);
  const double away =
      nearest < 0 ? 1e9 : map_.difference(T_last_, map_.keyframes()[static_cast<std::size_t>(nearest)].T_camera_world);
  if (nearest < 0 || (fit && away > settings_.keyframe_turn) || away > 2.0 * settings_.keyframe_turn) {
    Landmarks landmarks = find_landmarks(frame, landmark_mask(frame, T_last_));
    Alignment held = alignment;
    if (nearest >= 0) map_.local_map(T_last_);  // the keyframes that the new one is tied to
    if (nearest >= 0 && map_.settings().corners_hold) {
      held = map_.held_by_corners(levels, landmarks, alignment);
      T_last_ = held.T_camera_world;
      T_before_ = T_before_ * alignment.T_camera_world.inverse() * T_last_;
    }
    add_keyframe({frame, number, std::move(levels), {}, std::move(landmarks), T_last_}, held);
  }
  track.tracked = true;
  track.keyframe = map_.nearest(T_last_);
  track.T_camera_keyframe =
      T_last_ * map_.keyframes()[static_cast<std::size_t>(track.keyframe)].T_camera_world.inverse();
  const Eigen::Vector3d towards = T_last_.inverse().translation() - map_.settings().middle;
  if (fit) mark_seen(towards, state_.seen);
  const auto at = static_cast<std::size_t>((std::atan2(towards.y(), towards.x()) * kDegrees + 360.0) / 10.0) % 36;
  round_[at] = round_[at] || fit;
}

/// Whether the corners of the surroundings are where they were at first; where there are few, whether the surroundings
/// look as they did then rather than as a moved camera would see them.
bool ObjectTracker::camera_is_still(const FlowFrame& now, const FrameLevels& levels,
                                    const Eigen::Isometry3d& T_moved) const {
  constexpr double kMoved = 0.003;  // radians, of half of the corners
  constexpr double kBetter = 0.01;  // of light
  const std::optional<LandmarkMatch> flow = follow_corners(first_flow_, first_corners_, now);
  if (flow && flow->inliers.size() >= settings_.map.fewest_corners) {
    const auto moved = std::count_if(flow->inliers.begin(), flow->inliers.end(), [&](const auto& pair) {
      return bearing_error({pair.first, pair.second}, Eigen::Isometry3d::Identity()) > kMoved;
    });
    return 2 * static_cast<std::size_t>(moved) < flow->inliers.size();
  }
  const double as_moved = look_at(first_rest_, levels, T_moved, 0).light_rms;
  const double as_still = look_at(first_rest_, levels, chosen_.T_camera_stand, 0).light_rms;
  return as_still < as_moved + kBetter;
}

/// While nothing is decided.
void ObjectTracker::see_what_moves(const FlowFrame& now, const FrameLevels& levels, Eigen::Isometry3d& T_camera_world) {
  constexpr int kSure = 3;
  constexpr double kLess = 0.2;  // share of edges
  const bool is_still = camera_is_still(now, levels, T_camera_world);
  const double around = unchanged_share(levels.levels[0].light, first_light_, away_from_object_);
  const double on_it = unchanged_share(levels.levels[0].light, first_light_, about_object_);
  camera_moves_ = is_still ? 0 : camera_moves_ + 1;
  object_moves_ = is_still && on_it < around - kLess ? object_moves_ + 1 : 0;
  if (is_still) T_camera_world = chosen_.T_camera_stand;
  if (camera_moves_ >= kSure) motion_ = Motion::kCamera;
  if (object_moves_ >= kSure) follow_object_only();
}

/// The camera stands still and something happens to the object: from here on its own surface alone is followed, and the
/// table, which does not move, holds it upright.
void ObjectTracker::follow_object_only() {
  constexpr double kAround = 0.6;
  motion_ = Motion::kObject;
  MapSettings& map = map_.settings();
  map.plane = PlaneKnown();
  map.plane->normal = chosen_.plane.normal;
  map.plane->offset = chosen_.plane.offset;
  map.least_inlier_share = 0.6;
  map.coarsest = 1;
  map.corners_hold = false;
  map.sure_corners = 12;
  const cv::Rect& box = chosen_.box_px;
  const cv::Size more(cvRound(kAround * box.width) + 20, cvRound(kAround * box.height) + 20);
  levels_.region_px =
      cv::Rect(box.x - more.width, box.y - more.height, box.width + 2 * more.width, box.height + 2 * more.height) &
      cv::Rect({0, 0}, first_flow_.frame.depth.size());
  map_ = KeyframeMap(map);
  tie_to_first_keyframe();
  state_.seen = {};
  T_last_ = T_before_ = chosen_.T_camera_stand;
  Landmarks landmarks = find_landmarks(first_flow_.frame, landmark_mask(first_flow_.frame, T_last_));
  add_keyframe(
      {first_flow_.frame, first_number_, make_levels(first_flow_.frame, levels_), {}, std::move(landmarks), T_last_},
      {});
}

/// The frames of before were tied to keyframes of the surroundings, and the map now holds the first frame alone: all of
/// them show the object as that one does. In the last of them it moved already, and nobody knows how far.
void ObjectTracker::tie_to_first_keyframe() {
  int moved = object_moves_ - 1;  // the last is the present frame, which is not placed yet
  for (auto frame = take_.frames.rbegin(); frame != take_.frames.rend(); ++frame) {
    if (!frame->tracked) continue;
    frame->T_camera_keyframe.setIdentity();
    frame->tracked = moved-- <= 0;
    frame->keyframe = frame->tracked ? 0 : -1;
  }
}

cv::Mat ObjectTracker::object_pixels(const FrameLevel& level, const Eigen::Isometry3d& T_camera_world) const {
  constexpr double kLowest_m = 0.006;
  const double widest = 1.3 * chosen_.radius_m + 0.01;
  const Eigen::Isometry3d T_world_camera = T_camera_world.inverse();
  cv::Mat mask = cv::Mat::zeros(level.depth.size(), CV_8UC1);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      const float z = level.depth.at<float>(y, x);
      if (!(z > 0.1F)) continue;
      const Eigen::Vector3d p = T_world_camera * level.camera.backproject(x, y, z);
      const bool is_on_it = p.z() > kLowest_m && p.z() < chosen_.height_m + 0.03 && std::hypot(p.x(), p.y()) < widest;
      mask.at<std::uint8_t>(y, x) = is_on_it ? 255 : 0;
    }
  }
  return mask;
}

/// Before a camera that stands still, shade and shine stay where they are while the object turns: what looks as it did
/// some frames ago tells nothing of the turn, unless all of it does, and the object rests.
void ObjectTracker::mark_what_stays(FrameLevels& levels) {
  constexpr std::size_t kFramesAgo = 5;
  constexpr float kSame = 0.3F;
  constexpr double kRests = 0.03;
  std::vector<cv::Mat> now;
  for (const FrameLevel& level : levels.levels) now.push_back(level.light);
  lights_.push_back(std::move(now));
  if (lights_.size() <= kFramesAgo) return;
  const double changed =
      1.0 - unchanged_share(levels.levels[0].light, lights_.front()[0], object_pixels(levels.levels[0], T_last_));
  if (changed > kRests) {
    for (std::size_t l = 0; l < levels.levels.size(); ++l) {
      cv::Mat difference;
      cv::absdiff(levels.levels[l].light, lights_.front()[l], difference);
      levels.levels[l].stays = difference < kSame;
      cv::erode(levels.levels[l].stays, levels.levels[l].stays, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
    }
  }
  lights_.pop_front();
}

/// Takes out of the mask what keyframes have seen through: a hand.
void ObjectTracker::remove_seen_through(const FrameLevel& level, cv::Mat& mask) const {
  constexpr double kBehind_m = 0.015;
  constexpr double kAlike = 1.2;  // radians: what keyframes from farther round see says nothing of this side
  const Eigen::Isometry3d T_world_camera = T_last_.inverse();
  for (const Keyframe& keyframe : map_.keyframes()) {
    if (map_.difference(keyframe.T_camera_world, T_last_) > kAlike) continue;
    const Eigen::Isometry3d T = keyframe.T_camera_world * T_world_camera;
    for (int y = 0; y < mask.rows; ++y) {
      for (int x = 0; x < mask.cols; ++x) {
        if (mask.at<std::uint8_t>(y, x) == 0) continue;
        const Eigen::Vector3d p = T * level.camera.backproject(x, y, level.depth.at<float>(y, x));
        if (p.z() < 0.1) continue;
        const Eigen::Vector2d px = keyframe.frame.camera.project(p);
        const cv::Point at(cvRound(px.x()), cvRound(px.y()));
        if (!cv::Rect({0, 0}, keyframe.frame.depth.size()).contains(at)) continue;
        const float z = keyframe.frame.depth.at<float>(at);
        if (z > p.z() + kBehind_m + 3.0 * depth_sigma(z)) mask.at<std::uint8_t>(y, x) = 0;
      }
    }
  }
  cv::erode(mask, mask, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
}

/// Where corners are looked for: everywhere while the camera moves, else on the object, which may have turned but
/// stays.
cv::Mat ObjectTracker::landmark_mask(const RgbdFrame& frame, const Eigen::Isometry3d& T_camera_world) const {
  if (motion_ != Motion::kObject) return {};
  return object_pixels({frame.camera, {}, frame.depth, {}}, T_camera_world);
}

/// The keyframe of T_last_, which has no points yet.
void ObjectTracker::add_keyframe(Keyframe keyframe, const Alignment& alignment) {
  constexpr double kTableRadius_m = 0.7;
  constexpr float kTableHeight_m = 0.01F;
  const FrameLevel& finest = keyframe.levels.levels[0];
  const bool object_only = motion_ == Motion::kObject;
  PointSettings points;
  points.square_px = object_only ? 4 : 6;
  cv::Mat mask;
  if (object_only) {
    mask = object_pixels(finest, T_last_);
    remove_seen_through(finest, mask);
    if (!chosen_.like_skin) {
      cv::Mat skin;
      cv::dilate(skin_pixels(keyframe.frame.colour(levels_.region_px)), skin,
                 cv::getStructuringElement(cv::MORPH_ELLIPSE, {7, 7}));
      cv::resize(skin, skin, mask.size(), 0, 0, cv::INTER_NEAREST);
      mask.setTo(0, skin);
    }
  }
  keyframe.points = choose_points(keyframe.levels, mask, points);
  const Eigen::Isometry3f T_world_camera = T_last_.inverse().cast<float>();
  for (std::vector<SurfacePoint>& level : keyframe.points) {
    for (SurfacePoint& point : level) {
      const Eigen::Vector3f p = T_world_camera * point.point;
      point.on_table = !object_only && std::abs(p.z()) < kTableHeight_m && p.head<2>().norm() < kTableRadius_m &&
                       (T_world_camera.linear() * point.normal).z() > 0.95F;
    }
  }
  const std::optional<LoopGap> gap = map_.add(std::move(keyframe), alignment);
  if (!gap) return;
  T_last_ = T_before_ = map_.keyframes().back().T_camera_world;
  const auto seen_round = std::count(round_.begin(), round_.end(), true);
  constexpr int kNearlyRound = 30;  // of 36
  if (seen_round >= kNearlyRound && !take_.gap) take_.gap = gap;
}

void ObjectTracker::note_lost(const FrameLevels& levels) {
  constexpr double kFast = 0.06;  // radians of view a frame
  const int number = static_cast<int>(take_.frames.size()) - 1;
  if (state_.state == TrackState::kLost && !take_.lost.empty() && take_.lost.back().to == number - 1) {
    take_.lost.back().to = number;
    return;
  }
  const double speed = map_.difference(T_last_, T_before_);
  std::string why = "the picture jumped, or something hid what was followed";
  if (speed > kFast ||
      levels.quality.sharpness < settings_.least_sharpness * (sharpness_.empty() ? 0.0 : sharpness_.front()))
    why = "too fast";
  state_.state = TrackState::kLost;
  take_.lost.push_back({number, number, why});
}

void ObjectTracker::describe() {
  constexpr int kTold = 45;  // frames for which the choice is said, so that a person can read it
  state_.keyframes = static_cast<int>(map_.keyframes().size());
  state_.T_camera_object.reset();
  state_.box_px = {};
  if (map_.empty()) return;
  if (state_.state == TrackState::kLost) {
    state_.message = take_.lost.empty() ? "lost" : "lost: " + take_.lost.back().why + "; go back to where it was seen";
    return;
  }
  state_.T_camera_object = T_last_;
  state_.box_px = box_of(chosen_, first_flow_.frame.camera, T_last_);
  state_.message = describe_seen(state_.seen, chosen_.T_camera_stand.inverse().translation());
  if (state_.frames - first_number_ <= kTold)
    state_.message = describe_choice(chosen_) + "; move the camera once around it, or turn it";
}

/// What was lost when it came may be found now that more of the surroundings is known.
void ObjectTracker::place_the_lost() {
  for (bool any = true; any;) {
    any = false;
    for (auto at = unplaced_.begin(); at != unplaced_.end();) {
      FrameLevels levels = make_levels(at->frame, levels_);
      const std::optional<Alignment> found = find_again(at->frame, levels, true, at->corners);
      if (!found) {
        ++at;
        continue;
      }
      accept(at->number, at->frame, std::move(levels), *found);
      at = unplaced_.erase(at);
      any = true;
    }
  }
  std::vector<LostSpan> still;
  for (const LostSpan& span : take_.lost) {
    for (int i = span.from; i <= span.to; ++i) {
      if (take_.frames[static_cast<std::size_t>(i)].tracked) continue;
      if (!still.empty() && still.back().to == i - 1 && i != span.from) {
        still.back().to = i;
      } else {
        still.push_back({i, i, span.why});
      }
    }
  }
  take_.lost = std::move(still);
}

Take ObjectTracker::finish() {
  require(!map_.empty(), "{}", state_.message.empty() ? "no frame, expected some that show an object" : state_.message);
  place_the_lost();
  map_.refine(3);
  take_.chosen = chosen_;
  take_.motion = motion_;
  take_.keyframes = std::move(map_.keyframes());
  take_.seen = state_.seen;
  take_.degrees_round = static_cast<int>(10 * std::count(round_.begin(), round_.end(), true));
  take_.tracking_hz = seconds_ > 0.0 ? static_cast<double>(take_.frames.size()) / seconds_ : 0.0;
  return std::move(take_);
}

}  // namespace houghstream::reconstruction
