#include "pose/reconstruction/tracking/take_mapper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pose/reconstruction/tracking/keyframe_points.hpp"

namespace houghstream::reconstruction {
namespace {

constexpr double kDegrees = 57.29577951308232;

/// Returns the region in which the object is visible; empty where the camera is too near for that.
cv::Rect box_of(const SelectedObject& object, const Camera& camera, const Eigen::Isometry3d& T_camera_world) {
  const double half = object.radius_m * 0.8;
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-half, -half, 0.0), Eigen::Vector3d(half, half, object.height_m));
  return project_box(box, camera, T_camera_world).value_or(cv::Rect()) & cv::Rect(0, 0, camera.width, camera.height);
}

}  // namespace

const TakeMapperStatus& TakeMapper::process(const RgbdFrame& frame) {
  constexpr std::size_t kMaxLostFrames = 100;
  const auto begin = std::chrono::steady_clock::now();
  require_same_size(frame);
  take_.frames.push_back({frame.id, false, false, -1, Eigen::Isometry3d::Identity()});
  ++state_.frames;
  if (map_.empty()) {
    initialise(frame);
  } else {
    FrameLevels levels = make_levels(frame, levels_);
    FlowFrame flow_frame;
    if (motion_ != Motion::kObject) flow_frame = make_flow_frame(frame);
    take_.frames.back().is_excluded = !is_usable_for_model(levels.quality);
    std::optional<Alignment> found;
    if (motion_ == Motion::kObject)
      static_shading_.mark_static_intensity(object_pixels(levels.levels[0], selected_, step_.T_last), levels);
    if (state_.state == TakeMapperState::kTracking) found = follower_.follow(flow_frame, levels, step_, motion_, map_);
    if (found && motion_ == Motion::kUnknown) {
      motion_ = motion_classifier_.classify(flow_frame, levels, found->T_camera_world);
      if (motion_ == Motion::kObject) {
        follow_object_only();
        levels = make_levels(frame, levels_);
        found = follower_.follow(flow_frame, levels, step_, motion_, map_);
      }
    }
    LandmarkCache cache;
    if (!found) found = relocalise(frame, levels, false, cache);
    if (found) {
      register_frame(static_cast<int>(take_.frames.size()) - 1, frame, std::move(levels), *found);
      follower_.set_last(std::move(flow_frame));
    } else {
      note_lost(levels);
      if (lost_frames_.size() < kMaxLostFrames)
        lost_frames_.push_back({static_cast<int>(take_.frames.size()) - 1, frame, std::move(cache)});
    }
  }
  describe();
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return state_;
}

/// Requires one size, since masks, levels and boxes of the first frame are laid over all others.
void TakeMapper::require_same_size(const RgbdFrame& frame) {
  const cv::Size size = frame.depth.size();
  if (take_.frames.empty()) size_ = size;
  require(size == size_ && frame.colour.size() == size_,
          "frame {}: colour {}x{} and depth {}x{}, expected {}x{} as of the first frame: a take is of one camera",
          to_string(frame.id), frame.colour.cols, frame.colour.rows, size.width, size.height, size_.width,
          size_.height);
}

void TakeMapper::initialise(const RgbdFrame& frame) {
  ObjectSelection found = select_object(frame, settings_.selection);
  if (!found.object) {
    state_.message = found.reason;
    require(state_.frames < settings_.max_frames_to_choose && !settings_.selection.box_px, "{}", found.reason);
    return;
  }
  selected_ = std::move(*found.object);
  map_.settings().middle = {0.0, 0.0, 0.5 * selected_.height_m};
  first_number_ = state_.frames - 1;
  FrameLevels levels = make_levels(frame, levels_);
  step_.restart(selected_.T_camera_stand);
  state_.state = TakeMapperState::kTracking;
  covered_sectors_.assign(36, false);
  motion_classifier_ = MotionClassifier(make_flow_frame(frame), levels,
                                        object_pixels(levels.levels[0], selected_, selected_.T_camera_stand),
                                        selected_.T_camera_stand, settings_.map.min_landmarks);
  follower_.set_last(motion_classifier_.first());
  Alignment at_start;
  at_start.T_camera_world = selected_.T_camera_stand;
  register_frame(static_cast<int>(take_.frames.size()) - 1, frame, std::move(levels), at_start);
}

bool TakeMapper::is_usable_for_model(const ImageQuality& quality) {
  constexpr std::size_t kWindow = 31;
  std::vector<double> window(sharpness_.begin(), sharpness_.end());
  sharpness_.push_back(quality.sharpness);
  if (sharpness_.size() > kWindow) sharpness_.pop_front();
  const bool badly_exposed =
      quality.dark_fraction > settings_.max_dark_fraction || quality.bright_fraction > settings_.max_bright_fraction;
  take_.badly_exposed += badly_exposed ? 1 : 0;
  if (badly_exposed) return false;
  if (window.size() < 3) return true;
  std::nth_element(window.begin(), window.begin() + static_cast<std::ptrdiff_t>(window.size() / 2), window.end());
  const bool blurred = quality.sharpness < settings_.min_sharpness * window[window.size() / 2];
  take_.blurred += blurred ? 1 : 0;
  return !blurred;
}

/// Follows the object's own surface alone from here on, since the camera is static and the object moves; the table,
/// which is static too, keeps it upright.
void TakeMapper::follow_object_only() {
  constexpr double kMarginFraction = 0.6;
  const RgbdFrame& first = motion_classifier_.first().frame;
  MapSettings& map = map_.settings();
  map.plane = PlanePrior();
  map.plane->normal = selected_.plane.normal();
  map.plane->offset = selected_.plane.offset();
  map.min_inlier_fraction = 0.6;
  map.coarsest = 1;
  map.use_landmarks = false;
  map.min_deciding_landmarks = 12;
  const cv::Rect& box = selected_.box_px;
  const cv::Size margin(cvRound(kMarginFraction * box.width) + 20, cvRound(kMarginFraction * box.height) + 20);
  levels_.region_px = cv::Rect(box.x - margin.width, box.y - margin.height, box.width + 2 * margin.width,
                               box.height + 2 * margin.height) &
                      cv::Rect({0, 0}, first.depth.size());
  map_ = KeyframeMap(map);
  express_relative_to_first_keyframe();
  state_.seen = {};
  step_.restart(selected_.T_camera_stand);
  Keyframe keyframe;
  keyframe.frame = first;
  keyframe.number = first_number_;
  keyframe.levels = make_levels(first, levels_);
  keyframe.landmarks = detect_landmarks(first, landmark_mask(first, step_.T_last));
  keyframe.T_camera_world = step_.T_last;
  add_keyframe(std::move(keyframe), {});
}

/// Expresses the earlier frames relative to the first keyframe: they referred to keyframes of the surroundings, which
/// the new map does not hold. All of them show the object as that one does. The last few stay unregistered, since the
/// object already moved in them.
void TakeMapper::express_relative_to_first_keyframe() {
  int moved =
      motion_classifier_.moving_object_frames() - 1;  // the last is the present frame, which is not registered yet
  for (auto frame = take_.frames.rbegin(); frame != take_.frames.rend(); ++frame) {
    if (!frame->tracked) continue;
    frame->T_camera_keyframe.setIdentity();
    frame->tracked = moved-- <= 0;
    frame->keyframe = frame->tracked ? 0 : -1;
  }
}

std::optional<Alignment> TakeMapper::relocalise(const RgbdFrame& frame, const FrameLevels& levels, bool everywhere,
                                                LandmarkCache& cache) {
  // Round objects and boxes look similar from several sides.
  const LastPose last{step_.T_last, motion_ == Motion::kObject ? 0.5 : 1e9};
  if (std::optional<Alignment> found = relocalise_by_neighbours(map_, levels, last)) return found;
  if (motion_ == Motion::kObject) cache = {};  // they were detected where the object was assumed
  if (!cache.landmarks) cache.landmarks = detect_landmarks(frame, landmark_mask(frame, step_.T_last));
  return relocaliser_.find(map_, levels, last, everywhere, cache);
}

void TakeMapper::register_frame(int number, const RgbdFrame& frame, FrameLevels levels, const Alignment& alignment) {
  const bool was_lost = state_.state == TakeMapperState::kLost;
  state_.state = TakeMapperState::kTracking;
  if (was_lost) {
    step_.restart(alignment.T_camera_world);
  } else {
    step_.advance(alignment.T_camera_world);
  }
  RegisteredFrame& registered = take_.frames[static_cast<std::size_t>(number)];
  const bool is_usable = !registered.is_excluded;
  const int nearest = map_.nearest(step_.T_last);
  const double away =
      nearest < 0 ? 1e9
                  : map_.view_angle(step_.T_last, map_.keyframes()[static_cast<std::size_t>(nearest)].T_camera_world);
  if (nearest < 0 || (is_usable && away > settings_.keyframe_angle) || away > 2.0 * settings_.keyframe_angle) {
    Keyframe keyframe;
    keyframe.landmarks = detect_landmarks(frame, landmark_mask(frame, step_.T_last));
    Alignment constrained = alignment;
    if (nearest >= 0) map_.local_map(step_.T_last);  // the keyframes to which edges will connect the new one
    if (nearest >= 0 && map_.settings().use_landmarks) {
      constrained = map_.constrain_by_landmarks(levels, keyframe.landmarks, alignment);
      step_.correct(constrained.T_camera_world);
    }
    keyframe.frame = frame;
    keyframe.number = number;
    keyframe.levels = std::move(levels);
    keyframe.T_camera_world = step_.T_last;
    add_keyframe(std::move(keyframe), constrained);
  }
  registered.tracked = true;
  registered.keyframe = map_.nearest(step_.T_last);
  registered.T_camera_keyframe =
      step_.T_last * map_.keyframes()[static_cast<std::size_t>(registered.keyframe)].T_camera_world.inverse();
  const Eigen::Vector3d towards = step_.T_last.inverse().translation() - map_.settings().middle;
  if (is_usable) mark_covered(towards, state_.seen);
  const auto at = static_cast<std::size_t>((std::atan2(towards.y(), towards.x()) * kDegrees + 360.0) / 10.0) % 36;
  covered_sectors_[at] = covered_sectors_[at] || is_usable;
}

/// Returns the mask in which landmarks are detected: everywhere while the camera moves, else on the object, which may
/// have rotated but stays in place.
cv::Mat TakeMapper::landmark_mask(const RgbdFrame& frame, const Eigen::Isometry3d& T_camera_world) const {
  if (motion_ != Motion::kObject) return {};
  return object_pixels({frame.camera, {}, frame.depth, {}}, selected_, T_camera_world);
}

/// Adds the keyframe of step_.T_last, which has no points yet.
void TakeMapper::add_keyframe(Keyframe keyframe, const Alignment& alignment) {
  keyframe.points = motion_ == Motion::kObject ? points_of_object(keyframe, map_, selected_, levels_.region_px)
                                               : points_of_scene(keyframe);
  const std::optional<LoopClosureError> loop_error = map_.add(std::move(keyframe), alignment);
  if (!loop_error) return;
  step_.restart(map_.keyframes().back().T_camera_world);
  const auto covered_sectors = std::count(covered_sectors_.begin(), covered_sectors_.end(), true);
  constexpr int kMinLoopSectors = 30;  // number of the 36 sectors
  if (covered_sectors >= kMinLoopSectors && !take_.loop_error) take_.loop_error = loop_error;
}

void TakeMapper::note_lost(const FrameLevels& levels) {
  constexpr double kFast = 0.06;  // radians of view a frame
  const int number = static_cast<int>(take_.frames.size()) - 1;
  if (state_.state == TakeMapperState::kLost && !take_.lost.empty() && take_.lost.back().to == number - 1) {
    take_.lost.back().to = number;
    return;
  }
  const double speed = map_.view_angle(step_.T_last, step_.T_before);
  std::string why = "the picture jumped, or something hid what was followed";
  if (speed > kFast ||
      levels.quality.sharpness < settings_.min_sharpness * (sharpness_.empty() ? 0.0 : sharpness_.front()))
    why = "too fast";
  state_.state = TakeMapperState::kLost;
  take_.lost.push_back({number, number, why});
}

void TakeMapper::describe() {
  constexpr int kSelectionFrames = 45;  // frames for which the selection is reported, so that a person can read it
  state_.keyframes = static_cast<int>(map_.keyframes().size());
  state_.T_camera_object.reset();
  state_.box_px = {};
  if (map_.empty()) return;
  if (state_.state == TakeMapperState::kLost) {
    state_.message = take_.lost.empty() ? "lost" : "lost: " + take_.lost.back().why + "; go back to where it was seen";
    return;
  }
  state_.T_camera_object = step_.T_last;
  state_.box_px = box_of(selected_, motion_classifier_.first().frame.camera, step_.T_last);
  state_.message = describe_coverage(state_.seen, selected_.T_camera_stand.inverse().translation());
  if (state_.frames - first_number_ <= kSelectionFrames)
    state_.message = describe_selection(selected_) + "; move the camera once around it, or turn it";
}

Take TakeMapper::finish() {
  require(!map_.empty(), "{}", state_.message.empty() ? "no frame, expected some that show an object" : state_.message);
  relocalise_lost_frames();
  map_.refine(3);
  take_.selected = selected_;
  take_.motion = motion_;
  take_.keyframes = std::move(map_.keyframes());
  take_.seen = state_.seen;
  take_.covered_degrees = static_cast<int>(10 * std::count(covered_sectors_.begin(), covered_sectors_.end(), true));
  take_.tracking_hz = seconds_ > 0.0 ? static_cast<double>(take_.frames.size()) / seconds_ : 0.0;
  return std::move(take_);
}

/// Relocalises frames that were lost on arrival in the map of the whole take, as long as one more is found.
void TakeMapper::relocalise_lost_frames() {
  for (bool any = true; any;) {
    any = false;
    for (auto at = lost_frames_.begin(); at != lost_frames_.end();) {
      FrameLevels levels = make_levels(at->frame, levels_);
      const std::optional<Alignment> found = relocalise(at->frame, levels, true, at->cache);
      if (!found) {
        ++at;
        continue;
      }
      register_frame(at->number, at->frame, std::move(levels), *found);
      at = lost_frames_.erase(at);
      any = true;
    }
  }
  take_.lost = find_unrecovered_spans(take_);
}

}  // namespace houghstream::reconstruction
