#include "pipeline/bus/own_host.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

std::string text_of(const std::optional<BusPlace>& place) {
  return place ? place->address + " " + place->port : "none";
}

TEST(OwnHost, AUrlLeadsWhereLcmGoes) {
  EXPECT_EQ(text_of(multicast_group("udpm://239.1.2.3:4000?ttl=1")), "239.1.2.3 4000");
  EXPECT_EQ(text_of(multicast_group("udpm://239.1.2.3")), "239.1.2.3 7667");
  EXPECT_EQ(text_of(multicast_group("udpm://")), "239.255.76.67 7667");
  EXPECT_EQ(text_of(multicast_group("udpm://?ttl=1")), "239.255.76.67 7667");
  EXPECT_EQ(text_of(multicast_group("tcpq://10.0.0.2:7800")), "none");
  EXPECT_EQ(text_of(tcp_server("tcpq://10.0.0.2:7800")), "10.0.0.2 7800");
  EXPECT_EQ(text_of(tcp_server("tcpq://10.0.0.2")), "10.0.0.2 7700");
  EXPECT_EQ(text_of(tcp_server("tcpq://")), "127.0.0.1 7700");
  EXPECT_EQ(text_of(tcp_server("memq://")), "none");
}

TEST(OwnHost, MulticastStaysOnThisMachineUnlessItSaysOtherwise) {
  EXPECT_TRUE(is_of_own_host("udpm://"));
  EXPECT_TRUE(is_of_own_host("udpm://239.255.76.67:7667?ttl=0"));
  EXPECT_FALSE(is_of_own_host("udpm://?ttl=1"));
  EXPECT_FALSE(is_of_own_host("tcpq://127.0.0.1"));
}

TEST(OwnHost, OtherUrlsHaveNoSocketsThatReceive) {
  EXPECT_TRUE(receiving_sockets("tcpq://127.0.0.1:7700").empty());
}

}  // namespace
}  // namespace houghstream
