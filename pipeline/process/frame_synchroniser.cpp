#include "pipeline/process/frame_synchroniser.hpp"

#include <algorithm>
#include <utility>

#include "pipeline/base/checks.hpp"

namespace houghstream {

void FrameSynchroniser::add_frame(const FrameId& id, SharedBytes bytes) {
  bool is_awaited = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Camera& camera = camera_of(id.channel);
    detectors_.note_frame(id);
    ByteBudget::Reservation reservation = frame_bytes_.reserve(bytes->size());
    ++camera.frames_seen;
    camera.frames.push_back({{id, std::move(bytes)}, ++frames_, std::move(reservation)});
    if (camera.frames.size() > kHistory) camera.frames.pop_front();
    limit_frame_bytes();
    camera.fresh = newest_first_ && ahead_;
    drop_unmatchable(camera);
    is_awaited = camera.fresh || !camera.waiting.empty();
  }
  if (is_awaited) changed_.notify_one();
}

void FrameSynchroniser::add_result(const FrameId& id, std::vector<std::uint8_t> bytes) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Camera& camera = camera_of(id.channel);
    detectors_.note_result(id);
    Waiting waiting;
    waiting.id = id;
    waiting.reservation = waiting_bytes_.reserve(bytes.size());
    waiting.bytes = std::move(bytes);
    waiting.arrival = std::chrono::steady_clock::now();
    waiting.number = ++arrivals_;
    waiting.frames_before = camera.frames_seen;
    camera.waiting.push_back(std::move(waiting));
    drop_unmatchable(camera);
    limit_waiting_bytes();
  }
  changed_.notify_one();
}

FrameSynchroniser::Camera& FrameSynchroniser::camera_of(const std::string& channel) {
  require(cameras_.size() < kCameras || cameras_.count(channel) > 0,
          "a camera more than the {} that are listened to; expected a pattern that fewer channels match", kCameras);
  return cameras_[channel];
}

// There are frames.
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
  while (frame_bytes_.total() > kHistoryBytes) {
    Camera& camera = largest_camera();
    if (camera.frames.front().number == frames_) return;  // the last one that has come is the only one left
    camera.frames.pop_front();
    if (camera.frames.empty()) camera.fresh = false;
  }
}

void FrameSynchroniser::limit_waiting_bytes() {
  while (waiting_bytes_.total() > kAllWaitingBytes) {
    const auto maximum = std::max_element(cameras_.begin(), cameras_.end(), [](const auto& a, const auto& b) {
      return a.second.waiting.size() < b.second.waiting.size();
    });
    drop_first(maximum->second);
  }
}

std::optional<SynchronisedMessages> FrameSynchroniser::pop(std::chrono::milliseconds timeout) {
  constexpr std::chrono::milliseconds kRecheck(3);  // maximum delay until a changed answer of the gate is noticed
  std::unique_lock<std::mutex> lock(mutex_);
  const bool none_waits = held_back_.empty();
  std::optional<SynchronisedMessages> pair;
  changed_.wait_for(lock, none_waits ? timeout : std::min(timeout, kRecheck), [&] {
    pair = next_pair();
    return pair || any_fresh() || none_waits != held_back_.empty();
  });
  return pair;
}

std::optional<SynchronisedMessages> FrameSynchroniser::next_pair() {
  for (auto it = held_back_.begin(); it != held_back_.end();) {
    const FrameGate::Answer answer = decide_by_gate(it->pair.id, it->since_us);
    if (answer == FrameGate::Answer::kWait) {
      ++it;
      continue;
    }
    SynchronisedMessages pair = std::move(it->pair);
    it = held_back_.erase(it);
    if (answer == FrameGate::Answer::kGo) return pair;
  }
  while (Camera* camera = next_camera()) {
    SynchronisedMessages pair = pop_pair(*camera);
    const std::int64_t now_us = gate_.now_us ? gate_.now_us() : 0;
    const FrameGate::Answer answer = decide_by_gate(pair.id, now_us);
    if (answer == FrameGate::Answer::kGo) return pair;
    if (answer == FrameGate::Answer::kWait) hold_back(std::move(pair), now_us);
  }
  return std::nullopt;
}

FrameGate::Answer FrameSynchroniser::decide_by_gate(const FrameId& id, std::int64_t since_us) {
  if (!gate_.decide) return FrameGate::Answer::kGo;
  const FrameGate::Decision decision = gate_.decide(id, static_cast<double>(gate_.now_us() - since_us) * 1e-6);
  if (decision.answer == FrameGate::Answer::kRefuse) dropped_.refused.push_back({id, decision.reason});
  return decision.answer;
}

// A frame goes with each pair, and detections of one frame may be sent without end.
void FrameSynchroniser::hold_back(SynchronisedMessages pair, std::int64_t since_us) {
  ByteBudget::Reservation reservation = held_back_bytes_.reserve(pair.frame->size());
  held_back_.push_back({std::move(pair), since_us, std::move(reservation)});
  while (held_back_.size() > 1 && (held_back_.size() > kHeldBack || held_back_bytes_.total() > kHeldBackBytes)) {
    dropped_.refused.push_back({held_back_.front().pair.id, "too many wait for " + gate_.awaited});
    held_back_.pop_front();
  }
}

void FrameSynchroniser::recheck_gate() {
  { const std::lock_guard<std::mutex> lock(mutex_); }  // a thread in pop() has asked before this, or waits
  changed_.notify_one();
}

std::optional<ArrivedFrame> FrameSynchroniser::pop_unmatched_frame() {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto& [channel, camera] : cameras_) {
    if (std::exchange(camera.fresh, false)) return camera.frames.back().frame;
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
    while (!camera.waiting.empty()) drop_first(camera);
  }
  for (const HeldBack& waiting : held_back_) dropped_.refused.push_back({waiting.pair.id, "the stream has ended"});
  held_back_.clear();
}

void FrameSynchroniser::drop_first(Camera& camera) {
  const FrameId& id = camera.waiting.front().id;
  if (camera.find_frame(id) == nullptr) {
    dropped_.without_frame.push_back(id);
  } else {
    ++dropped_.skipped;
  }
  camera.waiting.pop_front();
}

const FrameSynchroniser::Kept* FrameSynchroniser::Camera::find_frame(const FrameId& id) const {
  const auto found =
      std::find_if(frames.rbegin(), frames.rend(), [&](const Kept& kept) { return kept.frame.id == id; });
  return found == frames.rend() ? nullptr : &*found;
}

std::optional<std::size_t> FrameSynchroniser::Camera::first_complete() const {
  const auto found =
      std::find_if(waiting.begin(), waiting.end(), [&](const Waiting& w) { return find_frame(w.id) != nullptr; });
  if (found == waiting.end()) return std::nullopt;
  return static_cast<std::size_t>(found - waiting.begin());
}

// The camera with a pair that has its turn: the one served longest ago, or, in a log, the one whose detections came
// first.
FrameSynchroniser::Camera* FrameSynchroniser::next_camera() {
  Camera* next = nullptr;
  std::int64_t next_rank = 0;
  for (auto& [channel, camera] : cameras_) {
    if (newest_first_) drop_stale(channel, camera);
    const std::optional<std::size_t> first = camera.first_complete();
    if (!first) continue;
    const std::int64_t rank = newest_first_ ? camera.turn : camera.waiting[*first].number;
    if (next != nullptr && rank >= next_rank) continue;
    next = &camera;
    next_rank = rank;
  }
  return next;
}

// The newest complete result of each detector of the camera stays; results before these are dropped, since results do
// not name their detector.
void FrameSynchroniser::drop_stale(const std::string& channel, Camera& camera) {
  int left = detectors_.of(channel);
  auto oldest = camera.waiting.end();
  while (left > 0 && oldest != camera.waiting.begin()) {
    --oldest;
    if (camera.find_frame(oldest->id) != nullptr) --left;
  }
  if (left > 0) return;
  dropped_.skipped += oldest - camera.waiting.begin();
  camera.waiting.erase(camera.waiting.begin(), oldest);
}

void FrameSynchroniser::drop_unmatchable(Camera& camera) {
  // The second condition bounds memory where detections come and frames do not.
  while (
      !camera.waiting.empty() && camera.find_frame(camera.waiting.front().id) == nullptr &&
      (camera.frames_seen - camera.waiting.front().frames_before > kMaxLagFrames || camera.waiting.size() > kHistory)) {
    drop_first(camera);
  }
  while (camera.waiting.size() > kWaiting) drop_first(camera);
}

SynchronisedMessages FrameSynchroniser::pop_pair(Camera& camera) {
  const auto selected = camera.waiting.begin() + static_cast<std::ptrdiff_t>(*camera.first_complete());
  if (selected->id == camera.frames.back().frame.id) camera.fresh = false;
  const Kept& kept = *camera.find_frame(selected->id);
  SynchronisedMessages pair;
  pair.id = selected->id;
  pair.frame = kept.frame.bytes;
  pair.frame_number = kept.number;
  pair.result = std::move(selected->bytes);
  pair.arrival = selected->arrival;
  camera.turn = ++turns_;
  camera.waiting.erase(selected);
  return pair;
}

bool FrameSynchroniser::any_fresh() const {
  return std::any_of(cameras_.begin(), cameras_.end(), [](const auto& entry) { return entry.second.fresh; });
}

}  // namespace houghstream
