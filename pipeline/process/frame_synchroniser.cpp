#include "pipeline/process/frame_synchroniser.hpp"

#include <algorithm>
#include <utility>

#include "pipeline/base/checks.hpp"

namespace houghstream {

void FrameSynchroniser::add_frame(const FrameId& id, SharedBytes bytes) {
  bool is_awaited = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Camera& camera = find_or_add_camera(id.channel);
    detectors_.note_frame(id);
    ByteBudget::Reservation reservation = frame_bytes_.reserve(bytes->size());
    ++camera.frame_count;
    camera.frames.push_back({{id, std::move(bytes)}, ++frame_count_, std::move(reservation)});
    if (camera.frames.size() > kCachedFrames) camera.frames.pop_front();
    limit_frame_bytes();
    camera.has_unmatched_frame = newest_first_ && offers_unmatched_frames_;
    drop_unmatchable(camera);
    is_awaited = camera.has_unmatched_frame || !camera.pending.empty();
  }
  if (is_awaited) changed_.notify_one();
}

void FrameSynchroniser::add_result(const FrameId& id, std::vector<std::uint8_t> bytes) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Camera& camera = find_or_add_camera(id.channel);
    detectors_.note_result(id);
    PendingResult pending;
    pending.id = id;
    pending.reservation = pending_bytes_.reserve(bytes.size());
    pending.bytes = std::move(bytes);
    pending.arrival = std::chrono::steady_clock::now();
    pending.number = ++result_count_;
    pending.frames_before = camera.frame_count;
    camera.pending.push_back(std::move(pending));
    drop_unmatchable(camera);
    limit_pending_bytes();
  }
  changed_.notify_one();
}

FrameSynchroniser::Camera& FrameSynchroniser::find_or_add_camera(const std::string& channel) {
  require(cameras_.size() < kCameras || cameras_.count(channel) > 0,
          "a camera more than the {} that are listened to; expected a pattern that fewer channels match", kCameras);
  return cameras_[channel];
}

// Requires that there are frames.
FrameSynchroniser::Camera& FrameSynchroniser::largest_camera() {
  Camera* selected = nullptr;
  for (auto& [channel, camera] : cameras_) {
    if (camera.frames.empty()) continue;
    const bool has_more = selected == nullptr || camera.frames.size() > selected->frames.size();
    const bool is_older = selected != nullptr && camera.frames.size() == selected->frames.size() &&
                          camera.frames.front().number < selected->frames.front().number;
    if (has_more || is_older) selected = &camera;
  }
  return *selected;
}

void FrameSynchroniser::limit_frame_bytes() {
  while (frame_bytes_.total() > kCachedBytes) {
    Camera& camera = largest_camera();
    if (camera.frames.front().number == frame_count_) return;  // the last one that has come is the only one left
    camera.frames.pop_front();
    if (camera.frames.empty()) camera.has_unmatched_frame = false;
  }
}

void FrameSynchroniser::limit_pending_bytes() {
  while (pending_bytes_.total() > kMaxPendingBytes) {
    const auto largest = std::max_element(cameras_.begin(), cameras_.end(), [](const auto& a, const auto& b) {
      return a.second.pending.size() < b.second.pending.size();
    });
    drop_first(largest->second);
  }
}

std::optional<SynchronisedMessages> FrameSynchroniser::pop(std::chrono::milliseconds timeout) {
  constexpr std::chrono::milliseconds kMaxRecheckInterval(
      3);  // maximum delay until a changed answer of the gate is noticed
  std::unique_lock<std::mutex> lock(mutex_);
  const bool none_is_deferred = deferred_.empty();
  std::optional<SynchronisedMessages> pair;
  changed_.wait_for(lock, none_is_deferred ? timeout : std::min(timeout, kMaxRecheckInterval), [&] {
    pair = next_pair();
    return pair || has_any_unmatched_frame() || none_is_deferred != deferred_.empty();
  });
  return pair;
}

std::optional<SynchronisedMessages> FrameSynchroniser::next_pair() {
  for (auto it = deferred_.begin(); it != deferred_.end();) {
    const FrameGate::Answer answer = decide_by_gate(it->pair.id, it->since_us);
    if (answer == FrameGate::Answer::kWait) {
      ++it;
      continue;
    }
    SynchronisedMessages pair = std::move(it->pair);
    it = deferred_.erase(it);
    if (answer == FrameGate::Answer::kAccept) return pair;
  }
  while (Camera* camera = next_camera()) {
    SynchronisedMessages pair = pop_pair(*camera);
    const std::int64_t now_us = gate_.now_us ? gate_.now_us() : 0;
    const FrameGate::Answer answer = decide_by_gate(pair.id, now_us);
    if (answer == FrameGate::Answer::kAccept) return pair;
    if (answer == FrameGate::Answer::kWait) defer(std::move(pair), now_us);
  }
  return std::nullopt;
}

FrameGate::Answer FrameSynchroniser::decide_by_gate(const FrameId& id, std::int64_t since_us) {
  if (!gate_.decide) return FrameGate::Answer::kAccept;
  const FrameGate::Decision decision = gate_.decide(id, static_cast<double>(gate_.now_us() - since_us) * 1e-6);
  if (decision.answer == FrameGate::Answer::kRefuse) dropped_.refused.push_back({id, decision.reason});
  return decision.answer;
}

// Deferred pairs are limited, since each holds its frame, and detections of one frame may be sent without end.
void FrameSynchroniser::defer(SynchronisedMessages pair, std::int64_t since_us) {
  ByteBudget::Reservation reservation = deferred_bytes_.reserve(pair.frame->size());
  deferred_.push_back({std::move(pair), since_us, std::move(reservation)});
  while (deferred_.size() > 1 && (deferred_.size() > kMaxDeferred || deferred_bytes_.total() > kMaxDeferredBytes)) {
    dropped_.refused.push_back({deferred_.front().pair.id, "too many wait for " + gate_.awaited});
    deferred_.pop_front();
  }
}

void FrameSynchroniser::recheck_gate() {
  // The lock ensures that a thread in pop() has either asked the gate already or is waiting.
  { const std::lock_guard<std::mutex> lock(mutex_); }
  changed_.notify_one();
}

std::optional<StoredFrame> FrameSynchroniser::pop_unmatched_frame() {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto& [channel, camera] : cameras_) {
    if (std::exchange(camera.has_unmatched_frame, false)) return camera.frames.back().frame;
  }
  return std::nullopt;
}

FrameSynchroniser::Dropped FrameSynchroniser::pop_dropped() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(dropped_, {});
}

void FrameSynchroniser::flush() {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto& [channel, camera] : cameras_) {
    while (!camera.pending.empty()) drop_first(camera);
  }
  for (const DeferredPair& pending : deferred_) dropped_.refused.push_back({pending.pair.id, "the stream has ended"});
  deferred_.clear();
}

void FrameSynchroniser::drop_first(Camera& camera) {
  const FrameId& id = camera.pending.front().id;
  if (camera.find_frame(id) == nullptr) {
    dropped_.without_frame.push_back(id);
  } else {
    ++dropped_.skipped;
  }
  camera.pending.pop_front();
}

const FrameSynchroniser::CachedFrame* FrameSynchroniser::Camera::find_frame(const FrameId& id) const {
  const auto found =
      std::find_if(frames.rbegin(), frames.rend(), [&](const CachedFrame& entry) { return entry.frame.id == id; });
  return found == frames.rend() ? nullptr : &*found;
}

std::optional<std::size_t> FrameSynchroniser::Camera::first_matched() const {
  const auto found = std::find_if(pending.begin(), pending.end(),
                                  [&](const PendingResult& result) { return find_frame(result.id) != nullptr; });
  if (found == pending.end()) return std::nullopt;
  return static_cast<std::size_t>(found - pending.begin());
}

// Returns the camera whose pair comes next: the one served longest ago, or, in a log, the one whose detections arrived
// first.
FrameSynchroniser::Camera* FrameSynchroniser::next_camera() {
  Camera* next = nullptr;
  std::int64_t next_order = 0;
  for (auto& [channel, camera] : cameras_) {
    if (newest_first_) drop_stale(channel, camera);
    const std::optional<std::size_t> first = camera.first_matched();
    if (!first) continue;
    const std::int64_t order = newest_first_ ? camera.last_served : camera.pending[*first].number;
    if (next != nullptr && order >= next_order) continue;
    next = &camera;
    next_order = order;
  }
  return next;
}

// The newest complete result, whose frame is there, of each detector of the camera stays; results before these are
// dropped, since results do not name their detector.
void FrameSynchroniser::drop_stale(const std::string& channel, Camera& camera) {
  int missing = detectors_.estimate(channel);
  auto oldest = camera.pending.end();
  while (missing > 0 && oldest != camera.pending.begin()) {
    --oldest;
    if (camera.find_frame(oldest->id) != nullptr) --missing;
  }
  if (missing > 0) return;
  dropped_.skipped += oldest - camera.pending.begin();
  camera.pending.erase(camera.pending.begin(), oldest);
}

void FrameSynchroniser::drop_unmatchable(Camera& camera) {
  // The second condition bounds memory where detections come and frames do not.
  while (!camera.pending.empty() && camera.find_frame(camera.pending.front().id) == nullptr &&
         (camera.frame_count - camera.pending.front().frames_before > kMaxLagFrames ||
          camera.pending.size() > kCachedFrames)) {
    drop_first(camera);
  }
  while (camera.pending.size() > kMaxPending) drop_first(camera);
}

SynchronisedMessages FrameSynchroniser::pop_pair(Camera& camera) {
  const auto selected = camera.pending.begin() + static_cast<std::ptrdiff_t>(*camera.first_matched());
  if (selected->id == camera.frames.back().frame.id) camera.has_unmatched_frame = false;
  const CachedFrame& entry = *camera.find_frame(selected->id);
  SynchronisedMessages pair;
  pair.id = selected->id;
  pair.frame = entry.frame.bytes;
  pair.arrival_number = entry.number;
  pair.result = std::move(selected->bytes);
  pair.arrival = selected->arrival;
  camera.last_served = ++serve_count_;
  camera.pending.erase(selected);
  return pair;
}

bool FrameSynchroniser::has_any_unmatched_frame() const {
  return std::any_of(cameras_.begin(), cameras_.end(),
                     [](const auto& entry) { return entry.second.has_unmatched_frame; });
}

}  // namespace houghstream
