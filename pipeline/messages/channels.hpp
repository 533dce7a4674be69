#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace houghstream::channel {

/// The longest name: LCM's reader of logs refuses longer ones, and on a network LCM itself those of more than 63.
inline constexpr std::size_t kMaxBytes = 999;

inline const std::string kFrame = "OPENNI_FRAME";                                ///< images_t
inline const std::string kDetections = "HOUGHSTREAM_DETECTIONS";                 ///< detections_t
inline const std::string kPoses = "HOUGHSTREAM_POSES";                           ///< object_poses_t
inline const std::string kPoseProbabilities = "HOUGHSTREAM_POSE_PROBABILITIES";  ///< pose_probabilities_t
inline const std::string kCameraColours = "HOUGHSTREAM_CAMERA_COLOURS";          ///< camera_colours_t, 1 Hz
inline const std::string kCameraTiming = "HOUGHSTREAM_CAMERA_TIMING";            ///< camera_timing_t, 1 Hz
inline const std::string kObjects = "HOUGHSTREAM_OBJECTS";                       ///< objects_t
inline const std::string kPlacedObjects = "HOUGHSTREAM_PLACED_OBJECTS";          ///< placed_objects_t
inline const std::string kStatus = "HOUGHSTREAM_STATUS";                         ///< status_t, 1 Hz, every process
inline const std::string kKnownObjects = "HOUGHSTREAM_KNOWN_OBJECTS";  ///< known_objects_t, 1 Hz, who has a store
inline const std::string kTeaching = "HOUGHSTREAM_TEACHING";           ///< teaching_t, while an object is shown
inline const std::string kPreview = "HOUGHSTREAM_PREVIEW";             ///< image_t, MJPEG below 100 kB
// The next ones belong to Drake's viewers.
inline const std::string kDrakeLoad = "DRAKE_VIEWER_LOAD_ROBOT";  ///< drake_viewer_load_robot_t
inline const std::string kDrakeDraw = "DRAKE_VIEWER_DRAW";        ///< drake_viewer_draw_t

/// Returns the channel of an object's rigid_transform_t: "cereal_box" -> "CEREAL_BOX_TO_CAMERA" where there is one
/// camera, and with the channel of the camera's frames, where there are several, "cereal_box", "left-cam" ->
/// "CEREAL_BOX_TO_LEFT_CAM". All characters but letters and digits become '_', and long names are cut, since LCM takes
/// 63 bytes. A camera's name that is cut ends with a number made of all of it, so that two cameras remain distinct.
std::string to_camera(const std::string& class_name, const std::string& camera_channel = "");

/// Returns the channel of a camera's pose, rigid_transform_t T_world_camera: "left-cam" -> "LEFT_CAM_TO_WORLD".
std::string to_world(const std::string& camera_channel);

/// Returns the channel of the pose_t of one object of the world: "cereal_box", 3 -> "CEREAL_BOX_3_POSE"; long names are
/// cut.
std::string object_pose(const std::string& class_name, std::int64_t track_id);

/// Returns the channel of the pose_t of a frame that is named on an object: "cereal_box", 3, "lid" ->
/// "CEREAL_BOX_3_LID_POSE"; long names are cut.
std::string frame_pose(const std::string& class_name, std::int64_t track_id, const std::string& frame);

/// Returns the camera's part of these channels.
std::string camera_name(const std::string& camera_channel);

/// Throws InputError unless LCM sends on a channel of this name, which has 1 to 63 bytes.
void require_name(const std::string& name);

}  // namespace houghstream::channel

namespace houghstream::metadata {

inline const std::string kCamera = "houghstream.camera";      ///< an encoded camera_t
inline const std::string kStages = "houghstream.stages";      ///< encoded stage_time_t, one after another
inline const std::string kSequence = "houghstream.sequence";  ///< the source's frame counter from 0, decimal text
inline const std::string kRun = "houghstream.run";  ///< time at which hs-capture began, microseconds, decimal text

}  // namespace houghstream::metadata
