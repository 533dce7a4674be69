#pragma once

#include <cstdint>
#include <houghstream/images_t.hpp>
#include <utility>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/messages/wire_reader.hpp"

// These functions convert RGB-D messages of other projects to images_t. Compressed images stay as they are, bit for
// bit. They throw InputError where a message is damaged, or its images are of a kind that images_t cannot carry.

namespace houghstream::log_tools {

inline std::vector<std::uint8_t> bytes_of(ByteView view) {
  return {view.data, view.data + view.size};
}

/// Makes an image_t without its metadata; row_stride is 0 where `data` is compressed.
inline image_t make_image(std::int32_t width, std::int32_t height, std::int32_t pixelformat, std::int32_t row_stride,
                          std::vector<std::uint8_t> data) {
  image_t image{};
  image.width = width;
  image.height = height;
  image.pixelformat = pixelformat;
  image.row_stride = row_stride;
  image.size = static_cast<std::int32_t>(data.size());
  image.data = std::move(data);
  return image;
}

/// Makes the images {LEFT, depth}, which take the frame's time.
inline images_t make_images(std::int64_t utime, image_t colour, std::int16_t depth_type, image_t depth) {
  images_t message{};
  message.utime = utime;
  message.n_images = 2;
  message.image_types = {images_t::LEFT, depth_type};
  colour.utime = utime;
  depth.utime = utime;
  message.images = {std::move(colour), std::move(depth)};
  return message;
}

/// Converts a kinect.frame_msg_t (openhumanoids/kinect): colour RGB or JPEG, depth in millimetres, raw or zlib. Depth
/// that is not registered to colour (DEPTH_MM of libfreenect) is taken as it is.
images_t images_from_kinect(ByteView message);

/// Converts a drake.lcmt_image_array with one colour image and one depth image of the same size: colour of 8 bits (RGB,
/// BGR, RGBA, BGRA, GRAY), raw, zlib, JPEG or PNG; depth in millimetres of 16 bits, or in metres as 32-bit floats,
/// which are rounded to millimetres; raw, zlib or PNG. Other images in it are ignored.
images_t images_from_drake(ByteView message);

/// Converts a message of either kind, or decodes an images_t.
images_t to_images(ByteView message);

}  // namespace houghstream::log_tools
