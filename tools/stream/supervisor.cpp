#include "tools/stream/supervisor.hpp"

#include <algorithm>
#include <csignal>
#include <thread>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/printable.hpp"

namespace houghstream::stream {

using std::chrono::milliseconds;

namespace {

// Steps come every 20 ms and less; a longer pause was this process's own.
constexpr milliseconds kMaxStep(500);

double seconds(milliseconds time) {
  return std::chrono::duration<double>(time).count();
}

std::string last_line_of(const ChildProcess& child) {
  return child.last_stderr_line().empty() ? "it has said nothing"
                                          : "its last words: " + printable(child.last_stderr_line());
}

}  // namespace

Supervisor::Supervisor(std::vector<ChildPlan> plans, const SupervisorSettings& settings, Say say)
    : settings_(settings), say_(std::move(say)) {
  for (ChildPlan& plan : plans) {
    members_.emplace_back();
    members_.back().plan = std::move(plan);
  }
  for (Member& member : members_) {
    member.waits = member.plan.is_started_last;
    if (!member.waits) start(member);
  }
}

Supervisor::~Supervisor() {
  stop();
}

void Supervisor::start(Member& member) {
  std::vector<std::string>& command = member.plan.command;
  if (member.restarts > 0) command.erase(std::remove(command.begin(), command.end(), "--replace"), command.end());
  member.child = std::make_unique<ChildProcess>(command, true);
  member.since = Clock::now();
  member.has_heartbeat = false;
  member.silent = Clock::duration(0);
  member.asked_end.reset();
  say_(fmt::format("{} started, process {}", member.plan.name, member.child->pid()));
}

void Supervisor::start_waiting() {
  std::string silent;  // names of the others
  for (const Member& member : members_) {
    if (!member.waits && !member.has_heartbeat) silent += (silent.empty() ? "" : ", ") + member.plan.name;
  }
  if (!silent.empty() && Clock::now() - begun_ < settings_.others_timeout) return;
  for (Member& member : members_) {
    if (!std::exchange(member.waits, false)) continue;
    if (!silent.empty())
      say_(fmt::format("{} starts without waiting any longer for {}: nothing was heard of it for {:.1f} s",
                       member.plan.name, silent, seconds(settings_.others_timeout)));
    start(member);
  }
}

void Supervisor::plan_restart(Member& member, const std::string& words) {
  const bool is_first = Clock::now() - member.since > settings_.backoff_reset;
  member.failures = is_first ? 1 : member.failures + 1;
  require(member.failures < settings_.max_failures, "{} {}, {} times in a row: it is given up; {}", member.plan.name,
          words, member.failures, last_line_of(*member.child));
  member.wait = std::clamp(2 * member.wait, settings_.initial_backoff, settings_.max_backoff);
  if (member.failures == 1) member.wait = milliseconds(0);
  member.since = Clock::now() + member.wait;
  member.child.reset();
  say_(fmt::format("{} {}; starts again {}", member.plan.name, words,
                   member.wait.count() == 0 ? "at once" : fmt::format("in {:.2f} s", seconds(member.wait))));
  restart_if_due(member);
}

void Supervisor::restart_if_due(Member& member) {
  if (Clock::now() < member.since) return;
  ++member.restarts;
  start(member);
}

void Supervisor::check_heartbeat(Member& member, Clock::duration listened) {
  const bool needs_time = member.child->needs_time();
  member.silent = needs_time ? Clock::duration(0) : member.silent + listened;
  const milliseconds limit = member.has_heartbeat ? settings_.heartbeat_timeout : settings_.startup_timeout;
  if (!member.asked_end && member.silent >= limit) {
    say_(fmt::format("{} has said nothing for {:.1f} s: it hangs and is ended", member.plan.name, seconds(limit)));
    member.child->signal(SIGTERM);
    member.asked_end = Clock::now();
  } else if (member.asked_end &&
             Clock::now() - *member.asked_end > (needs_time ? settings_.finishing : settings_.stop_timeout)) {
    member.child->signal(SIGKILL);
  }
}

bool Supervisor::look_after(Member& member, Clock::duration listened) {
  if (member.waits) return true;
  if (!member.child) {
    restart_if_due(member);
    return true;
  }
  if (Clock::now() - member.since > settings_.start_time) member.has_run = true;
  const std::optional<ExitStatus> exit = member.child->poll_exit();
  if (!exit) {
    check_heartbeat(member, listened);
    return true;
  }
  if (member.asked_end) {
    plan_restart(member, "hung and " + exit->words);
    return true;
  }
  if (exit->success && member.plan.ends_stream) {
    say_(fmt::format("{} has ended: the stream ends", member.plan.name));
    source_has_ended_ = member.plan.is_started_last;
    return false;
  }
  // A signal has an external cause; an exit status shows that the process itself cannot continue.
  const bool gave_up = !exit->success && !exit->by_signal;
  require(member.has_run || !gave_up, "{} {} at its start; {}", member.plan.name, exit->words,
          last_line_of(*member.child));
  plan_restart(member, exit->words);
  return true;
}

bool Supervisor::step() {
  const Clock::time_point now = Clock::now();
  const Clock::duration listened = std::min<Clock::duration>(now - last_step_, kMaxStep);
  last_step_ = now;
  start_waiting();
  return std::all_of(members_.begin(), members_.end(), [&](Member& member) { return look_after(member, listened); });
}

bool Supervisor::on_heartbeat(pid_t pid) {
  for (Member& member : members_) {
    if (!member.child || member.child->pid() != pid) continue;
    member.has_run = member.has_heartbeat = true;
    member.silent = Clock::duration(0);
    return true;
  }
  return false;
}

std::vector<pid_t> Supervisor::downstream_pids() const {
  std::vector<pid_t> pids;
  for (const Member& member : members_) {
    if (source_has_ended_ && member.child && !member.plan.is_started_last) pids.push_back(member.child->pid());
  }
  return pids;
}

void Supervisor::pause_watchdog() {
  last_step_ = Clock::now();
}

std::string Supervisor::names_of_writing() {
  std::string names;
  for (Member& member : members_) {
    const bool is_writing = member.child && !member.child->poll_exit() && member.child->needs_time();
    if (is_writing) names += (names.empty() ? "" : ", ") + member.plan.name;
  }
  return names;
}

std::vector<std::string> Supervisor::stop() {
  for (const Member& member : members_) {
    if (member.child) member.child->signal(SIGINT);
  }
  const Clock::time_point begun = Clock::now();
  const auto is_awaited = [&](Member& member) {
    if (!member.child || member.child->poll_exit()) return false;
    const bool needs_time = member.child->needs_time();
    return Clock::now() - begun < (needs_time ? settings_.finishing : settings_.stop_timeout);
  };
  bool has_said = false;
  while (std::any_of(members_.begin(), members_.end(), is_awaited)) {
    if (Clock::now() - begun > settings_.stop_timeout && !std::exchange(has_said, true))
      say_(fmt::format("waiting for the end of a file that is being written: {}", names_of_writing()));
    std::this_thread::sleep_for(milliseconds(10));
  }
  std::vector<std::string> killed;
  for (Member& member : members_) {
    if (member.child && !member.child->poll_exit()) killed.push_back(member.plan.name);
    member.child.reset();
  }
  return killed;
}

std::vector<Supervisor::State> Supervisor::states() const {
  std::vector<State> states;
  for (const Member& member : members_) {
    states.push_back({member.plan.name, member.child ? member.child->pid() : 0, member.restarts, member.waits});
  }
  return states;
}

}  // namespace houghstream::stream
