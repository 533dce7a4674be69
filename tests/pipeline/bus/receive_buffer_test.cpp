#include "pipeline/bus/receive_buffer.hpp"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

#include "tests/test_files.hpp"

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

TEST(ReceiveBuffer, WhatTheKernelDropsIsCounted) {
  const int receiver = socket(AF_INET, SOCK_DGRAM, 0);
  const int small = 4096;
  setsockopt(receiver, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(receiver, reinterpret_cast<const sockaddr*>(&address), size), 0);
  ASSERT_EQ(getsockname(receiver, reinterpret_cast<sockaddr*>(&address), &size), 0);
  EXPECT_EQ(count_dropped_datagrams(receiver), 0);

  const int sender = socket(AF_INET, SOCK_DGRAM, 0);
  std::array<char, 1000> data{};
  constexpr int kSent = 50;
  for (int i = 0; i < kSent; ++i) {
    ASSERT_EQ(sendto(sender, data.data(), data.size(), 0, reinterpret_cast<const sockaddr*>(&address), size), 1000);
  }
  EXPECT_TRUE(has_waiting_datagram(receiver));
  EXPECT_FALSE(has_waiting_datagram(sender)) << "nothing was sent to it";
  int received = 0;
  while (recv(receiver, data.data(), data.size(), MSG_DONTWAIT) > 0) ++received;
  EXPECT_FALSE(has_waiting_datagram(receiver));
  EXPECT_LT(received, kSent);
  EXPECT_EQ(received + count_dropped_datagrams(receiver), kSent);
  close(sender);
  close(receiver);
}

TEST(ReceiveBuffer, AFileThatIsNoSocketHasNoAccount) {
  EXPECT_NE(error_of([] { count_dropped_datagrams(-1); }).find("the kernel does not say what it drops"),
            std::string::npos);
  EXPECT_FALSE(force_receive_buffer(-1, kAskedReceiveBuffer));
  EXPECT_FALSE(has_waiting_datagram(-1));
}

}  // namespace
}  // namespace houghstream
