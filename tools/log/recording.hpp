#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <houghstream/images_t.hpp>
#include <optional>
#include <string>

#include "pipeline/types/camera.hpp"
#include "tools/log/good_events.hpp"

namespace houghstream::log_tools {

struct RecordedFrame {
  std::int64_t timestamp = 0;  ///< time of reception or capture, microseconds since the epoch
  images_t message;
  std::string channel;  ///< channel of a log's frame; else empty
};

/// The next frame of a recording, or nothing at its end.
using NextFrame = std::function<std::optional<RecordedFrame>()>;

struct RecordingSettings {
  /// An LCM log, FILE.klg (or klg:FILE), FILE.oni (or oni:FILE), a ROS 1 bag, or what open_frame_source() knows.
  std::string source;
  std::string channel;           ///< channel of the frames in a log; "" = the first channel that holds frames
  std::optional<Camera> camera;  ///< given to frames that come without
};

/// Opens a recording of RGB-D frames of any kind. Its frames are images_t whose images can be decoded, with raw colour
/// where they come from files; other people's messages become images_t without touching what is compressed. A frame
/// that cannot be understood is left out and counted in `losses`, which must outlive the result. Throws InputError
/// where the recording cannot be opened; its function throws where a log holds no event at all, or a file of a folder
/// cannot be read.
NextFrame open_recording(const RecordingSettings& settings, LossReport& losses);

/// Writes a recording's frames as images_t to an LCM log that the stream replays, each at the time of its event or of
/// its capture. Returns the number of frames. Throws InputError where nothing can be imported or written.
std::int64_t import_log(const RecordingSettings& settings, const std::string& channel,
                        const std::filesystem::path& log_file, LossReport& losses);

}  // namespace houghstream::log_tools
