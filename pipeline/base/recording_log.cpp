#include "pipeline/base/recording_log.hpp"

#include "pipeline/base/log_line.hpp"

namespace houghstream {

void log_recording_names(const AtomicFile& recording) {
  if (recording.interrupted())
    log_warning("{}: was recorded until a program was killed, and stays", recording.interrupted()->string());
  if (recording.file() != recording.wanted())
    log_warning("{}: is there and stays; the recording goes to {}", recording.wanted().string(),
                recording.file().string());
}

}  // namespace houghstream
