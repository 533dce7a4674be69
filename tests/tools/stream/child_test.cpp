#include "tools/stream/child.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/service_notice.hpp"
#include "tests/test_files.hpp"

namespace houghstream::stream {
namespace {

using std::chrono::milliseconds;

ExitStatus wait_for(ChildProcess& child) {
  for (int i = 0; i < 1000; ++i) {
    if (const auto poll_exit = child.poll_exit()) return *poll_exit;
    std::this_thread::sleep_for(milliseconds(10));
  }
  ADD_FAILURE() << "it did not end";
  return {};
}

TEST(ChildProcess, TellsHowItEnded) {
  ChildProcess good({"/bin/sh", "-c", "exit 0"});
  EXPECT_TRUE(wait_for(good).success);
  ChildProcess bad({"/bin/sh", "-c", "exit 7"});
  const ExitStatus poll_exit = wait_for(bad);
  EXPECT_FALSE(poll_exit.success);
  EXPECT_FALSE(poll_exit.by_signal);
  EXPECT_EQ(poll_exit.words, "ended with status 7");
  ChildProcess killed({"/bin/sh", "-c", "exec sleep 100"});
  killed.signal(SIGTERM);
  EXPECT_TRUE(wait_for(killed).by_signal);
}

TEST(ChildProcess, HasAServiceManagerOfItsOwn) {
  setenv("NOTIFY_SOCKET", "/of/somebody/else", 1);
  const auto folder = fresh_folder("child_notice");
  ChildProcess child({"/bin/sh", "-c", "echo \"$NOTIFY_SOCKET\" >" + (folder / "name").string() + "; exec sleep 100"});
  for (int i = 0; i < 1000 && read_text(folder / "name").empty(); ++i) std::this_thread::sleep_for(milliseconds(10));
  const std::string name = read_text(folder / "name");
  EXPECT_EQ(name.substr(0, 1), "@");
  EXPECT_EQ(read_text(folder / "name").find("/of/somebody"), std::string::npos);
  EXPECT_FALSE(child.needs_time());
  setenv("NOTIFY_SOCKET", name.substr(0, name.find('\n')).c_str(), 1);
  notify_service("READY=1");
  EXPECT_FALSE(child.needs_time());
  notify_service("EXTEND_TIMEOUT_USEC=5000000");
  EXPECT_TRUE(child.needs_time());
  EXPECT_TRUE(child.needs_time()) << "for as long as it has asked for";
  notify_service("EXTEND_TIMEOUT_USEC=0");
  EXPECT_FALSE(child.needs_time());
  unsetenv("NOTIFY_SOCKET");
}

TEST(ChildProcess, DoesNotOutliveItsOwner) {
  pid_t pid = 0;
  {
    ChildProcess child({"/bin/sh", "-c", "exec sleep 100"});
    pid = child.pid();
    EXPECT_EQ(kill(pid, 0), 0);
  }
  EXPECT_NE(kill(pid, 0), 0);
}

// The owner is a process that is killed without a chance to tidy up.
TEST(ChildProcess, DoesNotOutliveAnOwnerThatIsKilled) {
  const auto file = fresh_folder("child_orphan") / "pid";
  const pid_t owner = fork();
  if (owner == 0) {
    const ChildProcess child({"/bin/sh", "-c", "exec sleep 100"});
    std::ofstream(file) << child.pid() << std::endl;
    pause();
    _exit(0);
  }
  pid_t orphan = 0;
  for (int i = 0; i < 1000 && !(std::ifstream(file) >> orphan); ++i) std::this_thread::sleep_for(milliseconds(10));
  ASSERT_GT(orphan, 0);
  kill(owner, SIGKILL);
  waitpid(owner, nullptr, 0);
  const auto ended = [&] {
    std::ifstream stat("/proc/" + std::to_string(orphan) + "/stat");
    std::string number;
    std::string name;
    std::string state = "X";
    stat >> number >> name >> state;
    return state == "X" || state == "Z";  // its parent may have ended
  };
  for (int i = 0; i < 1000 && !ended(); ++i) std::this_thread::sleep_for(milliseconds(10));
  EXPECT_TRUE(ended());
}

TEST(ChildProcess, AMissingProgramIsNamed) {
  EXPECT_THROW(ChildProcess({"/nowhere/hs-detect"}), InputError);
}

TEST(ChildProcess, WhoWritesWithoutEndKeepsNobody) {
  testing::internal::CaptureStderr();
  {
    ChildProcess flood({"/bin/sh", "-c", "while true; do echo words without end >&2; done"}, true);
    for (int i = 0; i < 20; ++i) {
      EXPECT_FALSE(flood.poll_exit().has_value());
      std::this_thread::sleep_for(milliseconds(10));
    }
  }
  EXPECT_FALSE(testing::internal::GetCapturedStderr().empty());
}

using std::chrono::microseconds;

TEST(NoticeSocket, HearsForHowLongMoreTimeIsAskedFor) {
  NoticeSocket socket;
  ASSERT_EQ(socket.name().substr(0, 1), "@");
  EXPECT_FALSE(socket.extension());
  setenv("NOTIFY_SOCKET", socket.name().c_str(), 1);
  for (const char* other : {"READY=1", "", "EXTEND_TIMEOUT_USEC=", "EXTEND_TIMEOUT_USEC=-5", "EXTEND_TIMEOUT_USEC=x",
                            "MY_EXTEND_TIMEOUT_USEC=7", "EXTEND_TIMEOUT_USEC=99999999999999999999"}) {
    notify_service(other);
    EXPECT_FALSE(socket.extension()) << other;
  }
  notify_service("STATUS=a video\nEXTEND_TIMEOUT_USEC=7\nSTOPPING=1");
  EXPECT_EQ(socket.extension(), microseconds(7));
  EXPECT_FALSE(socket.extension()) << "since the last call";
  for (int i = 0; i < 1000; ++i) notify_service("EXTEND_TIMEOUT_USEC=9");
  EXPECT_EQ(socket.extension(), microseconds(9)) << "a full socket keeps nobody";
  unsetenv("NOTIFY_SOCKET");
}

TEST(NoticeSocket, EachHasANameOfItsOwn) {
  EXPECT_NE(NoticeSocket().name(), "");
  const NoticeSocket first;
  const NoticeSocket second;
  EXPECT_NE(first.name(), second.name());
}

}  // namespace

}  // namespace houghstream::stream
