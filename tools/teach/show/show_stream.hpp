#pragma once

#include <string>

#include "tools/teach/show/show_jobs.hpp"

namespace houghstream::teach {

/// Teaches an object that is shown to the camera of a running stream: frames are those of `options.channel` (empty:
/// OPENNI_FRAME) on the bus at `lcm_url` ("" = LCM's default), and the progress is published as teaching_t. The take
/// ends with a stop signal, after `options.max_duration_s`, or when more than half of the sphere was observed and no
/// new view comes; a stop signal after that ends the program. After the take the stream has priority over the teaching.
/// Returns and throws as show_object().
int show_from_stream(ShowOptions options, const std::string& lcm_url);

}  // namespace houghstream::teach
