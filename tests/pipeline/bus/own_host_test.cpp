#include "pipeline/bus/own_host.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(OwnHost, MulticastStaysOnThisMachineUnlessItSaysOtherwise) {
  EXPECT_TRUE(is_of_own_host("udpm://"));
  EXPECT_TRUE(is_of_own_host("udpm://239.255.76.67:7667?ttl=0"));
  EXPECT_TRUE(is_of_own_host("udpm://?ttl=-1")) << "no reason to let others in";
  EXPECT_FALSE(is_of_own_host("udpm://?ttl=1"));
  EXPECT_FALSE(is_of_own_host("udpm://?recv_buf_size=5&ttl=2"));
  EXPECT_FALSE(is_of_own_host("tcpq://127.0.0.1"));
}

TEST(OwnHost, OtherUrlsHaveNoSocketsThatReceive) {
  EXPECT_TRUE(receiving_sockets("tcpq://127.0.0.1:7700").empty());
}

}  // namespace
}  // namespace houghstream
