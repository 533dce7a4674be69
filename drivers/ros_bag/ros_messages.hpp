#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/ros_bag/byte_reader.hpp"

// Messages of ROS 1 (package sensor_msgs) as they are serialised. All functions throw InputError naming `source` where
// a message is cut, longer than it should be, or damaged. Results refer to the message's bytes.

namespace houghstream::ros_bag {

inline constexpr const char* kImageType = "sensor_msgs/Image";
inline constexpr const char* kCompressedImageType = "sensor_msgs/CompressedImage";
inline constexpr const char* kCameraInfoType = "sensor_msgs/CameraInfo";

/// The std_msgs/Header that each of these messages begins with.
struct MessageHeader {
  std::int64_t stamp_us = 0;  ///< time of capture, microseconds since the epoch; 0 = none was given
  std::string frame_id;
};

/// Holds an image, raw or encoded.
struct ImageMessage {
  MessageHeader header;
  std::string encoding;      ///< "rgb8", "16UC1"; of an encoded one its format, "16UC1; compressedDepth"
  bool is_encoded = false;   ///< a sensor_msgs/CompressedImage: only header, encoding and data count
  std::uint32_t width = 0;   ///< pixels
  std::uint32_t height = 0;  ///< pixels
  bool is_big_endian = false;
  std::uint32_t row_bytes = 0;
  ByteRange data;
};

/// Holds intrinsics and distortion (sensor_msgs/CameraInfo) of the whole sensor, and what of it an image shows.
struct CameraInfoMessage {
  MessageHeader header;
  std::uint32_t width = 0;              ///< pixels of the sensor
  std::uint32_t height = 0;             ///< pixels of the sensor
  std::vector<double> distortion;       ///< coefficients of its model
  std::array<double, 9> intrinsics{};   ///< intrinsics of the raw image, row by row
  std::array<double, 12> projection{};  ///< projection of the rectified image, row by row
  std::uint32_t binning_x = 0;          ///< pixels of the sensor that are one of the image; 0 means 1
  std::uint32_t binning_y = 0;          ///< as above
  std::uint32_t roi_x = 0;              ///< first column of the region that was read, pixels of the sensor
  std::uint32_t roi_y = 0;              ///< first row of it
  std::uint32_t roi_width = 0;          ///< pixels of the sensor; 0 = all
  std::uint32_t roi_height = 0;         ///< as above
};

MessageHeader parse_header(ByteRange message, const std::string& source);

/// Parses a message of the type kImageType or kCompressedImageType.
ImageMessage parse_image(ByteRange message, const std::string& type, const std::string& source);

CameraInfoMessage parse_camera_info(ByteRange message, const std::string& source);

}  // namespace houghstream::ros_bag
