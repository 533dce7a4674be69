#include "pipeline/bus/lcm_url.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

std::string text_of(const std::optional<Endpoint>& place) {
  return place ? place->address + " " + place->port : "none";
}

TEST(LcmUrl, LeadsWhereLcmGoes) {
  EXPECT_EQ(text_of(parse_multicast_group("udpm://239.1.2.3:4000?ttl=1")), "239.1.2.3 4000");
  EXPECT_EQ(text_of(parse_multicast_group("udpm://239.1.2.3")), "239.1.2.3 7667");
  EXPECT_EQ(text_of(parse_multicast_group("udpm://")), "239.255.76.67 7667");
  EXPECT_EQ(text_of(parse_multicast_group("udpm://?ttl=1")), "239.255.76.67 7667");
  EXPECT_EQ(text_of(parse_multicast_group("tcpq://10.0.0.2:7800")), "none");
  EXPECT_EQ(text_of(parse_tcp_server("tcpq://10.0.0.2:7800")), "10.0.0.2 7800");
  EXPECT_EQ(text_of(parse_tcp_server("tcpq://10.0.0.2")), "10.0.0.2 7700");
  EXPECT_EQ(text_of(parse_tcp_server("tcpq://")), "127.0.0.1 7700");
  EXPECT_EQ(text_of(parse_tcp_server("memq://")), "none");
}

TEST(LcmUrl, OptionsAreWhatLcmTakesThemFor) {
  const std::vector<std::pair<std::string, std::string>> options = {{"ttl", "1"}, {"a", ""}, {"b", "c=d"}};
  EXPECT_EQ(url_options("udpm://239.1.2.3:4000?ttl=1&a,b=c=d&"), options);
  EXPECT_TRUE(url_options("udpm://").empty());
  EXPECT_TRUE(url_options("udpm://?").empty());
}

TEST(LcmUrl, WhatLcmUnderstandsIsTaken) {
  for (const char* url :
       {"udpm://", "udpm://239.255.76.67:7667?ttl=0", "udpm://?ttl=255&recv_buf_size=16777216",
        "udpm://239.1.2.3?new=1", "tcpq://robot", "tcpq://10.0.0.2:7800", "memq://", "file:///tmp/a log?speed=0"}) {
    EXPECT_NO_THROW(check_lcm_url(url)) << url;
  }
}

TEST(LcmUrl, WhatLcmWouldMistakeIsRefused) {
  for (const char* url : {"",
                          "bogus",
                          "udpm:/239.255.76.67",
                          "nosuch://x",
                          "udpm://robot",
                          "udpm://1.2.3",
                          "udpm://10.0.0.2:7667",
                          "udpm://:7667",
                          "udpm://239.1.2.3:",
                          "udpm://239.1.2.3:0",
                          "udpm://239.1.2.3:65536",
                          "udpm://?ttl=-1",
                          "udpm://?ttl=abc",
                          "udpm://?ttl=256",
                          "udpm://?ttl=",
                          "udpm://?ttl",
                          "udpm://?ttl=0x1",
                          "udpm://?ttl=010",
                          "udpm://?ttl=0&ttl=1",
                          "udpm://?recv_buf_size=2MB",
                          "udpm://?recv_buf_size=99999999999"}) {
    EXPECT_THROW(check_lcm_url(url), InputError) << url;
  }
}

TEST(LcmUrl, ALogWithoutItsSchemeIsToldWithIt) {
  const std::string log = (fresh_folder("lcm_url") / "take.lcmlog").string();
  EXPECT_EQ(error_of([&] { check_lcm_url(log); }).find("did you mean"), std::string::npos) << "no such log";
  write_text(log, "");
  expect_says(error_of([&] { check_lcm_url(log); }), {"LCM URL '" + log + "'", "did you mean file://" + log + "?"});
}

TEST(LcmUrl, WhatLcmPassesOverIsSaid) {
  EXPECT_EQ(unknown_options_advice("udpm://?ttl=0&recv_buf_size=5"), "");
  EXPECT_EQ(unknown_options_advice("file://a?speed=0"), "");
  EXPECT_NE(unknown_options_advice("udpm://?ttl=0&tll=1").find("'tll'"), std::string::npos);
  EXPECT_NE(unknown_options_advice("tcpq://robot?ttl=1").find("'ttl'"), std::string::npos);
}

TEST(LcmUrl, ARouteIsAskedForOfMulticastAndAServerOfTcp) {
  EXPECT_EQ(unreachable_reason("udpm://127.0.0.1"), "") << "to this machine there is a way";
  EXPECT_EQ(unreachable_reason("memq://"), "");
  EXPECT_EQ(unreachable_reason("file://my.lcmlog"), "");
  EXPECT_EQ(unreachable_reason("tcpq://127.0.0.1:1"),
            "not connected to the server at 127.0.0.1:1 (Connection refused)");
}

}  // namespace
}  // namespace houghstream
