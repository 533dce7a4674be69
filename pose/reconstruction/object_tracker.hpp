#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pose/reconstruction/keyframe_map.hpp"
#include "pose/reconstruction/object_choice.hpp"
#include "pose/reconstruction/sphere_of_directions.hpp"

namespace houghstream::reconstruction {

/// What moves: the camera about the object, the object before a camera that stands still, or a turntable with
/// known masks (not of the tracker).
enum class Motion : std::uint8_t { kUnknown, kCamera, kObject, kTurntable };

enum class TrackState : std::uint8_t { kChoosing, kTracking, kLost };

struct TrackerSettings {
  ChoiceSettings choice;
  MapSettings map;                 ///< middle and plane are those of the object
  int most_frames_to_choose = 45;  ///< without an object in so many frames, there is none
  double keyframe_turn = 0.12;     ///< radians between the views of keyframes
  double least_sharpness = 0.5;    ///< of the median of the frames around; what is less is blurred
  double most_dark_share = 0.7;    ///< of a picture; what is more is badly exposed
  double most_bright_share = 0.4;
};

/// What became of a frame.
struct FrameTrack {
  FrameId id;
  bool tracked = false;
  bool left_out = false;  ///< blurred or badly exposed: it is not used for the model
  int keyframe = -1;      ///< that its pose is kept by
  Eigen::Isometry3d T_camera_keyframe = Eigen::Isometry3d::Identity();
};

/// Frames in which nobody knew where the camera was.
struct LostSpan {
  int from = 0, to = 0;  ///< numbers of frames, both lost
  std::string why;
};

/// What can be said at any time.
struct TrackerState {
  TrackState state = TrackState::kChoosing;
  std::string message;  ///< for a person, one line
  SeenDirections seen{};
  int frames = 0;
  int keyframes = 0;
  cv::Rect box_px;                                   ///< of the object in the last frame; empty where it is not known
  std::optional<Eigen::Isometry3d> T_camera_object;  ///< metres; z up, origin at its foot
};

/// A take that is over.
struct Take {
  ChosenObject chosen;  ///< in the first frame
  Motion motion = Motion::kUnknown;
  std::vector<Keyframe> keyframes;
  std::vector<FrameTrack> frames;
  std::vector<LostSpan> lost;
  std::optional<LoopGap> gap;  ///< of the loop that goes round, before it was closed
  SeenDirections seen{};
  int degrees_round = 0;               ///< of the turn from which it was seen, 0 to 360
  int blurred = 0, badly_exposed = 0;  ///< frames
  double tracking_hz = 0.0;            ///< frames a second that tracking alone takes

  /// T_camera_world of a tracked frame.
  Eigen::Isometry3d pose_of(const FrameTrack& frame) const;
};

/// Corners of a frame that is looked for again and again, and what those of each keyframe say of it: found once.
struct KnownCorners {
  struct Place {
    std::size_t corners = 0;  ///< that agree; 0 = it says nothing
    Eigen::Isometry3d T_frame_keyframe = Eigen::Isometry3d::Identity();
  };
  std::optional<Landmarks> seen;
  std::map<int, Place> by_keyframe;
};

/// A frame that could not be placed when it came.
struct LostFrame {
  int number = 0;  ///< in its take
  RgbdFrame frame;
  KnownCorners corners;
};

/// Follows an object on a table through the frames of a take, in which the camera is carried about it, or the object
/// turns before a camera that stands still. Each frame is laid on a map of the nearest keyframes (align_frame); table
/// points are held to one plane; when the way closes, the gap is spread over it. What is lost is looked for by
/// neighbouring keyframes and by ORB landmarks. One thread; same frames, same result.
class ObjectTracker {
 public:
  explicit ObjectTracker(const TrackerSettings& settings) : settings_(settings), map_(settings.map) {}

  /// The next frame. Throws InputError with the reason where no object was found in the first frames, and for a frame
  /// of another size than the first.
  const TrackerState& process(const RgbdFrame& frame);
  const TrackerState& state() const { return state_; }

  /// Registers all keyframes to one another once more and hands over the take. Throws InputError where there is none.
  Take finish();

 private:
  void require_same_size(const RgbdFrame& frame);
  void choose(const RgbdFrame& frame);
  Alignment lay_on_map(const FrameLevels& levels, const Eigen::Isometry3d& T_start, int coarsest);
  std::optional<Alignment> follow(const FlowFrame& now, const FrameLevels& levels);
  std::optional<Alignment> find_again(const RgbdFrame& frame, const FrameLevels& levels, bool everywhere,
                                      KnownCorners& corners);
  const KnownCorners::Place& place_by_corners(int keyframe, KnownCorners& corners) const;
  void place_the_lost();
  void accept(int number, const RgbdFrame& frame, FrameLevels levels, const Alignment& alignment);
  void note_lost(const FrameLevels& levels);
  bool is_fit_for_model(const PictureQuality& quality);
  bool camera_is_still(const FlowFrame& now, const FrameLevels& levels, const Eigen::Isometry3d& T_moved) const;
  void see_what_moves(const FlowFrame& now, const FrameLevels& levels, Eigen::Isometry3d& T_camera_world);
  void mark_what_stays(FrameLevels& levels);
  void remove_seen_through(const FrameLevel& level, cv::Mat& mask) const;
  void follow_object_only();
  void tie_to_first_keyframe();
  void add_keyframe(Keyframe keyframe, const Alignment& alignment);
  cv::Mat landmark_mask(const RgbdFrame& frame, const Eigen::Isometry3d& T_camera_world) const;
  cv::Mat object_pixels(const FrameLevel& level, const Eigen::Isometry3d& T_camera_world) const;
  void describe();

  TrackerSettings settings_;
  TrackerState state_;
  ChosenObject chosen_;
  KeyframeMap map_;
  LevelSettings levels_;
  Motion motion_ = Motion::kUnknown;
  cv::Mat first_light_, about_object_, away_from_object_;  ///< of the first keyframe's finest level
  LevelPoints first_rest_;                                 ///< points away from the object, world frame
  cv::Size size_;                                          ///< of all frames, pixels
  FlowFrame first_flow_;
  std::vector<cv::Point2f> first_corners_;  ///< of it, away from the object
  FlowFrame last_flow_;                     ///< of the frame that T_last_ is of, while the object is not seen to turn
  std::vector<SeenCorner> corners_;         ///< of it, as the present frame shows them
  int first_number_ = 0;
  std::deque<std::vector<cv::Mat>> lights_;  ///< of the last frames, by level, while the object turns
  int object_moves_ = 0;                     ///< frames in which it did, one after the other
  int camera_moves_ = 0;
  Eigen::Isometry3d T_last_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_before_ = Eigen::Isometry3d::Identity();
  std::vector<LostFrame> unplaced_;
  std::deque<double> sharpness_;
  Take take_;
  std::vector<bool> round_;  ///< each ten degrees of the turn
  double seconds_ = 0.0;
  double usual_light_rms_ = 0.3;
  std::size_t next_to_try_ = 0;
};

}  // namespace houghstream::reconstruction
