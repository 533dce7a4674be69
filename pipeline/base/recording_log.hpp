#pragma once

#include "pipeline/base/files.hpp"

namespace houghstream {

/// Logs where a recording that begins has got the next number, and under what name stays what a killed program had
/// recorded.
void log_recording_names(const AtomicFile& recording);

}  // namespace houghstream
