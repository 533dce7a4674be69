#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "drivers/ros_bag/ros_messages.hpp"
#include "pipeline/types/camera.hpp"

// Images and cameras of ROS messages in this project's conventions. All functions throw InputError naming `source`.

namespace houghstream::ros_bag {

enum class ImageKind { kDepth, kColour, kGrey, kOther };

/// Returns what an image holds by its encoding: depth in 16UC1, mono16 or 32FC1, raw, as PNG or as compressedDepth;
/// colour in rgb8, bgr8, rgba8 or bgra8, or encoded (JPEG, PNG); grey in mono8.
ImageKind kind_of_image(const ImageMessage& image);

/// Returns colour or grey as CV_8UC3, BGR.
cv::Mat decode_colour(const ImageMessage& image, const std::string& source);

/// Returns depth as CV_32FC1, metres, NaN = none (0, negative and infinite ones). 16UC1 and mono16 are millimetres,
/// 32FC1 metres; compressedDepth of either is a PNG behind 12 bytes (ROS package compressed_depth_image_transport).
cv::Mat decode_depth(const ImageMessage& image, const std::string& source);

/// Returns the camera of the images that the message describes, with the region that was read and its binning taken
/// into account. A rectified image has the intrinsics of P, others those of K, whose distortion is not corrected: where
/// it is stated, a warning is logged.
Camera camera_of_info(const CameraInfoMessage& info, bool is_rectified, const std::string& source);

}  // namespace houghstream::ros_bag
