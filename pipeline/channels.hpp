#pragma once

#include <string>

namespace houghstream::channel {

inline const std::string kFrame = "OPENNI_FRAME";                 ///< images_t
inline const std::string kDetections = "HOUGHSTREAM_DETECTIONS";  ///< detections_t
inline const std::string kPoses = "HOUGHSTREAM_POSES";            ///< object_poses_t
inline const std::string kStatus = "HOUGHSTREAM_STATUS";          ///< status_t, 1 Hz, every process
inline const std::string kPreview = "HOUGHSTREAM_PREVIEW";        ///< image_t, MJPEG below 100 kB

/// "cereal_box" -> "CEREAL_BOX_TO_CAMERA", the channel of its rigid_transform_t.
std::string to_camera(const std::string& class_name);

}  // namespace houghstream::channel
