#pragma once

#include <string>

namespace houghstream::channel {

inline const std::string kFrame = "OPENNI_FRAME";                 ///< images_t
inline const std::string kDetections = "HOUGHSTREAM_DETECTIONS";  ///< detections_t
inline const std::string kPoses = "HOUGHSTREAM_POSES";            ///< object_poses_t
inline const std::string kStatus = "HOUGHSTREAM_STATUS";          ///< status_t, 1 Hz, every process
inline const std::string kPreview = "HOUGHSTREAM_PREVIEW";        ///< image_t, MJPEG below 100 kB

/// "cereal_box" -> "CEREAL_BOX_TO_CAMERA", the channel of its rigid_transform_t. Anything but letters and digits
/// becomes '_', and a long name is cut: LCM takes 63 bytes.
std::string to_camera(const std::string& class_name);

}  // namespace houghstream::channel

namespace houghstream::metadata {

inline const std::string kCamera = "houghstream.camera";      ///< an encoded camera_t
inline const std::string kStages = "houghstream.stages";      ///< encoded stage_time_t, one after another
inline const std::string kSequence = "houghstream.sequence";  ///< the source's frame counter from 0, decimal text

}  // namespace houghstream::metadata
