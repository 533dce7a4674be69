#include "pipeline/base/service_notice.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>

#include "pipeline/base/stop_signal.hpp"

namespace houghstream {
namespace {

/// Opens a service manager's socket.
int open_manager(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof(address.sun_path) - 1);
  const int manager = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  EXPECT_EQ(bind(manager, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  setenv("NOTIFY_SOCKET", path.c_str(), 1);
  return manager;
}

TEST(ServiceNotice, GoesToTheSocketThatTheManagerNames) {
  const std::string path = testing::TempDir() + "/service_notice_" + std::to_string(getpid());
  const int manager = open_manager(path);
  notify_service("READY=1");
  char heard[64] = {};
  EXPECT_EQ(recv(manager, heard, sizeof heard, 0), 7);
  EXPECT_STREQ(heard, "READY=1");
  unsetenv("NOTIFY_SOCKET");
  notify_service("READY=1");
  EXPECT_LT(recv(manager, heard, sizeof heard, 0), 0) << "without a manager nothing is sent";
  setenv("NOTIFY_SOCKET", "/no/such/socket", 1);
  notify_service("READY=1");
  unsetenv("NOTIFY_SOCKET");
  close(manager);
  unlink(path.c_str());
}

TEST(StillFinishing, AsksForTimeWhileItLives) {
  const std::string path = testing::TempDir() + "/still_finishing_" + std::to_string(getpid());
  const int manager = open_manager(path);
  char heard[64] = {};
  {
    const StillFinishing finishing;
    for (int i = 0; i < 1000 && recv(manager, heard, sizeof heard, 0) < 0; ++i) usleep(10'000);
    EXPECT_STREQ(heard, "EXTEND_TIMEOUT_USEC=5000000\nSTOPPING=1");
  }
  while (recv(manager, heard, sizeof heard, 0) >= 0) {
  }
  usleep(1'200'000);
  EXPECT_LT(recv(manager, heard, sizeof heard, 0), 0) << "it has ended";
  unsetenv("NOTIFY_SOCKET");
  close(manager);
  unlink(path.c_str());
}

TEST(StillFinishing, AsksForTimeAsSoonAsAStopSignalHasCome) {
  const std::string path = testing::TempDir() + "/still_finishing_signal_" + std::to_string(getpid());
  const int manager = open_manager(path);
  catch_stop_signals();
  char heard[64] = {};
  {
    const StillFinishing finishing(StillFinishing::From::kStopSignal);
    usleep(200'000);
    EXPECT_LT(recv(manager, heard, sizeof heard, 0), 0) << "it works on";
    raise(SIGTERM);
    for (int i = 0; i < 1000 && recv(manager, heard, sizeof heard, 0) < 0; ++i) usleep(10'000);
    EXPECT_STREQ(heard, "EXTEND_TIMEOUT_USEC=5000000\nSTOPPING=1");
  }
  release_stop_signals();
  unsetenv("NOTIFY_SOCKET");
  close(manager);
  unlink(path.c_str());
}

TEST(Heartbeat, BeatsWhereItHasJustBegun) {
  Heartbeat heart;
  EXPECT_TRUE(heart.is_beating());
}

}  // namespace
}  // namespace houghstream
