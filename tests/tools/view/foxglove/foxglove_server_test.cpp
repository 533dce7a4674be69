#include "tools/view/foxglove/foxglove_server.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"
#include "tests/tools/view/foxglove/socket_client.hpp"

// What Foxglove's own client makes of it is tested by foxglove_live_test.

namespace houghstream::view {
namespace {

using Json = nlohmann::json;

HttpAddress any_port() {
  return {};
}

foxglove::FoxgloveMessage message_on(const std::string& topic, const std::string& type, const std::string& data) {
  foxglove::FoxgloveMessage message;
  message.topic = topic;
  message.type = type;
  message.data = data;
  return message;
}

Json next_json(SocketClient& client) {
  const auto frame = client.next();
  return frame && frame->opcode == 1 ? Json::parse(frame->content) : Json();
}

/// Waits for what another thread does.
template <typename Condition>
bool comes(const Condition& condition) {
  for (int i = 0; i < 400 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return condition();
}

/// Returns the data of the next binary message, and checks its head.
std::string next_data(SocketClient& client, std::uint32_t subscription) {
  const auto frame = client.next();
  if (!frame || frame->opcode != 2) return "no binary message";
  std::uint32_t number = 0;
  std::memcpy(&number, frame->content.data() + 1, sizeof number);
  EXPECT_EQ(frame->content[0], 1);
  EXPECT_EQ(number, subscription);
  return frame->content.substr(13);
}

TEST(FoxgloveServer, GreetsAdvertisesAndSendsWhatIsSubscribedTo) {
  FoxgloveServer server(any_port());
  EXPECT_FALSE(server.has_clients());
  server.publish(message_on("/early", "foxglove.RawImage", "nobody looks"));
  SocketClient client(server.port());
  const std::string head = client.shake_hands();
  EXPECT_EQ(head.substr(0, 12), "HTTP/1.1 101") << head;
  EXPECT_NE(head.find("Sec-WebSocket-Protocol: foxglove.websocket.v1"), std::string::npos) << head;
  const Json info = next_json(client);
  EXPECT_EQ(info["op"], "serverInfo");
  const Json advertised = next_json(client);
  EXPECT_EQ(advertised["op"], "advertise");
  ASSERT_EQ(advertised["channels"].size(), 1U);
  EXPECT_EQ(advertised["channels"][0]["topic"], "/early");
  EXPECT_EQ(advertised["channels"][0]["schemaName"], "foxglove.RawImage");

  server.publish(message_on("/late", "foxglove.RawImage", "before it is subscribed to"));
  const Json later = next_json(client);
  EXPECT_EQ(later["channels"][0]["topic"], "/late");
  client.send_text(R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":1}]})");
  ASSERT_TRUE(comes([&] {
    server.publish(message_on("/early", "foxglove.RawImage", "another topic"));
    server.publish(message_on("/late", "foxglove.RawImage", "data"));
    const auto frame = client.next();
    return frame && frame->content.substr(13) == "data";
  }));
  client.send_text(R"({"op":"unsubscribe","subscriptionIds":[7]})");
  client.send_text(R"({"op":"getParameters"})");
  std::string status;  // behind what was on its way
  for (auto frame = client.next(); frame && status.empty(); frame = status.empty() ? client.next() : frame) {
    if (frame->opcode == 1) status = frame->content;
  }
  EXPECT_NE(status.find("hs-view takes the requests subscribe and unsubscribe"), std::string::npos) << status;
  server.publish(message_on("/late", "foxglove.RawImage", "after it was left"));
  for (const std::string& rubbish :
       {std::string("no JSON"), std::string(100, '['), std::string("{}"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":-1},7,{"id":1,"channelId":9}]})")}) {
    client.send_text(rubbish);
    EXPECT_EQ(next_json(client)["op"], "status") << rubbish;
  }
}

TEST(FoxgloveServer, ALateClientGetsTheModelThatWasSentOnce) {
  FoxgloveServer server(any_port());
  server.publish(message_on("/objects/mug", "foxglove.SceneUpdate", "appears"));
  server.publish(message_on("/objects/mug", "foxglove.SceneUpdate", "is deleted"));
  server.publish(message_on("/image", "foxglove.RawImage", "passes"));
  SocketClient client(server.port());
  client.shake_hands();
  EXPECT_EQ(next_json(client)["op"], "serverInfo");
  EXPECT_EQ(next_json(client)["channels"].size(), 2U);
  client.send_text(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":1},{"id":2,"channelId":0}]})");
  EXPECT_EQ(next_data(client, 2), "is deleted");
}

TEST(FoxgloveServer, ASlowClientLosesImagesIsToldAndKeepsNobodyWaiting) {
  constexpr std::size_t kLimit = 2'000'000;
  constexpr std::chrono::seconds kTimeout(20);  // the server's thread has a low priority, and other tests may run
  FoxgloveServer server(any_port(), kLimit);
  server.publish(message_on("/image", "foxglove.RawImage", ""));
  SocketClient slow(server.port(), 4096);
  SocketClient fast(server.port());
  for (SocketClient* client : {&slow, &fast}) {
    client->shake_hands();
    next_json(*client);
    next_json(*client);
    client->send_text(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":0}]})");
  }
  // Both are subscribed once each gets a message.
  for (SocketClient* client : {&slow, &fast}) {
    ASSERT_TRUE(comes([&] {
      server.publish(message_on("/image", "foxglove.RawImage", "first"));
      return client->next().has_value();
    }));
  }
  const std::string image(1'000'000, 'x');
  std::int64_t received = 0;
  for (int i = 0; i < 20; ++i) {
    server.publish(message_on("/image", "foxglove.RawImage", image));
    for (auto frame = fast.next(kTimeout); frame; frame = fast.next(kTimeout)) {
      if (frame->content.size() < image.size()) continue;
      ++received;
      break;
    }
  }
  EXPECT_EQ(received, 20) << "the other one gets all";
  EXPECT_GT(server.dropped(), 5);
  std::string told;
  for (auto frame = slow.next(); frame && told.empty(); frame = told.empty() ? slow.next() : frame) {
    if (frame->opcode == 1) told = frame->content;
  }
  EXPECT_NE(told.find("messages were dropped: the connection is too slow"), std::string::npos) << told;
}

TEST(FoxgloveServer, AClientThatTakesNothingAtAllIsClosed) {
  FoxgloveServer server(any_port(), 100'000);
  server.publish(message_on("/objects/mug", "foxglove.SceneUpdate", "x"));
  SocketClient client(server.port(), 4096);
  client.shake_hands();
  client.send_text(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":0}]})");
  ASSERT_TRUE(comes([&] { return server.has_clients(); }));
  for (int i = 0; i < 60; ++i) {
    server.publish(message_on("/objects/mug", "foxglove.SceneUpdate", std::string(300'000, 'x')));
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  bool closed = false;
  for (auto frame = client.next(); frame && !closed; frame = closed ? frame : client.next())
    closed = frame->opcode == 8;
  EXPECT_TRUE(closed);
}

TEST(FoxgloveServer, OtherWebsitesAndOtherProtocolsAreRefused) {
  HttpAddress address;
  address.names = {"robot.example"};
  FoxgloveServer server(address);
  const std::string protocol = "Sec-WebSocket-Protocol: something, foxglove.sdk.v1\r\n";
  const auto status_of = [&](const std::string& more) {
    return SocketClient(server.port()).shake_hands(more).substr(9, 3);
  };
  EXPECT_EQ(status_of(protocol), "101");
  EXPECT_EQ(status_of(""), "400");
  EXPECT_EQ(status_of("Sec-WebSocket-Protocol: chat\r\n"), "400");
  EXPECT_EQ(status_of(protocol + "Origin: https://evil.example\r\n"), "403");
  EXPECT_EQ(status_of(protocol + "Origin: http://app.foxglove.dev\r\n"), "403") << "not encrypted: anybody's";
  EXPECT_EQ(status_of(protocol + "Origin: https://app.foxglove.dev\r\n"), "101");
  EXPECT_EQ(status_of(protocol + "Origin: http://localhost:8080\r\n"), "101");
  EXPECT_EQ(status_of(protocol + "Origin: https://robot.example\r\n"), "101");
  EXPECT_EQ(status_of(protocol + "Origin: file://\r\n"), "101");
}

TEST(FoxgloveServer, ACrowdIsLimited) {
  FoxgloveServer server(any_port());
  std::vector<std::unique_ptr<SocketClient>> crowd;
  for (std::size_t i = 0; i < FoxgloveServer::kMaxClients; ++i) {
    crowd.push_back(std::make_unique<SocketClient>(server.port()));
    EXPECT_EQ(crowd.back()->shake_hands().substr(9, 3), "101") << i;
    crowd.back()->next();
  }
  EXPECT_EQ(SocketClient(server.port()).shake_hands().substr(9, 3), "503");
  crowd.pop_back();
  EXPECT_TRUE(comes([&] { return SocketClient(server.port()).shake_hands().substr(9, 3) == "101"; }));
}

TEST(FoxgloveServer, ABrowserIsToldWhatItIs) {
  FoxgloveServer server(any_port());
  const std::string page = SocketClient(server.port()).get_page();
  EXPECT_EQ(page.substr(0, 12), "HTTP/1.1 426") << page;
  EXPECT_NE(page.find("This is a WebSocket for Foxglove"), std::string::npos) << page;
}

TEST(FoxgloveServer, EndsAtOnceAlthoughAClientDoesNotAnswer) {
  auto server = std::make_unique<FoxgloveServer>(any_port());
  SocketClient client(server->port());
  client.shake_hands();
  ASSERT_TRUE(comes([&] { return server->has_clients(); }));
  const auto start = std::chrono::steady_clock::now();
  server.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(900));
}

TEST(FoxgloveServer, ATakenPortIsAnErrorAndTheAddressIsPrinted) {
  FoxgloveServer server(any_port());
  EXPECT_EQ(server.urls(), (std::vector<std::string>{fmt::format("ws://localhost:{}", server.port())}));
  HttpAddress taken;
  taken.port = server.port();
  EXPECT_EQ(error_of([&] { FoxgloveServer second(taken); }),
            fmt::format("--foxglove 127.0.0.1:{0}: port {0} is taken by another program", server.port()));
}

}  // namespace
}  // namespace houghstream::view
