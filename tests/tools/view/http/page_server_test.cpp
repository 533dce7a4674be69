#include "tools/view/http/page_server.hpp"

#include <gtest/gtest.h>
#include <httplib.h>

namespace houghstream::view {
namespace {

struct Served {
  explicit Served(const std::string& host = "127.0.0.1")
      : server({host, 0}, board), client("127.0.0.1", server.port()) {}

  int order(const std::string& body, const httplib::Headers& headers) {
    const httplib::Result answer = client.Post("/orders", headers, body, "application/json");
    return answer ? answer->status : 0;
  }

  PageBoard board;
  PageServer server;
  httplib::Client client;
};

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

TEST(PageServer, PicturesAreThoseOfTheFrameThatIsShown) {
  Served served;
  served.board.put_frame("{}");
  served.board.put_picture(PageView::kColour, {'j', 'p', 'g'});
  const httplib::Result picture = served.client.Get("/picture/colour.jpg");
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->body, "jpg");
  EXPECT_EQ(picture->get_header_value("Content-Type"), "image/jpeg");
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
  EXPECT_NE(heard.find("event: frame\ndata: {\"f\":2}\n\n"), std::string::npos) << heard;
}

TEST(PageServer, ThisMachinesButtonsNeedNoTokenButTheHeaderThatOthersCannotSend) {
  Served served;
  EXPECT_EQ(served.server.token(), "");
  EXPECT_EQ(served.order(R"({"paused":true})", {}), 403);
  EXPECT_EQ(served.order(R"({"paused":true,"min_score":0.5})", kNoToken), 204);
  const PageOrders orders = served.board.take_orders();
  EXPECT_EQ(orders.paused, true);
  EXPECT_EQ(orders.min_score, 0.5F);
}

TEST(PageServer, FromElsewhereButtonsNeedTheToken) {
  Served served("0.0.0.0");
  EXPECT_EQ(served.server.token().size(), 32U);
  EXPECT_NE(served.server.url().find("?token=" + served.server.token()), std::string::npos);
  EXPECT_EQ(served.order("{}", kNoToken), 403);
  EXPECT_EQ(served.order("{}", {{"X-Houghstream-Token", std::string(32, '0')}}), 403);
  EXPECT_EQ(served.order(R"({"next_camera":true})", {{"X-Houghstream-Token", served.server.token()}}), 204);
  EXPECT_TRUE(served.board.take_orders().next_camera);
  EXPECT_EQ(served.client.Get("/")->status, 200);  // looking is free
}

TEST(PageServer, OrdersThatAreNoneAreRefused) {
  Served served;
  for (const char* bad : {"", "[]", "{", R"({"pause":true})", R"({"paused":1})", R"({"min_score":1.5})",
                          R"({"min_score":"0.5"})", R"({"next_camera":null})"})
    EXPECT_EQ(served.order(bad, kNoToken), 400) << bad;
  EXPECT_EQ(served.order(std::string(10'000, 'x'), kNoToken), 413);
  EXPECT_TRUE(served.board.take_orders().empty());
}

TEST(PageServer, ANameThatSomebodyMadeUpForThisMachineIsRefused) {
  Served served;
  EXPECT_EQ(served.client.Get("/", {{"Host", "evil.example:80"}})->status, 403);
}

TEST(PageServer, EndsWhileSomebodyListens) {
  auto served = std::make_unique<Served>();
  const int port = served->server.port();
  std::thread viewer([port] {
    httplib::Client client("127.0.0.1", port);
    client.Get("/events", [](const char*, std::size_t) { return true; });
  });
  while (!served->board.is_looked_at()) std::this_thread::yield();
  served.reset();
  viewer.join();
}

}  // namespace
}  // namespace houghstream::view
