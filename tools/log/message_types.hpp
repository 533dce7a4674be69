#pragma once

#include <cstdint>
#include <string>

#include "pipeline/messages/wire_reader.hpp"

namespace houghstream::log_tools {

/// The fingerprint that an encoded message begins with; 0 where it is too short to have one.
std::int64_t fingerprint_of(ByteView message);

/// Returns the type of a fingerprint, "images_t (bot_core)" for one that others use under the same fingerprint, "??
/// 20ba4f05e8f5e33a" where it is not known, "no message" for 0.
std::string type_name(std::int64_t fingerprint);

/// Returns whether it is a type of RGB-D frames: images_t, or one that to_images() converts to it.
bool is_frame_type(std::int64_t fingerprint);

}  // namespace houghstream::log_tools
