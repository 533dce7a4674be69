#include "drivers/ros_bag/ros_messages.hpp"

namespace houghstream::ros_bag {
namespace {

MessageHeader read_header(ByteReader& reader) {
  reader.read<std::uint32_t>();  // a number that ROS 1 leaves to the publisher
  const auto seconds = reader.read<std::uint32_t>();
  const auto nanoseconds = reader.read<std::uint32_t>();
  require(nanoseconds < 1'000'000'000, "{}: stamp with {} nanoseconds, expected less than a second", reader.source(),
          nanoseconds);
  MessageHeader header;
  header.stamp_us = std::int64_t{seconds} * 1'000'000 + nanoseconds / 1000;
  header.frame_id = reader.read_text();
  return header;
}

template <std::size_t Count>
std::array<double, Count> read_matrix(ByteReader& reader) {
  std::array<double, Count> matrix{};
  for (double& number : matrix) number = reader.read<double>();
  return matrix;
}

}  // namespace

MessageHeader parse_header(ByteRange message, const std::string& source) {
  ByteReader reader(message, source);
  return read_header(reader);
}

ImageMessage parse_image(ByteRange message, const std::string& type, const std::string& source) {
  ByteReader reader(message, source);
  ImageMessage image;
  image.header = read_header(reader);
  image.is_encoded = type == kCompressedImageType;
  if (image.is_encoded) {
    image.encoding = reader.read_text();
  } else {
    image.height = reader.read<std::uint32_t>();
    image.width = reader.read<std::uint32_t>();
    image.encoding = reader.read_text();
    image.is_big_endian = reader.read<std::uint8_t>() != 0;
    image.row_bytes = reader.read<std::uint32_t>();
  }
  image.data = reader.read_sized();
  reader.require_end();
  return image;
}

CameraInfoMessage parse_camera_info(ByteRange message, const std::string& source) {
  ByteReader reader(message, source);
  CameraInfoMessage info;
  info.header = read_header(reader);
  info.height = reader.read<std::uint32_t>();
  info.width = reader.read<std::uint32_t>();
  reader.read_text();  // the distortion's model
  const auto coefficients = reader.read<std::uint32_t>();
  require(coefficients <= reader.left() / sizeof(double),
          "{}: {} coefficients of distortion, expected as many as there are bytes for", source, coefficients);
  for (std::uint32_t i = 0; i < coefficients; ++i) info.distortion.push_back(reader.read<double>());
  info.intrinsics = read_matrix<9>(reader);
  read_matrix<9>(reader);  // the rectifying rotation
  info.projection = read_matrix<12>(reader);
  info.binning_x = reader.read<std::uint32_t>();
  info.binning_y = reader.read<std::uint32_t>();
  info.roi_x = reader.read<std::uint32_t>();
  info.roi_y = reader.read<std::uint32_t>();
  info.roi_height = reader.read<std::uint32_t>();
  info.roi_width = reader.read<std::uint32_t>();
  reader.read<std::uint8_t>();  // whether to rectify
  reader.require_end();
  return info;
}

}  // namespace houghstream::ros_bag
