#include "tools/view/http/http_address.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tools/view/http/page_server.hpp"

namespace houghstream::view {
namespace {

TEST(HttpAddress, APortAloneIsForThisMachine) {
  EXPECT_EQ(parse_http_address("8080").host, "127.0.0.1");
  EXPECT_EQ(parse_http_address("8080").port, 8080);
  EXPECT_EQ(parse_http_address("0.0.0.0:80").host, "0.0.0.0");
  EXPECT_EQ(parse_http_address("robot.local:81").port, 81);
  EXPECT_EQ(parse_http_address("[::1]:8080").host, "::1");
}

TEST(HttpAddress, WhatIsNoneIsNamed) {
  for (const char* bad : {"", "x", "80x", "-1", "65536", "999999", ":80", "::1:80", "host:", "http://host:80"}) {
    try {
      parse_http_address(bad);
      ADD_FAILURE() << bad;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(fmt::format("--http {}:", bad)), std::string::npos) << error.what();
    }
  }
}

TEST(HttpAddress, OnlyLoopbackIsLocal) {
  for (const char* local : {"127.0.0.1", "127.1.2.3", "localhost", "::1"}) EXPECT_TRUE(is_local(local)) << local;
  for (const char* other : {"0.0.0.0", "::", "192.168.1.2", "127.0.0.1.evil.org", "robot"})
    EXPECT_FALSE(is_local(other)) << other;
  for (const char* named : {"localhost:8080", "127.0.0.1", "[::1]:80"}) EXPECT_TRUE(names_this_machine(named)) << named;
  for (const char* named : {"", "evil.org:8080", "127.0.0.1.evil.org"})
    EXPECT_FALSE(names_this_machine(named)) << named;
}

std::string refusal(const HttpAddress& address) {
  try {
    PageBoard board;
    const PageServer server(address, board);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(HttpAddress, AddressesThatCannotBeServedSayWhy) {
  PageBoard board;
  const PageServer first({"127.0.0.1", 0}, board);
  EXPECT_NE(refusal({"127.0.0.1", first.port()}).find("is taken"), std::string::npos);
  EXPECT_NE(refusal({"203.0.113.7", 8080}).find("this machine has no address"), std::string::npos);
  EXPECT_NE(refusal({"300.1.2.3", 8080}).find("is no address"), std::string::npos);
}

}  // namespace
}  // namespace houghstream::view
