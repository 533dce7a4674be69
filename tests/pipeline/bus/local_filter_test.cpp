#include "pipeline/bus/local_filter.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(OwnHost, MulticastStaysOnThisMachineUnlessItSaysOtherwise) {
  EXPECT_TRUE(is_host_local("udpm://"));
  EXPECT_TRUE(is_host_local("udpm://239.255.76.67:7667?ttl=0"));
  EXPECT_TRUE(is_host_local("udpm://?ttl=-1")) << "no reason to let others in";
  EXPECT_FALSE(is_host_local("udpm://?ttl=1"));
  EXPECT_FALSE(is_host_local("udpm://?recv_buf_size=5&ttl=2"));
  EXPECT_FALSE(is_host_local("tcpq://127.0.0.1"));
}

TEST(OwnHost, OtherUrlsHaveNoSocketsThatReceive) {
  EXPECT_TRUE(find_receive_sockets("tcpq://127.0.0.1:7700").empty());
}

}  // namespace
}  // namespace houghstream
