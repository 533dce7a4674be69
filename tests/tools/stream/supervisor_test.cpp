#include "tools/stream/supervisor.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <thread>

#include "pipeline/base/checks.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream::stream {
namespace {

using std::chrono::milliseconds;

ChildPlan shell(const std::string& name, const std::string& script, bool ends_stream = false) {
  return {name, {"/bin/sh", "-c", script}, ends_stream};
}

SupervisorSettings quick() {
  SupervisorSettings settings;
  settings.initial_backoff = milliseconds(20);
  settings.max_backoff = milliseconds(80);
  settings.start_time = milliseconds(100);
  return settings;
}

bool is_running(pid_t pid) {
  return kill(pid, 0) == 0;
}

/// Steps the supervisor until `done`, for ten seconds at most.
template <typename Done>
bool step_until(Supervisor& supervisor, const Done& done) {
  for (int i = 0; i < 1000 && !done(); ++i) {
    if (!supervisor.step()) return done();
    std::this_thread::sleep_for(milliseconds(10));
  }
  return done();
}

void be_silent(const std::string& /*words*/) {}

TEST(Supervisor, StartsAgainWhatIsKilled) {
  std::vector<std::string> lines;
  Supervisor supervisor({shell("a", "exec sleep 100"), shell("b", "exec sleep 100")}, quick(),
                        [&](const std::string& words) { lines.push_back(words); });
  const pid_t first = supervisor.states()[0].pid;
  const pid_t other = supervisor.states()[1].pid;
  kill(first, SIGKILL);
  ASSERT_TRUE(step_until(supervisor, [&] { return supervisor.states()[0].restarts == 1; }));
  EXPECT_NE(supervisor.states()[0].pid, first);
  EXPECT_EQ(supervisor.states()[1].pid, other);
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[2], "a was killed by signal 9 (Killed); starts again at once");
}

TEST(Supervisor, StopLeavesNoProcess) {
  Supervisor supervisor({shell("a", "exec sleep 100"), shell("parent", "sleep 100 & wait")}, quick(), be_silent);
  std::vector<pid_t> pids;
  for (const auto& state : supervisor.states()) pids.push_back(state.pid);
  std::this_thread::sleep_for(milliseconds(100));
  EXPECT_TRUE(supervisor.stop().empty());
  for (const pid_t pid : pids) {
    EXPECT_FALSE(is_running(pid));
    for (int i = 0; i < 500 && is_running(-pid); ++i) std::this_thread::sleep_for(milliseconds(10));
    EXPECT_FALSE(is_running(-pid)) << "nor anything that it has started";
  }
}

TEST(Supervisor, WhoDoesNotEndIsKilled) {
  const auto folder = fresh_folder("supervisor_deaf");
  SupervisorSettings settings = quick();
  settings.stop_timeout = milliseconds(200);
  Supervisor supervisor(
      {shell("deaf", "trap '' INT TERM; touch " + (folder / "ready").string() + "; while true; do sleep 0.1; done")},
      settings, be_silent);
  step_until(supervisor, [&] { return std::filesystem::exists(folder / "ready"); });
  const pid_t pid = supervisor.states()[0].pid;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(supervisor.stop(), std::vector<std::string>{"deaf"});
  EXPECT_FALSE(is_running(pid));
  EXPECT_GE(std::chrono::steady_clock::now() - start, settings.stop_timeout);
}

/// Returns a process that needs a second to end once it is asked to, and has said before, or not, that it needs more
/// time, with the words of sd_notify(3).
ChildPlan slow_to_end(const std::filesystem::path& folder, bool says_so) {
  const std::string notice =
      says_so ? "python3 -c 'import os, socket; socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM).sendto("
                "b\"EXTEND_TIMEOUT_USEC=60000000\", \"\\0\" + os.environ[\"NOTIFY_SOCKET\"][1:])'; "
              : "";
  const std::string asked = (folder / "asked").string();
  return shell("slow", notice + "trap 'touch " + asked + "' INT; touch " + (folder / "ready").string() +
                           "; while [ ! -e " + asked + " ]; do sleep 0.02; done; sleep 1; touch " +
                           (folder / "whole").string());
}

/// Waits without looking after the processes, for as long as a busy machine may need.
bool await_file(const std::filesystem::path& file) {
  for (int i = 0; i < 6000 && !std::filesystem::exists(file); ++i) std::this_thread::sleep_for(milliseconds(10));
  return std::filesystem::exists(file);
}

TEST(Supervisor, WhoSaysThatItIsStillWritingIsWaitedFor) {
  for (const bool says_so : {true, false}) {
    const auto folder = fresh_folder("supervisor_slow");
    SupervisorSettings settings = quick();
    settings.stop_timeout = milliseconds(100);
    std::vector<std::string> lines;
    Supervisor supervisor({slow_to_end(folder, says_so)}, settings,
                          [&](const std::string& words) { lines.push_back(words); });
    ASSERT_TRUE(await_file(folder / "ready"));
    const std::vector<std::string> killed = supervisor.stop();
    EXPECT_EQ(killed.empty(), says_so);
    EXPECT_EQ(std::filesystem::exists(folder / "whole"), says_so);
    const std::string last = lines.back();
    EXPECT_EQ(last == "waiting for the end of a file that is being written: slow", says_so) << last;
  }
}

TEST(Supervisor, WhoSaysSoForEverIsKilledAllTheSame) {
  const auto folder = fresh_folder("supervisor_for_ever");
  SupervisorSettings settings = quick();
  settings.stop_timeout = milliseconds(100);
  settings.finishing = milliseconds(300);
  Supervisor supervisor({slow_to_end(folder, true)}, settings, be_silent);
  ASSERT_TRUE(await_file(folder / "ready"));
  EXPECT_EQ(supervisor.stop(), std::vector<std::string>{"slow"});
  EXPECT_FALSE(std::filesystem::exists(folder / "whole"));
}

TEST(Supervisor, ARestartReplacesNoFile) {
  const auto folder = fresh_folder("supervisor_replace");
  const std::filesystem::path file = folder / "words";
  Supervisor supervisor(
      {{"a", {"/bin/sh", "-c", "echo \"$@\" >>" + file.string() + "; sleep 0.2; exit 3", "a", "--replace", "x"}}},
      quick(), be_silent);
  ASSERT_TRUE(step_until(supervisor, [&] { return supervisor.states()[0].restarts == 2; }));
  EXPECT_EQ(read_text(file).substr(0, 14), "--replace x\nx\n");
}

TEST(Supervisor, WhoHangsIsKilledAndStartedAgain) {
  SupervisorSettings settings = quick();
  settings.heartbeat_timeout = milliseconds(300);
  settings.stop_timeout = milliseconds(100);
  std::vector<std::string> lines;
  Supervisor supervisor({shell("a", "exec sleep 100"), shell("b", "exec sleep 100")}, settings,
                        [&](const std::string& words) { lines.push_back(words); });
  const pid_t hung = supervisor.states()[0].pid;
  const pid_t other = supervisor.states()[1].pid;
  supervisor.on_heartbeat(hung);
  kill(hung, SIGSTOP);
  ASSERT_TRUE(step_until(supervisor, [&] {
    supervisor.on_heartbeat(other);
    return supervisor.states()[0].restarts == 1;
  }));
  EXPECT_NE(supervisor.states()[0].pid, hung);
  EXPECT_EQ(supervisor.states()[1].pid, other) << "it has spoken all the time";
  EXPECT_FALSE(is_running(hung));
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_EQ(lines[2], "a has said nothing for 0.3 s: it hangs and is ended");
  EXPECT_EQ(lines[3], "a hung and was killed by signal 9 (Killed); starts again at once");
}

TEST(Supervisor, WhoNeverSpeaksIsGivenLonger) {
  SupervisorSettings settings = quick();
  settings.heartbeat_timeout = milliseconds(50);
  settings.startup_timeout = milliseconds(600);
  // It ends with status 0 when it is asked to, as a window does: that is not the stream's end.
  Supervisor supervisor({shell("mute", "trap 'exit 0' TERM; while true; do sleep 0.02; done", true)}, settings,
                        be_silent);
  const auto start = std::chrono::steady_clock::now();
  ASSERT_TRUE(step_until(supervisor, [&] { return supervisor.states()[0].restarts == 1; }));
  EXPECT_GE(std::chrono::steady_clock::now() - start, settings.startup_timeout);
}

TEST(Supervisor, SilenceWhileNobodyListenedDoesNotCount) {
  SupervisorSettings settings = quick();
  settings.heartbeat_timeout = milliseconds(900);
  std::vector<std::string> lines;
  Supervisor supervisor({shell("a", "exec sleep 100")}, settings,
                        [&](const std::string& words) { lines.push_back(words); });
  supervisor.on_heartbeat(supervisor.states()[0].pid);
  std::this_thread::sleep_for(milliseconds(1200));  // as with Ctrl-Z
  supervisor.step();
  EXPECT_EQ(lines.size(), 1U) << lines.back();
}

TEST(Supervisor, SilenceOfABusThatIsGoneDoesNotCount) {
  SupervisorSettings settings = quick();
  settings.heartbeat_timeout = milliseconds(100);
  std::vector<std::string> lines;
  Supervisor supervisor({shell("a", "exec sleep 100")}, settings,
                        [&](const std::string& words) { lines.push_back(words); });
  supervisor.on_heartbeat(supervisor.states()[0].pid);
  for (int i = 0; i < 10; ++i) {
    std::this_thread::sleep_for(milliseconds(30));
    supervisor.pause_watchdog();
    supervisor.step();
  }
  EXPECT_EQ(lines.size(), 1U) << lines.back();
}

TEST(Supervisor, WhoFailsAtItsStartIsNotTriedAgain) {
  Supervisor supervisor({shell("wrong", "exit 3")}, quick(), be_silent);
  expect_says(error_of([&] { step_until(supervisor, [] { return false; }); }),
              {"wrong ended with status 3 at its start"});
}

TEST(Supervisor, WhoHasRunIsTriedAgainEverMoreSlowly) {
  std::vector<std::string> lines;
  Supervisor supervisor({shell("a", "sleep 0.2; exit 3")}, quick(),
                        [&](const std::string& words) { lines.push_back(words); });
  ASSERT_TRUE(step_until(supervisor, [&] { return supervisor.states()[0].restarts == 4; }));
  std::vector<std::string> waits;
  for (const std::string& line : lines) {
    const std::string again = "starts again ";
    const std::size_t at = line.find(again);
    if (at != std::string::npos) waits.push_back(line.substr(at + again.size()));
  }
  EXPECT_EQ(waits, (std::vector<std::string>{"at once", "in 0.02 s", "in 0.04 s", "in 0.08 s"}));
}

TEST(Supervisor, WhoIsKnownToRunNeedNotWait) {
  SupervisorSettings settings = quick();
  settings.start_time = milliseconds(100'000);
  Supervisor supervisor({shell("a", "sleep 0.2; exit 3")}, settings, be_silent);
  supervisor.on_heartbeat(supervisor.states()[0].pid);
  EXPECT_TRUE(step_until(supervisor, [&] { return supervisor.states()[0].restarts == 1; }));
}

ChildPlan source_of_frames() {
  ChildPlan source = shell("capture", "exec sleep 100", true);
  source.is_started_last = true;
  return source;
}

TEST(Supervisor, TheSourceStartsWhenAllOthersHaveSpoken) {
  Supervisor supervisor({shell("a", "exec sleep 100"), shell("b", "exec sleep 100"), source_of_frames()}, quick(),
                        be_silent);
  supervisor.on_heartbeat(supervisor.states()[0].pid);
  EXPECT_TRUE(supervisor.step());
  EXPECT_TRUE(supervisor.states()[2].waits);
  EXPECT_EQ(supervisor.states()[2].pid, 0) << "b has said nothing yet";
  supervisor.on_heartbeat(supervisor.states()[1].pid);
  EXPECT_TRUE(supervisor.step());
  EXPECT_FALSE(supervisor.states()[2].waits);
  EXPECT_NE(supervisor.states()[2].pid, 0);
  EXPECT_EQ(supervisor.states()[2].restarts, 0);
}

TEST(Supervisor, TheSourceDoesNotWaitForEver) {
  SupervisorSettings settings = quick();
  settings.others_timeout = milliseconds(200);
  std::vector<std::string> lines;
  Supervisor supervisor({shell("mute", "exec sleep 100"), source_of_frames()}, settings,
                        [&](const std::string& words) { lines.push_back(words); });
  const auto start = std::chrono::steady_clock::now();
  ASSERT_TRUE(step_until(supervisor, [&] { return supervisor.states()[1].pid != 0; }));
  EXPECT_GE(std::chrono::steady_clock::now() - start, milliseconds(150));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[1], "capture starts without waiting any longer for mute: nothing was heard of it for 0.2 s");
}

TEST(Supervisor, TheEndOfTheSourceEndsTheStream) {
  Supervisor supervisor({shell("detect", "exec sleep 100"), shell("capture", "exit 0", true)}, quick(), be_silent);
  bool ended = false;
  for (int i = 0; i < 1000 && !ended; ++i) {
    ended = !supervisor.step();
    std::this_thread::sleep_for(milliseconds(10));
  }
  EXPECT_TRUE(ended);
}

TEST(Supervisor, WhatTheSourceHasSentLastGoesThroughTheOthers) {
  ChildPlan source = shell("capture", "exit 0", true);
  source.is_started_last = true;
  SupervisorSettings settings = quick();
  settings.others_timeout = milliseconds(10);
  Supervisor supervisor({shell("detect", "exec sleep 100"), source}, settings, be_silent);
  const pid_t detector = supervisor.states()[0].pid;
  EXPECT_TRUE(supervisor.downstream_pids().empty());
  bool ended = false;
  for (int i = 0; i < 1000 && !ended; ++i) {
    ended = !supervisor.step();
    std::this_thread::sleep_for(milliseconds(10));
  }
  ASSERT_TRUE(ended);
  EXPECT_EQ(supervisor.downstream_pids(), std::vector<pid_t>{detector});
}

TEST(Supervisor, AMissingProgramIsNamed) {
  EXPECT_THROW(Supervisor({{"a", {"/nowhere/hs-detect"}, false}}, quick(), be_silent), InputError);
}

TEST(Supervisor, WhoDiesAgainAndAgainIsGivenUpWithItsLastWords) {
  SupervisorSettings settings = quick();
  settings.max_failures = 3;
  settings.start_time = milliseconds(0);  // it has run, and dies all the same
  Supervisor supervisor({shell("a", "sleep 0.05; echo the disk is gone >&2; exit 3")}, settings, be_silent);
  try {
    step_until(supervisor, [] { return false; });
    FAIL() << "is started again for ever";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "a ended with status 3, 3 times in a row: it is given up; its last words: the disk is gone");
  }
}

}  // namespace
}  // namespace houghstream::stream
