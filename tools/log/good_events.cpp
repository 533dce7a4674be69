#include "tools/log/good_events.hpp"

#include <csignal>
#include <utility>

#include "pipeline/base/checks.hpp"

namespace houghstream::log_tools {

void require_not_stopped() {
  sigset_t waiting;
  sigpending(&waiting);
  if (sigismember(&waiting, SIGINT) == 1 || sigismember(&waiting, SIGTERM) == 1) throw Stopped();
}

void LossReport::note_damage(std::uint64_t bytes, const std::string& reason) {
  if (damaged_places_ == 0) first_damage_ = reason;
  ++damaged_places_;
  damaged_bytes_ += bytes;
}

void LossReport::note_refused(const std::string& reason) {
  if (refused_ == 0) first_refusal_ = reason;
  ++refused_;
}

std::string LossReport::line() const {
  std::string line;
  if (damaged_places_ > 0) {
    line = fmt::format("{} bytes lost at {} damaged {}, first: {}", damaged_bytes_, damaged_places_,
                       damaged_places_ == 1 ? "place" : "places", first_damage_);
  }
  if (refused_ > 0) {
    line += fmt::format("{}{} left out, first: {}", line.empty() ? "" : "; ", refused_, first_refusal_);
  }
  if (!oddities_.empty()) line += (line.empty() ? "" : "; ") + oddities_;
  return line;
}

IntactEvents::IntactEvents(const std::filesystem::path& file, LossReport& losses)
    : file_(file), log_(file), losses_(losses), progress_(file.filename().string(), static_cast<double>(log_.size())) {}

std::optional<LogEvent> IntactEvents::read() {
  while (!ended_) {
    require_not_stopped();
    std::optional<LogEvent> ready = std::exchange(held_, std::nullopt);
    try {
      held_ = log_.next();
      ended_ = !held_;
    } catch (const InputError& error) {
      const LogReader::Damage damage = log_.skip_damage();
      losses_.note_damage(damage.bytes, error.what());
      if (damage.last_event_too) ready.reset();
    }
    progress_.at(static_cast<double>(log_.position()));
    if (ready) return ready;
  }
  return std::nullopt;
}

std::optional<LogEvent> IntactEvents::next() {
  std::optional<LogEvent> event = read();
  require(event.has_value() || count_ > 0, "{}: no event of an LCM log in it: {}", file_.string(), losses_.line());
  if (event) ++count_;
  return event;
}

}  // namespace houghstream::log_tools
