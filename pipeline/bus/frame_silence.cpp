#include "pipeline/bus/frame_silence.hpp"

#include <fmt/format.h>

#include <utility>

#include "pipeline/base/printable.hpp"

namespace houghstream {

namespace {

constexpr std::size_t kMaxFrameChannels = 64;  // a sender of rubbish may make up channels without end

}  // namespace

void FrameSilence::note_elsewhere(const std::string& channel) {
  if (elsewhere_.size() < kMaxFrameChannels) elsewhere_.insert(channel);
}

bool FrameSilence::wants_to_listen(Clock::time_point now) {
  const bool is_silent = now - last_ >= kListenAfter;
  if (since_ && (!is_silent || now - *since_ >= kListen)) {
    has_listened_ = is_silent;
    since_.reset();
    next_ = now + kPause;
  } else if (!since_ && is_silent && now >= next_) {
    elsewhere_.clear();
    since_ = now;
  }
  return since_.has_value();
}

std::optional<std::string> FrameSilence::words(Clock::time_point now) {
  if (!std::exchange(has_listened_, false)) return std::nullopt;
  if (elsewhere_.empty() && now - last_ < kNowhere) return std::nullopt;
  const std::string line = frames_elsewhere(wanted_, elsewhere_);
  if (line == told_) return std::nullopt;
  told_ = line;
  return line;
}

std::string frames_elsewhere(const std::string& wanted, const std::set<std::string>& elsewhere) {
  constexpr std::size_t kMaxNamed = 8;
  if (elsewhere.empty()) return fmt::format("no frame on {}, nor on any other channel", wanted);
  std::string names;
  std::size_t named = 0;
  for (auto name = elsewhere.begin(); name != elsewhere.end() && named < kMaxNamed; ++name, ++named)
    names += (names.empty() ? "" : ", ") + printable(*name);
  return fmt::format("no frame on {}; frames come on {}{}", wanted, names, elsewhere.size() > named ? ", ..." : "");
}

}  // namespace houghstream
