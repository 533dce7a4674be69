#include "pipeline/bus/sequence_count.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <string_view>

namespace houghstream {
namespace {

constexpr std::int64_t kProbation = 16;        // frames that a single number may tell to be lost
constexpr std::int64_t kMaxLost = 100'000;     // and two beside each other: an hour
constexpr std::int64_t kRepeatUs = 1'000'000;  // a duplicate comes within this time
constexpr std::size_t kRuns = 4;               // senders on one channel whose numbers are kept apart
constexpr std::int64_t kBeside = 8;            // so close are the first numbers after a jump
constexpr std::size_t kFar = 8;
constexpr std::size_t kJumps = 3;
constexpr std::size_t kHeard = 256;

}  // namespace

FrameOrder SequenceTracker::note(const FrameNumber& frame, std::int64_t now_us) {
  if (!frame.sequence || *frame.sequence < 0) return FrameOrder::kNext;
  has_number_ = true;
  const Seen arrived{*frame.sequence, frame.utime, now_us};
  bool is_new = false;
  Run& run = run_of(frame.run, arrived, is_new);
  if (is_new) return FrameOrder::kNext;
  const auto has = [&](const SequenceRange& course) { return is_repeated(course.seen[slot(arrived.number)], arrived); };
  if (has(run.course) || std::any_of(run.before.begin(), run.before.end(), has)) return FrameOrder::kDuplicate;
  return has_place(run.course, arrived.number) ? place(run.course, arrived) : note_far(run, arrived);
}

std::optional<std::int64_t> SequenceTracker::lost() const {
  if (!has_number_) return std::nullopt;
  std::int64_t lost = lost_;
  for (const Run& run : runs_) lost += run.course.lost;
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
  run.course.first = run.course.newest = frame.number;
  run.course.seen[slot(frame.number)] = frame;
  if (runs_.size() > kRuns) {
    lost_ += runs_.back().course.lost;
    runs_.pop_back();
  }
  return run;
}

std::size_t SequenceTracker::slot(std::int64_t number) {
  return static_cast<std::size_t>(number % kWindow);
}

bool SequenceTracker::is_repeated(const Seen& seen, const Seen& frame) {
  return seen.number == frame.number && seen.utime == frame.utime &&
         microseconds_between(seen.arrival_us, frame.arrival_us) <= kRepeatUs;
}

/// Whether the number lies close to the newest one, and no other frame has had it.
bool SequenceTracker::has_place(const SequenceRange& course, std::int64_t number) {
  if (number > course.newest) return number - course.newest <= kProbation;
  return number >= course.first && course.newest - number < kWindow && course.seen[slot(number)].number != number;
}

FrameOrder SequenceTracker::place(SequenceRange& course, const Seen& frame) {
  course.seen[slot(frame.number)] = frame;
  if (frame.number < course.newest) {
    --course.lost;
    return FrameOrder::kLate;
  }
  course.lost += frame.number - course.newest - 1;
  course.newest = frame.number;
  return FrameOrder::kNext;
}

FrameOrder SequenceTracker::note_far(Run& run, const Seen& frame) {
  const auto is_it = [&](const Seen& other) { return is_repeated(other, frame); };
  if (std::any_of(run.far.begin(), run.far.end(), is_it)) return FrameOrder::kDuplicate;
  const auto beside = std::find_if(run.far.rbegin(), run.far.rend(), [&](const Seen& other) {
    return other.number != frame.number && std::abs(other.number - frame.number) <= kBeside;
  });
  const std::int64_t partner = beside == run.far.rend() ? -1 : beside->number;
  if (run.far.size() == kFar) run.far.pop_front();
  run.far.push_back(frame);
  if (partner >= 0) jump(run, std::min(partner, frame.number), std::max(partner, frame.number));
  return FrameOrder::kNext;
}

/// Two numbers beside each other are believed: those before a jump go on, or others begin.
void SequenceTracker::jump(Run& run, std::int64_t low, std::int64_t high) {
  const auto earlier = std::find_if(run.before.begin(), run.before.end(), [&](const SequenceRange& course) {
    return high > course.newest && has_place(course, low);
  });
  const bool goes_on = earlier != run.before.end();
  if (goes_on) {
    std::swap(run.course, *earlier);
  } else {
    run.before.push_front(run.course);
    if (run.before.size() > kJumps) run.before.pop_back();
    const std::int64_t missing = low - run.course.newest - 1;
    if (low > run.course.newest && missing <= kMaxLost) run.course.lost += missing;
    run.course.first = run.course.newest = low;
    run.course.seen = {};
  }
  // All of them that belong here, in their order, whatever came in between.
  std::sort(run.far.begin(), run.far.end(), [](const Seen& a, const Seen& b) { return a.number < b.number; });
  std::deque<Seen> still_far;
  for (const Seen& frame : run.far) {
    const bool is_low = !goes_on && frame.number == low;
    if (is_low) run.course.seen[slot(low)] = frame;
    if (!is_low && has_place(run.course, frame.number)) {
      place(run.course, frame);
    } else if (!is_low) {
      still_far.push_back(frame);
    }
  }
  run.far = std::move(still_far);
}

bool DuplicateFilter::is_repeated(const FrameId& frame, const std::uint8_t* bytes, std::size_t size,
                                  Clock::time_point arrival) {
  constexpr std::chrono::microseconds kRepeat(kRepeatUs);
  while (!heard_.empty() && (arrival - heard_.front().arrival > kRepeat || heard_.size() >= kHeard)) heard_.pop_front();
  const std::size_t hash = std::hash<std::string_view>()(std::string_view(reinterpret_cast<const char*>(bytes), size));
  const bool found = std::any_of(heard_.begin(), heard_.end(),
                                 [&](const Heard& heard) { return heard.hash == hash && heard.frame == frame; });
  if (!found) heard_.push_back({frame, hash, arrival});
  return found;
}

}  // namespace houghstream
