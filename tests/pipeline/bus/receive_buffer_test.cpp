#include "pipeline/bus/receive_buffer.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(ReceiveBuffer, IsAskedForWhereTheUrlDoesNot) {
  EXPECT_EQ(with_receive_buffer("udpm://239.255.76.67:7667?ttl=0", 1024),
            "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=1024");
  EXPECT_EQ(with_receive_buffer("udpm://239.255.76.67:7667", 1024), "udpm://239.255.76.67:7667?recv_buf_size=1024");
  EXPECT_EQ(with_receive_buffer("udpm://?recv_buf_size=5", 1024), "udpm://?recv_buf_size=5");
  EXPECT_EQ(with_receive_buffer("memq://", 1024), "memq://");
}

TEST(ReceiveBuffer, SmallRequestsAreGranted) {
  EXPECT_EQ(granted_receive_buffer(65536), 65536);
}

TEST(ReceiveBuffer, TooLittleComesWithTheLineThatMendsIt) {
  EXPECT_EQ(receive_buffer_advice(kNeededReceiveBuffer), "");
  const std::string advice = receive_buffer_advice(212992);
  EXPECT_NE(advice.find("208 kB"), std::string::npos) << advice;
  EXPECT_NE(advice.find("sudo sysctl -w net.core.rmem_max=16777216"), std::string::npos) << advice;
}

TEST(ReceiveBuffer, GrowsWithTheFrames) {
  EXPECT_EQ(needed_receive_buffer(640 * 480 * 5), kNeededReceiveBuffer);
  EXPECT_LT(needed_receive_buffer(50'000), 212'992) << "the kernel's default carries small frames";
  EXPECT_NE(receive_buffer_advice(0).find(receive_buffer_remedy()), std::string::npos);
}

}  // namespace
}  // namespace houghstream
