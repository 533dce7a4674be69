#pragma once

#include <houghstream/images_t.hpp>

#include "pipeline/messages/wire_reader.hpp"

// Other people's RGB-D messages as images_t. What travels compressed stays as it is, bit for bit. Throws InputError
// where a message is damaged, or its images are of a kind that images_t cannot carry.

namespace houghstream::log_tools {

/// A kinect.frame_msg_t (openhumanoids/kinect): colour RGB or JPEG, depth in millimetres, raw or zlib. Depth that is
/// not registered to colour (DEPTH_MM of libfreenect) is taken as it is.
images_t images_from_kinect(ByteView message);

/// A drake.lcmt_image_array with one colour image and one depth image of the same size: colour of 8 bits (RGB, BGR,
/// RGBA, BGRA, GRAY), raw, zlib, JPEG or PNG; depth in millimetres of 16 bits, or in metres as 32-bit floats, which are
/// rounded to millimetres; raw, zlib or PNG. Other images in it are passed over.
images_t images_from_drake(ByteView message);

}  // namespace houghstream::log_tools
