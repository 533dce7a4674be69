#include "pipeline/bus/sequence_tracker.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <string_view>

namespace houghstream {
namespace {

constexpr std::int64_t kProbation = 16;        // maximum of lost frames that a single number may show
constexpr std::int64_t kMaxLost = 100'000;     // maximum that two neighbouring numbers may show: an hour
constexpr std::int64_t kRepeatUs = 1'000'000;  // a duplicate comes within this time
constexpr std::size_t kRuns = 4;               // senders on one channel whose numbers are kept apart
constexpr std::int64_t kBeside = 8;            // maximum distance of the first numbers after a jump
constexpr std::size_t kFar = 8;
constexpr std::size_t kJumps = 3;
constexpr std::size_t kHeard = 256;

}  // namespace

FrameOrder SequenceTracker::note(const FrameNumber& frame, std::int64_t now_us) {
  if (!frame.sequence || *frame.sequence < 0) return FrameOrder::kNext;
  has_number_ = true;
  const Seen arrival{*frame.sequence, frame.utime, now_us};
  bool is_new = false;
  Run& run = run_of(frame.run, arrival, is_new);
  if (is_new) return FrameOrder::kNext;
  const auto has = [&](const SequenceRange& range) { return is_duplicate(range.seen[slot(arrival.number)], arrival); };
  if (has(run.range) || std::any_of(run.before.begin(), run.before.end(), has)) return FrameOrder::kDuplicate;
  return has_place(run.range, arrival.number) ? place(run.range, arrival) : note_probation(run, arrival);
}

std::optional<std::int64_t> SequenceTracker::lost() const {
  if (!has_number_) return std::nullopt;
  std::int64_t lost = lost_;
  for (const Run& run : runs_) lost += run.range.lost;
  return lost;
}

SequenceTracker::Run& SequenceTracker::run_of(std::int64_t id, const Seen& frame, bool& is_new) {
  const auto known = std::find_if(runs_.begin(), runs_.end(), [&](const Run& run) { return run.id == id; });
  is_new = known == runs_.end();
  if (!is_new) {
    runs_.splice(runs_.begin(), runs_, known);
    return runs_.front();
  }
  Run& run = runs_.emplace_front();
  run.id = id;
  run.range.first = run.range.newest = frame.number;
  run.range.seen[slot(frame.number)] = frame;
  if (runs_.size() > kRuns) {
    lost_ += runs_.back().range.lost;
    runs_.pop_back();
  }
  return run;
}

std::size_t SequenceTracker::slot(std::int64_t number) {
  return static_cast<std::size_t>(number % kWindow);
}

bool SequenceTracker::is_duplicate(const Seen& seen, const Seen& frame) {
  return seen.number == frame.number && seen.utime == frame.utime &&
         microseconds_between(seen.arrival_us, frame.arrival_us) <= kRepeatUs;
}

/// Returns whether the number lies close to the newest one and no other frame has had it.
bool SequenceTracker::has_place(const SequenceRange& range, std::int64_t number) {
  if (number > range.newest) return number - range.newest <= kProbation;
  return number >= range.first && range.newest - number < kWindow && range.seen[slot(number)].number != number;
}

FrameOrder SequenceTracker::place(SequenceRange& range, const Seen& frame) {
  range.seen[slot(frame.number)] = frame;
  if (frame.number < range.newest) {
    --range.lost;
    return FrameOrder::kLate;
  }
  range.lost += frame.number - range.newest - 1;
  range.newest = frame.number;
  return FrameOrder::kNext;
}

FrameOrder SequenceTracker::note_probation(Run& run, const Seen& frame) {
  const auto is_it = [&](const Seen& other) { return is_duplicate(other, frame); };
  if (std::any_of(run.probation.begin(), run.probation.end(), is_it)) return FrameOrder::kDuplicate;
  const auto beside = std::find_if(run.probation.rbegin(), run.probation.rend(), [&](const Seen& other) {
    return other.number != frame.number && std::abs(other.number - frame.number) <= kBeside;
  });
  const std::int64_t partner = beside == run.probation.rend() ? -1 : beside->number;
  if (run.probation.size() == kFar) run.probation.pop_front();
  run.probation.push_back(frame);
  if (partner >= 0) resync(run, std::min(partner, frame.number), std::max(partner, frame.number));
  return FrameOrder::kNext;
}

/// Two neighbouring numbers end the probation: an earlier range is resumed, or a new one begins.
void SequenceTracker::resync(Run& run, std::int64_t low, std::int64_t high) {
  const auto earlier = std::find_if(run.before.begin(), run.before.end(), [&](const SequenceRange& range) {
    return high > range.newest && has_place(range, low);
  });
  const bool is_resumed = earlier != run.before.end();
  if (is_resumed) {
    std::swap(run.range, *earlier);
  } else {
    run.before.push_front(run.range);
    if (run.before.size() > kJumps) run.before.pop_back();
    const std::int64_t missing = low - run.range.newest - 1;
    if (low > run.range.newest && missing <= kMaxLost) run.range.lost += missing;
    run.range.first = run.range.newest = low;
    run.range.seen = {};
  }
  // All of them that belong here, in their order, whatever came in between.
  std::sort(run.probation.begin(), run.probation.end(),
            [](const Seen& a, const Seen& b) { return a.number < b.number; });
  std::deque<Seen> still_far;
  for (const Seen& frame : run.probation) {
    const bool is_low = !is_resumed && frame.number == low;
    if (is_low) run.range.seen[slot(low)] = frame;
    if (!is_low && has_place(run.range, frame.number)) {
      place(run.range, frame);
    } else if (!is_low) {
      still_far.push_back(frame);
    }
  }
  run.probation = std::move(still_far);
}

bool DuplicateFilter::is_duplicate(const FrameId& frame, const std::uint8_t* bytes, std::size_t size,
                                   Clock::time_point arrival) {
  constexpr std::chrono::microseconds kRepeat(kRepeatUs);
  while (!received_.empty() && (arrival - received_.front().arrival > kRepeat || received_.size() >= kHeard))
    received_.pop_front();
  const std::size_t hash = std::hash<std::string_view>()(std::string_view(reinterpret_cast<const char*>(bytes), size));
  const bool found = std::any_of(received_.begin(), received_.end(), [&](const Received& received) {
    return received.hash == hash && received.frame == frame;
  });
  if (!found) received_.push_back({frame, hash, arrival});
  return found;
}

}  // namespace houghstream
