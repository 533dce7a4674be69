#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "pose/motion/last_step.hpp"
#include "pose/reconstruction/tracking/frame_follower.hpp"
#include "pose/reconstruction/tracking/motion_classification.hpp"
#include "pose/reconstruction/tracking/relocalisation.hpp"
#include "pose/reconstruction/tracking/take.hpp"

namespace houghstream::reconstruction {

enum class TakeMapperState : std::uint8_t { kChoosing, kTracking, kLost };

struct TakeMapperSettings {
  SelectionSettings selection;
  MapSettings map;                 ///< middle and plane are those of the object
  int max_frames_to_choose = 45;   ///< frames without an object after which the take fails
  double keyframe_angle = 0.12;    ///< radians between the views of keyframes
  double min_sharpness = 0.5;      ///< fraction of the median of the frames around; a frame below it is blurred
  double max_dark_fraction = 0.7;  ///< fraction of an image; a frame above it is badly exposed
  double max_bright_fraction = 0.4;
};

/// Status of the mapper, which is valid at any time.
struct TakeMapperStatus {
  TakeMapperState state = TakeMapperState::kChoosing;
  std::string message;  ///< message for a person, one line
  ViewCoverage seen{};  ///< directions from which the object was observed
  int frames = 0;
  int keyframes = 0;
  cv::Rect box_px;  ///< box of the object in the last frame; empty where it is not known
  std::optional<Eigen::Isometry3d> T_camera_object;  ///< metres; z up, origin at its foot
};

/// Follows an object on a table through the frames of a take, in which the camera is carried about it, or the object
/// rotates before a static camera. Each frame is registered to a map of the nearest keyframes (align_frame); table
/// points are constrained to one plane; when the loop closes, its error is distributed over it. Lost frames are
/// relocalised by neighbouring keyframes and by ORB landmarks. It uses one thread; the same frames give the same
/// result.
class TakeMapper {
 public:
  explicit TakeMapper(const TakeMapperSettings& settings) : settings_(settings), map_(settings.map) {}

  /// Processes the next frame. Throws InputError with the reason where no object was found in the first frames, and for
  /// a frame of another size than the first.
  const TakeMapperStatus& process(const RgbdFrame& frame);
  const TakeMapperStatus& state() const { return state_; }

  /// Registers all keyframes to one another once more and hands over the take. Throws InputError where there is none.
  Take finish();

 private:
  // These are the steps of process() and finish() in the order of their calls.
  void require_same_size(const RgbdFrame& frame);
  void initialise(const RgbdFrame& frame);
  bool is_usable_for_model(const ImageQuality& quality);
  void follow_object_only();
  void express_relative_to_first_keyframe();
  std::optional<Alignment> relocalise(const RgbdFrame& frame, const FrameLevels& levels, bool everywhere,
                                      LandmarkCache& cache);
  void register_frame(int number, const RgbdFrame& frame, FrameLevels levels, const Alignment& alignment);
  cv::Mat landmark_mask(const RgbdFrame& frame, const Eigen::Isometry3d& T_camera_world) const;
  void add_keyframe(Keyframe keyframe, const Alignment& alignment);
  void note_lost(const FrameLevels& levels);
  void describe();
  void relocalise_lost_frames();

  TakeMapperSettings settings_;
  TakeMapperStatus state_;
  SelectedObject selected_;
  KeyframeMap map_;
  LevelSettings levels_;
  Motion motion_ = Motion::kUnknown;
  MotionClassifier motion_classifier_;    ///< since the frame in which the object was selected
  StaticShadingDetector static_shading_;  ///< shade and highlights, which stay in place while the object turns
  FrameFollower follower_;
  cv::Size size_;  ///< size of all frames, pixels
  int first_number_ = 0;
  LastStep step_;  ///< T_camera_world of the last registered frame, and of the one before it
  std::vector<LostFrame> lost_frames_;
  Relocaliser relocaliser_;
  std::deque<double> sharpness_;
  Take take_;
  std::vector<bool> covered_sectors_;  ///< for each ten degrees of the turn, whether it was observed
  double seconds_ = 0.0;
};

}  // namespace houghstream::reconstruction
