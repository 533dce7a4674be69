#include "tools/log/import_log.hpp"

#include "drivers/datasets/open_frame_source.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/wire_check.hpp"

namespace houghstream::log_tools {

std::int64_t import_log(const RecordingSettings& settings, const std::string& channel,
                        const std::filesystem::path& log_file, LossReport& losses) {
  channel::require_name(channel);
  require_outside_source(log_file, settings.source);
  const NextFrame next = open_recording(settings, losses);
  std::optional<LogWriter> log;  // not before there is something to write
  std::int64_t frames = 0;
  while (const std::optional<RecordedFrame> frame = next()) {
    const std::vector<std::uint8_t> bytes = encode_message(frame->message);
    if (!log) log.emplace(log_file);
    log->write(frame->timestamp, channel, {bytes.data(), bytes.size()});
    ++frames;
  }
  require(log.has_value(), "{}: no frame could be imported: {}", settings.source, losses.line());
  log->close();
  return frames;
}

}  // namespace houghstream::log_tools
