#include "tools/log/third_party_frames.hpp"

#include <cstring>
#include <houghstream/drake_image_array_t.hpp>
#include <houghstream/kinect_frame_msg_t.hpp>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/image_decoding.hpp"
#include "pipeline/messages/codecs.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "pipeline/types/frame.hpp"
#include "tools/log/message_types.hpp"

namespace houghstream::log_tools {
namespace {

image_t read_kinect_colour(WireReader& reader) {
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

image_t read_kinect_depth(WireReader& reader, bool& zipped) {
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

using Wire = drake_image_t;

/// Refers to a drake.lcmt_image, whose data belong to the message.
struct DrakeImage {
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::int32_t row_stride = 0;
  ByteView data;
  bool big_endian = false;
  std::int8_t pixel_format = 0;
  std::int8_t channel_type = 0;
  std::int8_t compression = 0;
};

std::int64_t read_header(WireReader& reader) {
  reader.skip(4);  // counter
  const std::int64_t utime = reader.read_int64();
  reader.read_string();  // coordinate frame
  return utime;
}

DrakeImage read_image(WireReader& reader) {
  read_header(reader);
  DrakeImage image;
  image.width = reader.read_int32();
  image.height = reader.read_int32();
  image.row_stride = reader.read_int32();
  image.data = reader.read_bytes(reader.read_count(1));
  image.big_endian = reader.read_int8() != 0;
  image.pixel_format = reader.read_int8();
  image.channel_type = reader.read_int8();
  image.compression = reader.read_int8();
  return image;
}

/// Returns the image's rows, unpacked.
std::vector<std::uint8_t> unpacked(const DrakeImage& image, std::int64_t pixel_bytes) {
  check_image_size(image.width, image.height);
  require(image.row_stride == image.width * pixel_bytes, "rows of {} bytes, expected {} for {} pixels",
          image.row_stride, image.width * pixel_bytes, image.width);
  const auto size = static_cast<std::size_t>(pixel_bytes * image.width * image.height);
  if (image.compression == Wire::COMPRESSION_METHOD_ZLIB) return unzip(image.data, size);
  require(image.compression == Wire::COMPRESSION_METHOD_NOT_COMPRESSED,
          "images compressed by method {}, expected 0 to 3", image.compression);
  require(image.data.size == size, "raw image of {} bytes, expected {}", image.data.size, size);
  return bytes_of(image.data);
}

/// Returns width and height as a PNG's first chunk states them.
cv::Size png_size(ByteView png) {
  constexpr std::size_t kBefore = 16;  // signature, the chunk's length and name
  require(png.size >= kBefore + 8, "PNG of {} bytes, expected a header", png.size);
  WireReader reader({png.data + kBefore, 8}, "PNG");
  const std::int32_t width = reader.read_int32();
  return {width, reader.read_int32()};
}

cv::Mat decode_png(const DrakeImage& image, int type) {
  check_image_size(image.width, image.height);
  const cv::Size size = png_size(image.data);  // asked before memory is taken for it
  require(size.width == image.width && size.height == image.height, "PNG of {}x{} pixels, expected {}x{}", size.width,
          size.height, image.width, image.height);
  cv::Mat decoded =
      decode_image(image.data.data, image.data.size, type == CV_8UC3 ? cv::IMREAD_COLOR : cv::IMREAD_UNCHANGED);
  require(!decoded.empty(), "PNG of {} bytes cannot be decoded", image.data.size);
  require(decoded.type() == type && decoded.cols == image.width && decoded.rows == image.height,
          "PNG of {}x{} pixels and OpenCV type {}, expected {}x{} of type {}", decoded.cols, decoded.rows,
          decoded.type(), image.width, image.height, type);
  return decoded;
}

std::vector<std::uint8_t> pixels_of(const cv::Mat& continuous) {
  return {continuous.data, continuous.data + continuous.total() * continuous.elemSize()};
}

image_t colour_image(const DrakeImage& image) {
  require(image.channel_type == Wire::CHANNEL_TYPE_UINT8, "colour of channel type {}, expected 8 bits (1)",
          image.channel_type);
  check_image_size(image.width, image.height);  // checked before rows of so many pixels are read
  if (image.compression == Wire::COMPRESSION_METHOD_JPEG) {
    return make_image(image.width, image.height, image_t::PIXEL_FORMAT_MJPEG, 0, bytes_of(image.data));
  }
  if (image.compression == Wire::COMPRESSION_METHOD_PNG) {
    return make_image(image.width, image.height, image_t::PIXEL_FORMAT_BGR, 3 * image.width,
                      pixels_of(decode_png(image, CV_8UC3)));
  }
  const auto raw = [&](std::int32_t format, int channels) {
    return make_image(image.width, image.height, format, channels * image.width, unpacked(image, channels));
  };
  switch (image.pixel_format) {
    case Wire::PIXEL_FORMAT_GRAY: return raw(image_t::PIXEL_FORMAT_GRAY, 1);
    case Wire::PIXEL_FORMAT_RGB: return raw(image_t::PIXEL_FORMAT_RGB, 3);
    case Wire::PIXEL_FORMAT_BGR: return raw(image_t::PIXEL_FORMAT_BGR, 3);
    case Wire::PIXEL_FORMAT_RGBA: return raw(image_t::PIXEL_FORMAT_RGBA, 4);
    default: return raw(image_t::PIXEL_FORMAT_BGRA, 4);
  }
}

/// Converts metres to millimetres; infinite or non-positive depth is missing.
std::vector<std::uint8_t> millimetres(const DrakeImage& image) {
  const std::vector<std::uint8_t> bytes = unpacked(image, 4);
  cv::Mat metres(image.height, image.width, CV_32FC1);
  std::memcpy(metres.data, bytes.data(), bytes.size());
  return pixels_of(depth_to_millimetres(metres));
}

image_t depth_image(const DrakeImage& image) {
  check_image_size(image.width, image.height);
  require(!image.big_endian, "depth with the high byte first, expected the low one");
  const auto raw = [&](std::vector<std::uint8_t> data) {
    return make_image(image.width, image.height, image_t::PIXEL_FORMAT_LE_GRAY16, 2 * image.width, std::move(data));
  };
  if (image.channel_type == Wire::CHANNEL_TYPE_FLOAT32) return raw(millimetres(image));
  require(image.channel_type == Wire::CHANNEL_TYPE_UINT16,
          "depth of channel type {}, expected 16 bits (3) or 32-bit floats (6)", image.channel_type);
  if (image.compression == Wire::COMPRESSION_METHOD_PNG) return raw(pixels_of(decode_png(image, CV_16UC1)));
  return raw(unpacked(image, 2));
}

bool is_colour(const DrakeImage& image) {
  return image.pixel_format >= Wire::PIXEL_FORMAT_GRAY && image.pixel_format <= Wire::PIXEL_FORMAT_BGRA;
}

std::vector<DrakeImage> read_images(WireReader& reader) {
  constexpr std::size_t kMinImage = 4 + 8 + 5 + 4 * 4 + 4;
  std::vector<DrakeImage> images;
  for (std::size_t left = reader.read_count(kMinImage); left > 0; --left) images.push_back(read_image(reader));
  return images;
}

}  // namespace

images_t images_from_kinect(ByteView message) {
  WireReader reader(message, "kinect.frame_msg_t");
  const std::int64_t fingerprint = reader.read_int64();
  require(fingerprint == kinect_frame_msg_t::getHash(), "{}: another fingerprint", reader.source());
  const std::int64_t utime = reader.read_int64();
  image_t colour = read_kinect_colour(reader);
  bool zipped = false;
  image_t depth = read_kinect_depth(reader, zipped);
  const std::int16_t depth_type = zipped ? images_t::DEPTH_MM_ZIPPED : images_t::DEPTH_MM;
  constexpr std::size_t kMotor = 3 * 2 + 1 + 3 * 8 + 8 + 1 + 1;  // raw_accel to tilt_status
  reader.skip(kMotor);
  require(reader.left() == 0, "{}: {} bytes after its end", reader.source(), reader.left());
  return make_images(utime, std::move(colour), depth_type, std::move(depth));
}

images_t images_from_drake(ByteView message) {
  WireReader reader(message, "drake.lcmt_image_array");
  const std::int64_t fingerprint = reader.read_int64();
  require(fingerprint == drake_image_array_t::getHash(), "{}: another fingerprint", reader.source());
  const std::int64_t utime = read_header(reader);
  const std::vector<DrakeImage> images = read_images(reader);
  require(reader.left() == 0, "{}: {} bytes after its end", reader.source(), reader.left());
  std::vector<DrakeImage> colours;
  std::vector<DrakeImage> depths;
  for (const DrakeImage& image : images) {
    if (is_colour(image)) colours.push_back(image);
    if (image.pixel_format == Wire::PIXEL_FORMAT_DEPTH) depths.push_back(image);
  }
  require(colours.size() == 1 && depths.size() == 1, "{}: {} colour images and {} of depth, expected one each",
          reader.source(), colours.size(), depths.size());
  return make_images(utime, colour_image(colours[0]), images_t::DEPTH_MM, depth_image(depths[0]));
}

images_t to_images(ByteView message) {
  const std::int64_t fingerprint = fingerprint_of(message);
  if (fingerprint == kinect_frame_msg_t::getHash()) return images_from_kinect(message);
  if (fingerprint == drake_image_array_t::getHash()) return images_from_drake(message);
  return decode_message<images_t>(message);
}

}  // namespace houghstream::log_tools
