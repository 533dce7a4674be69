#include "pipeline/bus/sequence_count.hpp"

#include <algorithm>
#include <functional>
#include <string_view>

namespace houghstream {
namespace {

constexpr std::int64_t kBelieved = 300;        // frames that a single number may tell to be lost: ten seconds
constexpr std::int64_t kMostLost = 100'000;    // and two that follow one another: an hour
constexpr std::int64_t kRepeatUs = 1'000'000;  // a duplicate comes within this time
constexpr std::size_t kRuns = 4;               // senders on one channel whose numbers are kept apart
constexpr std::int64_t kFew = 8;               // frames behind a jump that may be of who forged it
constexpr std::size_t kHeard = 256;

std::size_t slot_of(std::int64_t number, std::size_t window) {
  return static_cast<std::size_t>(number) % window;
}

}  // namespace

FrameOrder SequenceCount::note(const FrameNumber& frame, std::int64_t now_us) {
  if (!frame.sequence || *frame.sequence < 0) return FrameOrder::kNext;
  has_number_ = true;
  bool is_new = false;
  Run& run = run_of(frame, *frame.sequence, is_new);
  if (is_new) {
    mark(run, *frame.sequence, frame.utime, now_us);
    return FrameOrder::kNext;
  }
  return note_in(run, frame, *frame.sequence, now_us);
}

std::optional<std::int64_t> SequenceCount::lost() const {
  return has_number_ ? std::optional<std::int64_t>(lost_) : std::nullopt;
}

SequenceCount::Run& SequenceCount::run_of(const FrameNumber& frame, std::int64_t number, bool& is_new) {
  const auto known = std::find_if(runs_.begin(), runs_.end(), [&](const Run& run) { return run.id == frame.run; });
  is_new = known == runs_.end();
  if (!is_new) {
    runs_.splice(runs_.begin(), runs_, known);
  } else {
    runs_.emplace_front();
    runs_.front().id = frame.run;
    runs_.front().first = runs_.front().newest = number;
    if (runs_.size() > kRuns) runs_.pop_back();
  }
  return runs_.front();
}

void SequenceCount::mark(Run& run, std::int64_t number, std::int64_t utime, std::int64_t now_us) {
  run.seen[slot_of(number, run.seen.size())] = {number, utime, now_us};
}

FrameOrder SequenceCount::note_in(Run& run, const FrameNumber& frame, std::int64_t number, std::int64_t now_us) {
  const bool is_next = number > run.newest && number - run.newest <= kBelieved;
  const bool is_near = number <= run.newest && run.newest - number < kWindow;
  if (!is_next && !is_near) return note_far(run, frame, number, now_us);
  const Seen& seen = run.seen[slot_of(number, run.seen.size())];
  if (is_near && seen.number == number) {
    const bool is_same = seen.utime == frame.utime && now_us - seen.arrival_us <= kRepeatUs;
    return is_same ? FrameOrder::kDuplicate : note_far(run, frame, number, now_us);
  }
  if (is_near && number < run.first) return note_far(run, frame, number, now_us);
  run.candidate.reset();
  mark(run, number, frame.utime, now_us);
  if (is_near) {
    --lost_;
    if (number > run.jump_from && run.jump_lost > 0) --run.jump_lost;
    return FrameOrder::kLate;
  }
  const std::int64_t missing = number - run.newest - 1;
  lost_ += missing;
  if (missing > 0) {
    const bool goes_on = run.jump_lost > 0 && run.newest - run.jump_from < kWindow;
    if (!goes_on) run.jump_from = run.newest;
    run.jump_lost = missing + (goes_on ? run.jump_lost : 0);
  }
  run.newest = number;
  return FrameOrder::kNext;
}

FrameOrder SequenceCount::note_far(Run& run, const FrameNumber& frame, std::int64_t number, std::int64_t now_us) {
  const std::int64_t before = run.candidate ? *run.candidate->sequence : number;
  if (run.candidate && number == before && run.candidate->utime == frame.utime &&
      now_us - run.candidate_us <= kRepeatUs)
    return FrameOrder::kDuplicate;
  const bool follows = number > before && number - before < kWindow;
  if (!follows) {
    run.candidate = frame;
    run.candidate_us = now_us;
    return FrameOrder::kNext;
  }
  const bool has_just_jumped = run.jump_lost > 0 && run.newest - run.jump_from - run.jump_lost < kFew;
  if (has_just_jumped && before > run.jump_from && before - run.jump_from < kWindow) {
    lost_ += before - run.jump_from - 1 - run.jump_lost;
  } else if (before > run.newest && before - run.newest <= kMostLost) {
    lost_ += before - run.newest - 1;
  }
  run.jump_lost = 0;
  lost_ += number - before - 1;
  run.seen = {};
  mark(run, before, run.candidate->utime, run.candidate_us);
  mark(run, number, frame.utime, now_us);
  run.first = before;
  run.newest = number;
  run.candidate.reset();
  return FrameOrder::kNext;
}

bool RepeatedMessages::is_repeated(const FrameId& frame, const std::uint8_t* bytes, std::size_t size,
                                   std::int64_t now_us) {
  while (!heard_.empty() && (now_us - heard_.front().arrival_us > kRepeatUs || heard_.size() >= kHeard))
    heard_.pop_front();
  const std::size_t hash = std::hash<std::string_view>()(std::string_view(reinterpret_cast<const char*>(bytes), size));
  const bool found = std::any_of(heard_.begin(), heard_.end(),
                                 [&](const Heard& heard) { return heard.hash == hash && heard.frame == frame; });
  if (!found) heard_.push_back({frame, hash, now_us});
  return found;
}

}  // namespace houghstream
