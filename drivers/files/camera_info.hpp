#pragma once

#include <filesystem>
#include <string>

#include "pipeline/types/camera.hpp"

namespace houghstream {

/// Reads the intrinsics of a camera from a file of ROS: a calibration as camera_calibration writes it (image_width,
/// image_height, camera_matrix with nine numbers, row by row), or a camera_info message as `ros2 topic echo --once`
/// prints it (width, height, k). Distortion is not corrected: where the file states some, a warning is logged. Throws
/// InputError.
Camera read_camera_info(const std::filesystem::path& file);

/// Reads the value of an option --camera: such a file, or "WIDTHxHEIGHT,fx,fy,cx,cy". Throws InputError.
Camera camera_of_option(const std::string& text);

/// Help text of an option --camera for frames.
inline constexpr const char* kCameraOptionHelp =
    "a ROS camera_info YAML file or WIDTHxHEIGHT,fx,fy,cx,cy, for frames without a camera of their own";

}  // namespace houghstream
