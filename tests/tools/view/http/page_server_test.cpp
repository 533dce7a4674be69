#include "tools/view/http/page_server.hpp"

#include <gtest/gtest.h>
#include <httplib.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "tools/view/http/three_script.hpp"

namespace houghstream::view {
namespace {

struct Served {
  explicit Served(const std::string& host = "127.0.0.1")
      : server({host, 0, {}}, board), client("127.0.0.1", server.port()) {}

  int order(const std::string& body, const httplib::Headers& headers) {
    const httplib::Result answer = client.Post("/orders", headers, body, "application/json");
    return answer ? answer->status : 0;
  }

  PageBoard board;
  PageServer server;
  httplib::Client client;
};

/// A client that sends what it is told to, and reads only when it is told to.
class RawClient {
 public:
  explicit RawClient(int port) : opened_(socket(AF_INET, SOCK_STREAM, 0)) {
    const timeval timeout{20, 0};
    setsockopt(opened_, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof(timeout));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = connect(opened_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  }
  ~RawClient() { close(opened_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  bool say(const std::string& words) const {
    return connected_ && send(opened_, words.data(), words.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(words.size());
  }

  /// Reads until the server closes the connection.
  std::string heard() const {
    std::string all;
    std::array<char, 4096> part{};
    ssize_t size = 0;
    while ((size = recv(opened_, part.data(), part.size(), 0)) > 0)
      all.append(part.data(), static_cast<std::size_t>(size));
    return all;
  }

 private:
  int opened_;
  bool connected_ = false;
};

std::string answer_to(int port, const std::string& request) {
  const RawClient client(port);
  return client.say(request) ? client.heard() : "";
}

using RawClients = std::vector<std::unique_ptr<RawClient>>;

/// Opens more connections than there are threads, each of which sends these words.
RawClients crowd(int port, const std::string& words) {
  RawClients clients;
  for (int i = 0; i < 40; ++i) {
    clients.push_back(std::make_unique<RawClient>(port));
    clients.back()->say(words);
  }
  return clients;
}

constexpr std::chrono::seconds kSoon(10);  // even on a busy machine; a client that says nothing is waited for longer

bool answers_soon(int port, const std::string& path) {
  httplib::Client client("127.0.0.1", port);
  client.set_read_timeout(kSoon);
  client.set_connection_timeout(kSoon);
  const httplib::Result answer = client.Get(path);
  return answer && answer->status == 200;
}

const httplib::Headers kNoToken = {{"X-Houghstream-Token", "none"}};

TEST(PageServer, ThePageIsWholeAndLoadsNothingFromElsewhere) {
  Served served;
  const httplib::Result page = served.client.Get("/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_NE(page->body.find("</html>"), std::string::npos);
  for (const char* elsewhere : {"http:", "https:", "src=\"", "@import", "url("})
    EXPECT_EQ(page->body.find(elsewhere), std::string::npos) << elsewhere;
  EXPECT_NE(page->get_header_value("Content-Security-Policy").find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(served.client.Get("/nothing")->status, 404);
}

TEST(PageServer, TheScriptOfThe3dViewIsServedFromWhereItIsInstalled) {
  Served served;
  const httplib::Result script = served.client.Get("/three.js");
  ASSERT_TRUE(script);
  const std::optional<std::string> installed = read_three_script();
  EXPECT_EQ(script->status, installed ? 200 : 404);
  if (installed) {
    EXPECT_EQ(script->body, *installed);
  } else {
    EXPECT_NE(script->body.find("apt-get install libjs-three"), std::string::npos);
  }
}

TEST(PageServer, ImagesAreThoseOfTheFrameThatIsShown) {
  Served served;
  served.board.put_frame("{}");
  served.board.put_image(PageView::kColour, {'j', 'p', 'g'});
  const httplib::Result image = served.client.Get("/picture/colour.jpg");
  ASSERT_TRUE(image);
  EXPECT_EQ(image->body, "jpg");
  EXPECT_EQ(image->get_header_value("Content-Type"), "image/jpeg");
  EXPECT_EQ(served.client.Get("/picture/depth.jpg")->status, 503);
  EXPECT_EQ(served.client.Get("/picture/other.jpg")->status, 404);
}

TEST(PageServer, EventsComeAsTheyHappen) {
  Served served;
  served.board.put_stream(R"({"s":1})");
  std::string heard;
  served.client.Get("/events", {{"Accept-Encoding", "gzip, br"}}, [&](const char* data, std::size_t size) {
    heard.append(data, size);
    if (heard.find("\"s\":1}\n\n") != std::string::npos && heard.find("frame") == std::string::npos)
      served.board.put_frame(R"({"f":2})");
    return heard.find("\"f\":2}\n\n") == std::string::npos;
  });
  EXPECT_NE(heard.find("event: stream\ndata: {\"s\":1}\n\n"), std::string::npos) << heard;
  EXPECT_NE(heard.find("event: frame\nid: 1\ndata: {\"f\":2}\n\n"), std::string::npos) << heard;
}

TEST(PageServer, ThisMachinesButtonsNeedNoTokenButTheHeaderThatOthersCannotSend) {
  Served served;
  EXPECT_EQ(served.server.token(), "");
  EXPECT_EQ(served.order(R"({"paused":true})", {}), 403);
  const httplib::Result refused = served.client.Post("/orders", "{}", "application/json");
  ASSERT_TRUE(refused);
  EXPECT_NE(refused->body.find("a header X-Houghstream-Token"), std::string::npos) << refused->body;
  EXPECT_EQ(served.order(R"({"paused":true,"min_score":0.5})", kNoToken), 204);
  const PageCommands commands = served.board.pop_commands();
  EXPECT_EQ(commands.paused, true);
  EXPECT_EQ(commands.min_score, 0.5F);
}

TEST(PageServer, FromElsewhereButtonsNeedTheToken) {
  Served served("0.0.0.0");
  EXPECT_EQ(served.server.token().size(), 32U);
  EXPECT_NE(served.server.url().find("?token=" + served.server.token()), std::string::npos);
  EXPECT_EQ(served.order("{}", kNoToken), 403);
  EXPECT_EQ(served.order("{}", {{"X-Houghstream-Token", std::string(32, '0')}}), 403);
  EXPECT_EQ(served.order(R"({"next_camera":true})", {{"X-Houghstream-Token", served.server.token()}}), 204);
  EXPECT_TRUE(served.board.pop_commands().next_camera);
  EXPECT_EQ(served.client.Get("/")->status, 200);  // looking is free
}

TEST(PageServer, OrdersThatAreNoneAreRefused) {
  Served served;
  for (const char* bad : {"", "[]", "{", R"({"pause":true})", R"({"paused":1})", R"({"min_score":1.5})",
                          R"({"min_score":"0.5"})", R"({"next_camera":null})"})
    EXPECT_EQ(served.order(bad, kNoToken), 400) << bad;
  EXPECT_TRUE(served.board.pop_commands().empty());
}

TEST(PageServer, ANameThatSomebodyMadeUpForThisMachineIsRefused) {
  for (const char* host : {"127.0.0.1", "0.0.0.0"}) {
    Served served(host);
    served.board.put_frame("{}");
    served.board.put_image(PageView::kColour, {'j', 'p', 'g'});
    for (const char* path : {"/", "/picture/colour.jpg", "/events"}) {
      for (const char* name : {"evil.example:80", "[::1].evil.example", "127.0.0.1.evil.example"}) {
        const httplib::Result refused = served.client.Get(path, {{"Host", name}});
        ASSERT_TRUE(refused);
        EXPECT_EQ(refused->status, 403) << host << path << name;
        EXPECT_NE(refused->body.find("--http-host NAME"), std::string::npos) << refused->body;
      }
    }
  }
  const std::string twice =
      answer_to(Served().server.port(), "GET / HTTP/1.1\r\nHost: localhost\r\nHost: evil.example\r\n\r\n");
  EXPECT_EQ(twice.rfind("HTTP/1.1 403 ", 0), 0U) << twice.substr(0, 100);
}

TEST(PageServer, ContentOfNoStatedOrTooLargeALengthIsRefusedUnread) {
  Served served;
  const int port = served.server.port();
  const std::string start = "POST /orders HTTP/1.1\r\nHost: localhost\r\nX-Houghstream-Token: none\r\n";
  EXPECT_EQ(answer_to(port, start + "\r\n").rfind("HTTP/1.1 411 ", 0), 0U);
  EXPECT_EQ(answer_to(port, start + "Transfer-Encoding: chunked\r\n\r\n").rfind("HTTP/1.1 411 ", 0), 0U);
  const std::string too_large = answer_to(port, start + "Content-Length: 10000\r\n\r\n");
  EXPECT_EQ(too_large.rfind("HTTP/1.1 413 ", 0), 0U) << too_large;
  EXPECT_NE(too_large.find("expected content of a stated length, at most 4096 bytes"), std::string::npos) << too_large;
  EXPECT_EQ(answer_to(port, "PUT / HTTP/1.1\r\nHost: localhost\r\n\r\n").rfind("HTTP/1.1 411 ", 0), 0U);
}

TEST(PageServer, WhatARefusedRequestBringsIsNotTakenForARequest) {
  Served served;
  const std::string order = R"({"paused":true})";
  const std::string hidden =
      "POST /orders HTTP/1.1\r\nHost: localhost\r\nX-Houghstream-Token: none\r\nContent-Length: " +
      std::to_string(order.size()) + "\r\n\r\n" + order;
  answer_to(served.server.port(), "POST /orders HTTP/1.1\r\nHost: evil.example\r\nContent-Length: " +
                                      std::to_string(hidden.size()) + "\r\n\r\n" + hidden);
  EXPECT_TRUE(served.board.pop_commands().empty());
}

TEST(PageServer, EndsWhileSomebodyListens) {
  auto served = std::make_unique<Served>();
  const int port = served->server.port();
  std::thread viewer([port] {
    httplib::Client client("127.0.0.1", port);
    client.Get("/events", [](const char*, std::size_t) { return true; });
  });
  while (!served->board.has_viewers()) std::this_thread::yield();
  served.reset();
  viewer.join();
}

TEST(PageServer, RangesAreIgnored) {
  Served served;
  served.board.put_frame("{}");
  served.board.put_image(PageView::kColour, std::vector<std::uint8_t>(30'000, 'x'));
  std::string ranges = "bytes=0-";
  while (ranges.size() < 8'000) ranges += ",0-";
  for (const std::string& range : {std::string("bytes=0-9"), ranges}) {
    const httplib::Result image = served.client.Get("/picture/colour.jpg", {{"Range", range}});
    ASSERT_TRUE(image);
    EXPECT_EQ(image->status, 200);
    EXPECT_EQ(image->body.size(), 30'000U);
    EXPECT_FALSE(image->has_header("Content-Range"));
  }
  const std::string refused =
      answer_to(served.server.port(), "GET / HTTP/1.1\r\nHost: evil.example\r\nRange: " + ranges + "\r\n\r\n");
  EXPECT_EQ(refused.rfind("HTTP/1.1 403 ", 0), 0U) << refused.substr(0, 200);
  EXPECT_LT(refused.size(), 1'000U);
}

TEST(PageServer, ARequestWithoutAnEndIsCutOff) {
  Served served;
  const RawClient client(served.server.port());
  const std::string line = "X-Long: " + std::string(1'000, 'x') + "\r\n";
  client.say("GET / HTTP/1.1\r\nHost: localhost\r\n");
  int lines = 0;
  while (lines < 100'000 && client.say(line)) ++lines;
  EXPECT_LT(lines, 100'000);
  EXPECT_TRUE(answers_soon(served.server.port(), "/"));
}

TEST(PageServer, ACrowdThatSaysNothingLeavesItReachable) {
  Served served;
  const int port = served.server.port();
  const RawClients silent = crowd(port, "");
  EXPECT_TRUE(answers_soon(port, "/"));
  const RawClients slow = crowd(port, "GET / HTTP/1.1\r\nHost: local");
  for (const auto& client : slow) client->say("h");
  EXPECT_TRUE(answers_soon(port, "/"));
  const RawClients without_content = crowd(
      port, "POST /orders HTTP/1.1\r\nHost: localhost\r\nX-Houghstream-Token: none\r\nContent-Length: 100\r\n\r\n{");
  EXPECT_TRUE(answers_soon(port, "/"));
}

TEST(PageServer, ACrowdThatReadsNothingLeavesItReachable) {
  Served served;
  const int port = served.server.port();
  served.board.put_frame("{}");
  served.board.put_image(PageView::kColour, std::vector<std::uint8_t>(3'000'000, 'x'));
  served.board.put_image(PageView::kDepth, {'j', 'p', 'g'});
  const RawClients greedy = crowd(port, "GET /picture/colour.jpg HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_TRUE(answers_soon(port, "/"));
  EXPECT_TRUE(answers_soon(port, "/picture/depth.jpg"));
}

TEST(PageServer, ViewersThatReadNothingLoseTheirPlaces) {
  Served served;
  const int port = served.server.port();
  const RawClients deaf = crowd(port, "GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const std::string updates = "\"" + std::string(1'000'000, 'x') + "\"";
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  bool heard = false;
  while (!heard && std::chrono::steady_clock::now() < end) {
    served.board.put_stream(updates);
    httplib::Client viewer("127.0.0.1", port);
    viewer.Get(
        "/events",
        [&](const char* /*data*/, std::size_t /*size*/) {
          heard = true;
          return false;
        },
        [](std::uint64_t /*done*/, std::uint64_t /*all*/) { return true; });
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  EXPECT_TRUE(heard);
}

TEST(PageServer, EndsAtOnceWhateverItsClientsDo) {
  auto served = std::make_unique<Served>();
  const int port = served->server.port();
  served->board.put_frame("{}");
  served->board.put_image(PageView::kColour, std::vector<std::uint8_t>(3'000'000, 'x'));
  const RawClients silent = crowd(port, "GET / HTTP/1.1\r\nHo");
  const RawClients greedy = crowd(port, "GET /picture/colour.jpg HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_TRUE(answers_soon(port, "/"));
  const auto start = std::chrono::steady_clock::now();
  served.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(4));
}

}  // namespace
}  // namespace houghstream::view
