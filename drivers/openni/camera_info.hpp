#pragma once

#include <filesystem>
#include <string>

#include "pipeline/types/camera.hpp"

namespace houghstream {

/// Reads a calibration file as ROS' camera_calibration writes it (YAML: image_width, image_height, camera_matrix with
/// nine numbers, row by row). Distortion is not corrected: where the file states some, a warning says so.
/// Throws InputError.
Camera read_camera_info(const std::filesystem::path& file);

/// The value of an option --camera: a calibration file, or "WIDTHxHEIGHT,fx,fy,cx,cy". Throws InputError.
Camera camera_of_option(const std::string& text);

}  // namespace houghstream
