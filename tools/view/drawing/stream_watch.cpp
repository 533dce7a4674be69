#include "tools/view/drawing/stream_watch.hpp"

#include <utility>

namespace houghstream::view {
namespace {

constexpr std::int64_t kWindowUs = 2'000'000;   // over which rates are counted
constexpr std::int64_t kSilenceUs = 5'000'000;  // five times the interval of status_t, and of teaching_t at its slowest
constexpr std::int64_t kListedUs = 60'000'000;  // after its last status, a process that has ended is listed for so long

}  // namespace

void StreamWatch::note_frame(std::int64_t now_us) {
  const std::lock_guard lock(mutex_);
  arrivals_us_.push_back(now_us);
  while (now_us - arrivals_us_.front() > kWindowUs) arrivals_us_.pop_front();
}

void StreamWatch::note_process(ProcessState process) {
  const std::lock_guard lock(mutex_);
  constexpr std::size_t kProcesses = 64;  // a sender of rubbish may make them up without end
  if (processes_.size() >= kProcesses) {
    for (auto entry = processes_.begin(); entry != processes_.end();)
      entry = process.heard_us - entry->second.heard_us > kSilenceUs ? processes_.erase(entry) : std::next(entry);
  }
  const std::pair<std::string, std::int32_t> key(process.name, process.pid);
  if (processes_.size() >= kProcesses && processes_.count(key) == 0) return;
  processes_[key] = std::move(process);
}

void StreamWatch::note_teaching(Teaching teaching, std::int64_t now_us) {
  const std::lock_guard lock(mutex_);
  teaching_ = std::move(teaching);
  taught_us_ = now_us;
}

void StreamWatch::note_colours(const CameraChroma& colours, std::int64_t now_us) {
  constexpr std::size_t kMaxCameras = 64;  // a sender of rubbish may make them up without end
  const std::lock_guard lock(mutex_);
  if (colours_.size() >= kMaxCameras && colours_.count(colours.frame.channel) == 0) return;
  colours_[colours.frame.channel] = {fit_chroma_map(colours.objects), now_us};
}

void StreamWatch::note_world(const WorldObjects& world, std::int64_t now_us) {
  const std::lock_guard lock(mutex_);
  world_.add(world);
  if (placed_) world_.add(*placed_);
  world_us_ = now_us;
}

void StreamWatch::note_placed(ObjectPlacements placed) {
  const std::lock_guard lock(mutex_);
  placed_ = std::move(placed);
}

std::vector<ProcessState> StreamWatch::listed_processes(std::int64_t now_us) const {
  const auto is_alive = [&](const ProcessState& process) { return now_us - process.heard_us <= kSilenceUs; };
  std::set<std::string> alive;
  for (const auto& [key, process] : processes_) {
    if (is_alive(process)) alive.insert(process.name);
  }
  std::vector<ProcessState> listed;
  for (const auto& [key, process] : processes_) {
    const bool ended = !is_alive(process);
    if (ended && (alive.count(process.name) > 0 || now_us - process.heard_us > kListedUs)) continue;
    listed.push_back(process);
    listed.back().ended = ended;
  }
  return listed;
}

StreamState StreamWatch::state(std::int64_t now_us) {
  const std::lock_guard lock(mutex_);
  while (!arrivals_us_.empty() && now_us - arrivals_us_.front() > kWindowUs) arrivals_us_.pop_front();
  StreamState state;
  if (arrivals_us_.size() > 1 && arrivals_us_.back() > arrivals_us_.front()) {
    state.frames_hz = static_cast<double>(arrivals_us_.size() - 1) * 1e6 /
                      static_cast<double>(arrivals_us_.back() - arrivals_us_.front());
  }
  state.processes = listed_processes(now_us);
  if (now_us - taught_us_ <= kSilenceUs) state.teaching = teaching_;
  for (const auto& [camera, heard] : colours_) {
    if (now_us - heard.second <= kSilenceUs) state.colours.emplace(camera, heard.first);
  }
  if (now_us - world_us_ <= kSilenceUs) state.world = world_;
  return state;
}

void SelectedCamera::note(const std::string& channel) {
  const std::lock_guard lock(mutex_);
  constexpr std::size_t kCameras = 64;
  if (heard_.empty()) shown_ = channel;
  if (heard_.size() < kCameras) heard_.insert(channel);
}

void SelectedCamera::next() {
  const std::lock_guard lock(mutex_);
  if (heard_.empty()) return;
  const auto after = heard_.upper_bound(shown_);
  shown_ = after == heard_.end() ? *heard_.begin() : *after;
}

bool SelectedCamera::is_shown(const std::string& channel) const {
  const std::lock_guard lock(mutex_);
  return heard_.empty() || channel == shown_;
}

std::vector<std::string> SelectedCamera::heard() const {
  const std::lock_guard lock(mutex_);
  return {heard_.begin(), heard_.end()};
}

}  // namespace houghstream::view
