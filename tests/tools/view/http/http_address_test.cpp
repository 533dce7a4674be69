#include "tools/view/http/http_address.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"
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
    expect_says(error_of([&] { parse_http_address(bad); }), {fmt::format("--http {}:", bad)});
  }
}

TEST(HttpAddress, OnlyLoopbackIsLocal) {
  for (const char* local : {"127.0.0.1", "127.1.2.3", "localhost", "::1"}) EXPECT_TRUE(is_local(local)) << local;
  for (const char* other : {"0.0.0.0", "::", "192.168.1.2", "127.0.0.1.evil.org", "robot"})
    EXPECT_FALSE(is_local(other)) << other;
}

TEST(HttpAddress, AHostHeaderIsParsedWholly) {
  EXPECT_EQ(parse_host_header("Robot.Example:8080"), "robot.example");
  EXPECT_EQ(parse_host_header("robot.example."), "robot.example");
  EXPECT_EQ(parse_host_header("[::1]:80"), "::1");
  EXPECT_EQ(parse_host_header("[FE80::1]"), "fe80::1");
  for (const char* bad :
       {"", ":80", "robot:", "robot:80x", "robot:80:80", "robot:123456", "[::1", "[::1].evil.com", "[::1]80",
        "[robot]:80", "::1", "[127.0.0.1]", "user@robot", "robot/evil", "robot evil", "robot,evil"})
    EXPECT_EQ(parse_host_header(bad), std::nullopt) << bad;
}

TEST(HttpAddress, APageForThisMachineAnswersToItsNamesOnly) {
  const HttpAddress local{"127.0.0.1", 8080, {}};
  for (const char* named : {"localhost:8080", "LocalHost", "127.0.0.1", "127.1.2.3:80", "[::1]:80"})
    EXPECT_TRUE(answers_to(local, named)) << named;
  for (const char* named : {"", "evil.org:8080", "127.0.0.1.evil.org", "127.evil.org", "[::1].evil.com",
                            "[::1].evil.com:80", "[::1", "192.168.1.5", "localhost.evil.org", "127.0.0.1:80@evil.org"})
    EXPECT_FALSE(answers_to(local, named)) << named;
  EXPECT_TRUE(answers_to({"127.0.0.1", 8080, {"robot.example"}}, "robot.example:443")) << "through a proxy";
}

TEST(HttpAddress, AnOpenPageAnswersToAddressesAndTheNamesThatItWasStartedFor) {
  const HttpAddress open{"0.0.0.0", 8080, {"robot.example"}};
  for (const char* named : {"robot.example", "ROBOT.example:8080", "robot.example.:80", "192.168.1.5:8080",
                            "[fe80::1]:8080", "localhost:8080", "127.0.0.1"})
    EXPECT_TRUE(answers_to(open, named)) << named;
  for (const char* named :
       {"", "evil.org", "robot.example.evil.org", "evilrobot.example", "192.168.1.5.evil.org", "1.2.3", "3232235777",
        "0x7f.1", "[::1].evil.com", "[fe80::1].evil.com:80", "192.168.1.5@evil.org"})
    EXPECT_FALSE(answers_to(open, named)) << named;
  EXPECT_TRUE(answers_to({"robot.local", 81, {}}, "robot.local:81")) << "the name that it is served at";
}

TEST(HttpAddress, AnOpenPageAnswersToTheNameThatItPrints) {
  PageBoard board;
  const PageServer server({"0.0.0.0", 0, {}}, board);
  const std::string url = server.url();
  EXPECT_TRUE(answers_to({"0.0.0.0", server.port(), {}}, url.substr(7, url.find('/', 7) - 7))) << url;
  const PageServer named({"0.0.0.0", 0, {"robot.example"}}, board);
  EXPECT_EQ(named.url().rfind("http://robot.example:", 0), 0U) << named.url();
}

TEST(HttpAddress, AnOpenPagePrintsWhatAPhoneCanUse) {
  for (const std::string& address : network_addresses("0.0.0.0")) {
    EXPECT_TRUE(parse_host_header(address).has_value()) << address;
    EXPECT_FALSE(is_local(address)) << address;
  }
  for (const char* one : {"127.0.0.1", "192.168.1.5", "robot.example"}) EXPECT_TRUE(network_addresses(one).empty());
  EXPECT_GE(network_addresses("::").size(), network_addresses("0.0.0.0").size());
  PageBoard board;
  const PageServer server({"0.0.0.0", 0, {}}, board);
  const std::vector<std::string> urls = server.network_urls();
  ASSERT_EQ(urls.size(), network_addresses("0.0.0.0").size());
  for (const std::string& url : urls) {
    EXPECT_TRUE(answers_to({"0.0.0.0", server.port(), {}}, url.substr(7, url.find('/', 7) - 7))) << url;
    EXPECT_NE(url.find("?token=" + server.token()), std::string::npos) << url;
  }
  EXPECT_TRUE(PageServer({"127.0.0.1", 0, {}}, board).network_urls().empty());
}

TEST(HttpAddress, ANameThatIsNoneIsRefused) {
  EXPECT_EQ(parse_host_name("Robot.Example"), "robot.example");
  for (const char* bad : {"", "robot:80", "http://robot", "robot/", "ro bot", "*", "*.example", "."}) {
    expect_says(error_of([&] { parse_host_name(bad); }), {fmt::format("--http-host {}:", bad)});
  }
}

std::string refusal(const HttpAddress& address) {
  return error_of([&] {
    PageBoard board;
    const PageServer server(address, board);
  });
}

TEST(HttpAddress, AddressesThatCannotBeServedSayWhy) {
  PageBoard board;
  const PageServer first({"127.0.0.1", 0, {}}, board);
  EXPECT_NE(refusal({"127.0.0.1", first.port(), {}}).find("is taken"), std::string::npos);
  EXPECT_NE(refusal({"203.0.113.7", 8080, {}}).find("this machine has no address"), std::string::npos);
  EXPECT_NE(refusal({"300.1.2.3", 8080, {}}).find("is no address"), std::string::npos);
}

}  // namespace
}  // namespace houghstream::view
