#include "tools/log/filter_log.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/types/frame_id.hpp"

namespace houghstream::log_tools {
namespace {

constexpr std::int64_t kHourUs = 3'600'000'000;

/// Returns the origin of a log's seconds: its first event whose date is close to that of most of its first ones.
std::int64_t origin_of(const std::filesystem::path& log_file) {
  constexpr std::size_t kAsked = 9;
  LossReport unheard;
  IntactEvents events(log_file, unheard);
  std::vector<std::int64_t> times;
  while (times.size() < kAsked) {
    const std::optional<LogEvent> event = events.next();
    if (!event) break;
    times.push_back(event->timestamp);
  }
  std::vector<std::int64_t> sorted = times;
  std::sort(sorted.begin(), sorted.end());
  const std::int64_t median = sorted[sorted.size() / 2];
  return *std::find_if(times.begin(), times.end(), [&](std::int64_t time) {
    const std::int64_t apart = microseconds_between(median, time);
    return apart > -kHourUs && apart < kHourUs;
  });
}

/// Checks the dates of a log's events, one after another.
class Dates {
 public:
  explicit Dates(std::int64_t origin) : origin_(origin) {}

  /// Returns the seconds since the origin.
  double note(std::int64_t time) {
    const std::int64_t since = microseconds_between(origin_, time);
    if (since < 0) {
      ++before_;
      earliest_ = std::min(earliest_, since);
    }
    const std::int64_t step = last_ ? microseconds_between(*last_, time) : 0;
    if (step > kHourUs || step < -kHourUs) ++jumps_;
    last_ = time;
    return static_cast<double>(since) * 1e-6;
  }

  void tell(LossReport& losses, bool by_time) const {
    if (before_ > 0) {
      losses.add_warning(fmt::format("{} events are dated before the log's first one, by up to {:.3f} s{}", before_,
                                     -1e-6 * static_cast<double>(earliest_),
                                     by_time ? ", and count as earlier than second 0" : ""));
    }
    if (jumps_ > 0) losses.add_warning(fmt::format("the date jumps by more than an hour at {} places", jumps_));
  }

 private:
  std::int64_t origin_;
  std::optional<std::int64_t> last_;
  std::int64_t before_ = 0;
  std::int64_t earliest_ = 0;
  std::int64_t jumps_ = 0;
};

}  // namespace

std::int64_t filter_log(const std::filesystem::path& log_file, const LogFilter& filter,
                        const std::filesystem::path& out_file, LossReport& losses) {
  const ChannelPattern channels(filter.channels);
  require_other_file(out_file, log_file);
  require(!filter.start_s || !filter.end_s || *filter.start_s <= *filter.end_s,
          "from {} s to {} s, expected an end that is not before the start", filter.start_s.value_or(0.0),
          filter.end_s.value_or(0.0));
  Dates dates(origin_of(log_file));
  IntactEvents events(log_file, losses);
  std::optional<LogWriter> out;  // made when there is something to write
  constexpr std::size_t kMaxNamed = 10;
  std::set<std::string> seen;  // channels
  double last_s = 0.0;
  std::int64_t kept = 0;
  while (const std::optional<LogEvent> event = events.next()) {
    const double time_s = dates.note(event->timestamp);
    last_s = std::max(last_s, time_s);
    if (seen.size() < kMaxNamed) seen.insert(event->channel);
    if ((filter.start_s && time_s < *filter.start_s) || (filter.end_s && time_s > *filter.end_s)) continue;
    if (channels.matches(event->channel) == filter.others) continue;
    if (!out) out.emplace(out_file);
    out->write(event->timestamp, event->channel, {event->data.data(), event->data.size()});
    ++kept;
  }
  dates.tell(losses, filter.start_s || filter.end_s);
  require(out.has_value(), "{}: no event from {} s to {} on {}channels '{}'; it lasts {:.3f} s, on {}",
          log_file.string(), filter.start_s.value_or(0.0),
          filter.end_s ? fmt::format("{} s", *filter.end_s) : "its end", filter.others ? "other than " : "",
          filter.channels, last_s, fmt::join(seen, ", "));
  out->close();
  return kept;
}

}  // namespace houghstream::log_tools
