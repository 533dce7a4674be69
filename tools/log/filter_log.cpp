#include "tools/log/filter_log.hpp"

#include "pipeline/base/checks.hpp"
#include "pipeline/bus/channel_pattern.hpp"

namespace houghstream::log_tools {
std::int64_t filter_log(const std::filesystem::path& log_file, const LogFilter& filter,
                        const std::filesystem::path& out_file, LossAccount& losses) {
  const ChannelPattern channels(filter.channels);
  std::error_code no_such_file;
  require(!std::filesystem::equivalent(log_file, out_file, no_such_file),
          "{}: is the log itself, expected another file to write", out_file.string());
  GoodEvents events(log_file, losses);
  std::optional<LogWriter> out;  // not before there is something to write
  std::optional<std::int64_t> first;
  std::int64_t kept = 0;
  while (const std::optional<LogEvent> event = events.next()) {
    if (!first) first = event->timestamp;
    const double time_s = static_cast<double>(event->timestamp - *first) * 1e-6;
    if (time_s < filter.start_s || time_s > filter.end_s) continue;
    if (channels.matches(event->channel) == filter.others) continue;
    if (!out) out.emplace(out_file);
    out->write(event->timestamp, event->channel, {event->data.data(), event->data.size()});
    ++kept;
  }
  require(out.has_value(), "{}: no event from {} s to {} s on {}channels '{}'", log_file.string(), filter.start_s,
          filter.end_s, filter.others ? "other than " : "", filter.channels);
  out->close();
  return kept;
}

}  // namespace houghstream::log_tools
