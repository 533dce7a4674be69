#pragma once

#include <string>

#include "tools/teach/show/show_jobs.hpp"

namespace houghstream::teach {

/// Teaches an object that is shown to the camera of a stream that goes on: frames are those of `options.channel`
/// (empty: OPENNI_FRAME) on the bus at `lcm_url` ("" = LCM's default), and how it goes is published as teaching_t. The
/// take ends with a stop signal, after `options.max_duration_s`, or when more than half of the sphere was seen and
/// nothing new comes; a stop signal after that ends the program. From then on the stream goes first. Returns and throws
/// as show_object().
int show_from_stream(ShowOptions options, const std::string& lcm_url);

}  // namespace houghstream::teach
