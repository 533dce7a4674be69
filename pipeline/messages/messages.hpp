#pragma once

#include <houghstream/camera_colours_t.hpp>
#include <houghstream/camera_timing_t.hpp>
#include <houghstream/detections_t.hpp>
#include <houghstream/images_t.hpp>
#include <houghstream/known_objects_t.hpp>
#include <houghstream/object_poses_t.hpp>
#include <houghstream/objects_t.hpp>
#include <houghstream/pose_probabilities_t.hpp>
#include <houghstream/rigid_transform_t.hpp>
#include <houghstream/teaching_t.hpp>
#include <optional>
#include <string>

#include "pipeline/types/camera_timing.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/known_objects.hpp"
#include "pipeline/types/object_pose.hpp"
#include "pipeline/types/teaching.hpp"
#include "pipeline/types/tracked_object.hpp"

// These functions convert plain structs to LCM messages and back. All data off the wire are checked here, once:
// functions that read throw InputError and never return a made-up value.

namespace houghstream {

/// Encoding of images on the wire.
struct WireFormat {
  bool jpeg = true;       ///< colour as JPEG, else raw RGB
  int jpeg_quality = 94;  ///< 1 to 100
  bool zip_depth = true;  ///< depth as DEPTH_MM_ZIPPED, else DEPTH_MM
  int zip_level = 1;      ///< zlib 1 to 9
};

/// Converts a frame; `sequence` counts the source's frames from 0, so that receivers can detect lost ones.
houghstream::images_t to_message(const RgbdFrame& frame, const WireFormat& format, std::int64_t sequence);

/// Add the camera, and the source's frame counter from 0, to frames that came without them. They throw InputError where
/// the message has no image to carry them or the camera is absurd.
void add_camera(houghstream::images_t& message, const Camera& camera);
void add_sequence(houghstream::images_t& message, std::int64_t sequence);

/// Adds the run of the frame's source, so that numbers that begin again are not taken for old ones.
void add_run(houghstream::images_t& message, std::int64_t run);

/// Finds colour (LEFT: RGB, BGR, RGBA, BGRA, GRAY or MJPEG) and depth (DEPTH_MM, DEPTH_MM_ZIPPED) by type, decodes them
/// and checks sizes. `channel` is the one that the message came on: it is half of the frame's name. The camera comes
/// from the metadata, else from `fallback_camera`, else the frame is refused.
RgbdFrame frame_from_message(const houghstream::images_t& message, const std::string& channel,
                             const std::optional<Camera>& fallback_camera);

/// Decodes a frame for readers of depth only: its colours, which take longer to decode than all the rest, stay empty,
/// and damage of them is not detected.
RgbdFrame depth_frame_from_message(const houghstream::images_t& message, const std::string& channel,
                                   const std::optional<Camera>& fallback_camera);

/// Holds colour and depth of a frame in the format of the wire; both have the same size.
struct FrameImages {
  cv::Mat colour;    ///< CV_8UC3, BGR
  cv::Mat depth_mm;  ///< CV_16UC1, 0 = none
};

/// Checks a message as frame_from_message() does; frames without a camera are allowed.
FrameImages images_from_message(const houghstream::images_t& message);

/// Returns the camera that the message carries, unchecked, if any. Throws InputError where its bytes are invalid.
std::optional<Camera> read_camera_metadata(const houghstream::images_t& message);
[[deprecated("is read_camera_metadata now")]] inline std::optional<Camera> camera_of(
    const houghstream::images_t& message) {
  return read_camera_metadata(message);
}

/// Returns the source's frame counter, if the message carries one.
std::optional<std::int64_t> read_sequence_number(const houghstream::images_t& message);
[[deprecated("is read_sequence_number now")]] inline std::optional<std::int64_t> sequence_of(
    const houghstream::images_t& message) {
  return read_sequence_number(message);
}

/// Keeps the first detection_t::MAX_VOTES rotations of each detection.
houghstream::detections_t to_message(const Detections& detections);
Detections detections_from_message(const houghstream::detections_t& message);

houghstream::object_poses_t to_message(const ObjectPoses& poses);
ObjectPoses poses_from_message(const houghstream::object_poses_t& message);

/// Returns the probabilities of the poses, which travel beside them. A pose that is read without them has `quality` as
/// its `shape_quality`.
houghstream::pose_probabilities_t probabilities_to_message(const ObjectPoses& poses);
/// Sets ObjectPose::shape_quality where the message is about these poses: of their frame, with their qualities. Returns
/// whether it is. Throws InputError where a probability is none.
bool apply_probabilities(const houghstream::pose_probabilities_t& message, ObjectPoses& poses);

/// The map that is learnt of the objects travels with them, for readers that do not learn it themselves.
houghstream::camera_colours_t to_message(const CameraChroma& colours);
/// Throws InputError where a colour, a lightness or a probability is none.
CameraChroma camera_colours_from_message(const houghstream::camera_colours_t& message);

houghstream::camera_timing_t to_message(const CameraTiming& timing);
/// Throws InputError for a lag beyond ten seconds, and for a deviation that is none.
CameraTiming camera_timing_from_message(const houghstream::camera_timing_t& message);

houghstream::rigid_transform_t to_message(std::int64_t utime, const Eigen::Isometry3d& T_camera_object);

/// Throws InputError where it is not rigid: a quaternion of another length than 1, a place that is not finite.
Eigen::Isometry3d transform_from_message(const houghstream::rigid_transform_t& message);

houghstream::objects_t to_message(const WorldObjects& objects);
WorldObjects world_from_message(const houghstream::objects_t& message);

/// Converts the known objects; the sender fills in its name and the time.
houghstream::known_objects_t to_message(const KnownObjects& known);

houghstream::teaching_t to_message(const Teaching& teaching);
Teaching teaching_from_message(const houghstream::teaching_t& message);

}  // namespace houghstream
