#include "tools/stream/notice_socket.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "pipeline/base/service_notice.hpp"

namespace houghstream::stream {
namespace {

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
