#include <houghstream/kinect_frame_msg_t.hpp>

#include "pipeline/base/checks.hpp"
#include "tools/log/image_parts.hpp"
#include "tools/log/third_party_frames.hpp"

namespace houghstream::log_tools {
namespace {

image_t read_colour(WireReader& reader) {
  reader.skip(8);  // its own time
  const std::int16_t width = reader.read_int16();
  const std::int16_t height = reader.read_int16();
  const ByteView data = reader.read_bytes(reader.read_count(1));
  const std::int8_t format = reader.read_int8();
  if (format == kinect_image_msg_t::VIDEO_RGB_JPEG) {
    return make_image(width, height, image_t::PIXEL_FORMAT_MJPEG, 0, bytes_of(data));
  }
  require(format == kinect_image_msg_t::VIDEO_RGB, "{}: colour of format {}, expected RGB (0) or JPEG (100)",
          reader.source(), format);
  return make_image(width, height, image_t::PIXEL_FORMAT_RGB, 3 * width, bytes_of(data));
}

image_t read_depth(WireReader& reader, bool& zipped) {
  reader.skip(8);  // its own time
  const std::int16_t width = reader.read_int16();
  const std::int16_t height = reader.read_int16();
  const ByteView data = reader.read_bytes(reader.read_count(1));
  const std::int8_t format = reader.read_int8();
  const std::int8_t compression = reader.read_int8();
  reader.skip(4);  // the unpacked size follows from the pixels
  require(format == kinect_depth_msg_t::DEPTH_MM || format == kinect_depth_msg_t::DEPTH_REGISTERED,
          "{}: depth of format {}, expected millimetres (4 or 5); raw disparities need the sensor's calibration",
          reader.source(), format);
  require(compression == kinect_depth_msg_t::COMPRESSION_NONE || compression == kinect_depth_msg_t::COMPRESSION_ZLIB,
          "{}: depth compressed by method {}, expected none (0) or zlib (1)", reader.source(), compression);
  zipped = compression == kinect_depth_msg_t::COMPRESSION_ZLIB;
  return make_image(width, height, image_t::PIXEL_FORMAT_LE_GRAY16, zipped ? 0 : 2 * width, bytes_of(data));
}

}  // namespace

images_t images_from_kinect(ByteView message) {
  WireReader reader(message, "kinect.frame_msg_t");
  const std::int64_t fingerprint = reader.read_int64();
  require(fingerprint == kinect_frame_msg_t::getHash(), "{}: another fingerprint", reader.source());
  const std::int64_t utime = reader.read_int64();
  image_t colour = read_colour(reader);
  bool zipped = false;
  image_t depth = read_depth(reader, zipped);
  const std::int16_t depth_type = zipped ? images_t::DEPTH_MM_ZIPPED : images_t::DEPTH_MM;
  constexpr std::size_t kMotor = 3 * 2 + 1 + 3 * 8 + 8 + 1 + 1;  // raw_accel to tilt_status
  reader.skip(kMotor);
  require(reader.left() == 0, "{}: {} bytes after its end", reader.source(), reader.left());
  return make_images(utime, std::move(colour), depth_type, std::move(depth));
}

}  // namespace houghstream::log_tools
