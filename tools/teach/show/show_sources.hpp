#pragma once

#include "tools/teach/show/show_options.hpp"

namespace houghstream::teach {

/// Frames of a camera (openni2...), which end after `options.longest_s` or with a stop signal, or of a recording:
/// log:FILE or FILE of any kind that hs-log import reads, bop:DIR, uw:DIR, tum:DIR. Throws InputError where it cannot
/// be opened.
ShownFrames open_shown(const std::string& source, const ShowOptions& options);

}  // namespace houghstream::teach
