#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "drivers/frame_source.hpp"
#include "drivers/openni/camera_options.hpp"
#include "pipeline/messages/messages.hpp"

namespace houghstream::capture {

struct CaptureSettings {
  WireFormat format;
  std::string channel = "OPENNI_FRAME";
  std::optional<double> rate_hz;       ///< default: the source's own rate
  std::optional<std::int64_t> frames;  ///< end after this many
  bool loop = false;                   ///< start again at the source's end; utimes continue to rise
  bool replace = false;                ///< a log that is there, instead of taking the next number
};

/// Counts of the frames.
struct CaptureResult {
  std::int64_t frames = 0;
  std::int64_t bytes = 0;
  double seconds = 0.0;
  std::string written;  ///< the log's name, which may have got a number
};

/// Opens the source; called again at its end where the settings require it. A camera reports its state to the listener.
using OpenSource = std::function<std::unique_ptr<FrameSource>(const openni::CameraListener&)>;

/// Publishes the source's frames on the network at their rate, those of a camera as they come, until its end or a stop
/// signal. The status goes out once a second whether frames come or not.
/// Throws InputError where a frame cannot be read or the source is empty.
CaptureResult capture_to_network(const OpenSource& open, const CaptureSettings& settings, const std::string& url);

/// Writes the same messages to an LCM log as fast as they come, stamped at the rate with which they are to be
/// replayed; a camera's with their utimes.
CaptureResult capture_to_log(const OpenSource& open, const CaptureSettings& settings, const std::string& file);

}  // namespace houghstream::capture
