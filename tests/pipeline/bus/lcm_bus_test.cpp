#include "pipeline/bus/lcm_bus.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <thread>

#include "pipeline/base/log_line.hpp"
#include "pipeline/bus/channels.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/messages/messages.hpp"

namespace houghstream {
namespace {

using std::chrono::milliseconds;

detections_t numbered(std::int64_t utime) {
  Detections detections;
  detections.frame.utime = utime;
  return to_message(detections);
}

TEST(LcmBus, CarriesMessages) {
  LcmBus bus("memq://");
  std::int64_t seen = 0;
  bus.subscribe("X", [&](const Arrival& arrival) { seen = decode_message<detections_t>(arrival.bytes).utime; });
  bus.publish("X", numbered(42));
  EXPECT_TRUE(bus.handle(milliseconds(100)));
  EXPECT_EQ(seen, 42);
  EXPECT_FALSE(bus.is_log());
}

TEST(LcmBus, ThrowingHandlersDoNotStopIt) {
  LcmBus bus("memq://");
  int calls = 0;
  bus.subscribe("X", [&](const Arrival&) {
    ++calls;
    throw std::runtime_error("handler failed");
  });
  bus.publish("X", numbered(1));
  bus.publish("X", numbered(2));
  EXPECT_TRUE(bus.handle(milliseconds(100)));
  EXPECT_TRUE(bus.handle(milliseconds(100)));
  EXPECT_EQ(calls, 2);
}

/// The channels, of those that hold messages, from which a subscriber of `pattern` gets them.
std::string heard(LcmBus& bus, const std::string& pattern, const std::function<void()>& play) {
  std::string names;
  bus.subscribe(pattern, [&](const Arrival& arrival) { names += arrival.channel + " "; });
  play();
  return names;
}

TEST(LcmBus, APatternMeansTheSameOnTheBusAndInALog) {
  const std::vector<std::string> channels = {"LEFT", "LEFT_2", "UPRIGHT", "RIGHT", "DEFT"};
  const auto file = std::filesystem::temp_directory_path() / ("lcm_bus_test_pattern." + std::to_string(getpid()));
  LogWriter writer(file);
  const std::vector<std::uint8_t> bytes = encode_message(numbered(1));
  for (const std::string& name : channels) writer.write(1, name, {bytes.data(), bytes.size()});
  writer.close();
  for (const auto& [pattern, expected] :
       {std::pair<std::string, std::string>{"LEFT|RIGHT", "LEFT RIGHT "}, {".EFT", "LEFT DEFT "}, {"LEFT", "LEFT "}}) {
    LcmBus network("memq://");
    EXPECT_EQ(heard(network, pattern,
                    [&] {
                      for (const std::string& name : channels) network.publish(name, numbered(1));
                      for (std::size_t i = 0; i < channels.size(); ++i) network.handle(milliseconds(10));
                    }),
              expected);
    LcmBus log("file://" + file.string());
    EXPECT_EQ(heard(log, pattern,
                    [&] {
                      while (log.handle(milliseconds(0))) {
                      }
                    }),
              expected);
    EXPECT_THROW(log.subscribe("(", {}), InputError);
    EXPECT_THROW(network.subscribe("(", {}), InputError);
  }
  std::filesystem::remove(file);
}

TEST(LcmBus, AFloodOfBadMessagesIsNotLoggedLineByLine) {
  testing::internal::CaptureStderr();
  start_log("test", LogLevel::kInfo);
  {
    LcmBus bus("memq://");
    bus.subscribe("X", [&](const Arrival&) { throw std::runtime_error("handler failed"); });
    for (int i = 0; i < 50; ++i) {
      bus.publish("X", numbered(i));
      bus.handle(milliseconds(100));
    }
  }
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 2) << log;
  EXPECT_NE(log.find("49 more messages dropped"), std::string::npos) << log;
}

/// A server of tcpq that takes one client, and all that it publishes.
class TcpServer {
 public:
  TcpServer() : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    const bool listens = bind(socket_, reinterpret_cast<sockaddr*>(&address), size) == 0 && listen(socket_, 1) == 0 &&
                         getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) == 0;
    EXPECT_TRUE(listens);
    url_ = "tcpq://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    thread_ = std::thread([this] { serve(); });
  }
  ~TcpServer() {
    if (thread_.joinable()) thread_.join();
    close(socket_);
  }
  TcpServer(const TcpServer&) = delete;
  TcpServer& operator=(const TcpServer&) = delete;

  const std::string& url() const { return url_; }

  /// Messages that have come whole on channel X once the client has gone; -1 where parts of two were mixed.
  int messages() {
    thread_.join();
    return messages_;
  }

 private:
  static bool take(int client, void* bytes, std::size_t size) {
    return recv(client, bytes, size, MSG_WAITALL) == static_cast<ssize_t>(size);
  }

  static std::uint32_t number(int client) {
    std::uint32_t value = 0;
    return take(client, &value, sizeof value) ? ntohl(value) : 0;
  }

  void serve() {
    const int client = accept(socket_, nullptr, nullptr);
    number(client);  // magic
    number(client);  // version
    const std::uint32_t hello[] = {htonl(0x287617fa), htonl(0x0100)};
    send(client, hello, sizeof hello, 0);
    while (const std::uint32_t type = number(client)) {
      std::string name(std::min(number(client), 100U), ' ');
      take(client, name.data(), name.size());
      std::string data(std::min(number(client), 100'000U), ' ');
      const bool whole = take(client, data.data(), data.size()) && type == 1 && name == "X" && !data.empty() &&
                         data.find_first_not_of(data[0]) == std::string::npos;
      messages_ = whole ? messages_ + 1 : -1;
      if (!whole) break;
    }
    shutdown(socket_, SHUT_RDWR);  // nobody waits for an answer to another greeting
    close(client);
  }

  int socket_;
  std::string url_;
  int messages_ = 0;
  std::thread thread_;
};

TEST(LcmBus, WhatSeveralThreadsPublishOverTcpIsNotMixed) {
  constexpr int kEach = 3000;
  TcpServer server;
  {
    LcmBus bus(server.url());
    const auto publish = [&](std::uint8_t value) {
      const std::vector<std::uint8_t> bytes(200, value);
      try {
        for (int i = 0; i < kEach; ++i) bus.publish("X", {bytes.data(), bytes.size()}, 0);
      } catch (const InputError&) {  // the server has gone
      }
    };
    std::thread other([&] { publish('a'); });
    publish('b');
    other.join();
  }
  EXPECT_EQ(server.messages(), 2 * kEach);
}

TEST(LcmBus, WithoutAServerReceivingFailsAfterItsTime) {
  LcmBus bus("tcpq://127.0.0.1:1");
  bus.subscribe("X", [](const Arrival&) {});
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THROW(bus.handle(milliseconds(50)), InputError);
  EXPECT_GE(std::chrono::steady_clock::now() - start, milliseconds(50));
}

TEST(LcmBus, RefusesWhatItCannotOpen) {
  EXPECT_THROW(LcmBus("nosuch://"), InputError);
  EXPECT_THROW(LcmBus("file:///no/such/log"), InputError);
  EXPECT_THROW(LcmBus("memq://", "results.log"), InputError);
}

TEST(LcmBus, ResultsOfALogNeedAPlaceToGo) {
  EXPECT_THROW(require_output_log("file:///some.lcmlog", ""), InputError);
  EXPECT_NO_THROW(require_output_log("file:///some.lcmlog", "results.lcmlog"));
  EXPECT_NO_THROW(require_output_log("memq://", ""));
  setenv("LCM_DEFAULT_URL", "file:///some.lcmlog", 1);
  EXPECT_THROW(require_output_log("", ""), InputError);
  unsetenv("LCM_DEFAULT_URL");
}

TEST(LcmBus, ReadsALogWithoutSkippingAndWritesAnother) {
  const auto folder = std::filesystem::temp_directory_path();
  const auto input = folder / ("lcm_bus_test_in." + std::to_string(getpid()));
  const auto output = folder / ("lcm_bus_test_out." + std::to_string(getpid()));
  LogWriter writer(input);
  for (std::int64_t i = 0; i < 200; ++i) {
    const std::vector<std::uint8_t> bytes = encode_message(numbered(i));
    writer.write(i, i % 2 == 0 ? "X" : "Y", {bytes.data(), bytes.size()});
  }
  writer.close();

  LcmBus bus("file://" + input.string() + "?speed=0", output.string());
  EXPECT_TRUE(bus.is_log());
  std::vector<std::int64_t> utimes;
  bus.subscribe("X", [&](const Arrival& arrival) {
    utimes.push_back(read_utime(arrival.bytes, arrival.channel));
    bus.publish("Z", numbered(utimes.back()));
  });
  while (bus.handle(milliseconds(0))) {
  }
  bus.close();
  EXPECT_EQ(utimes.size(), 100U);
  LogReader reader(output);
  const std::optional<LogEvent> first = reader.next();
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->channel, "Z");
  EXPECT_EQ(reader.next()->timestamp, 2);

  EXPECT_THROW(LcmBus("file://" + input.string(), input.string()), InputError) << "its own source";
  EXPECT_GT(std::filesystem::file_size(input), 200U * 28);

  const auto size = std::filesystem::file_size(output);
  {
    LcmBus fruitless("file://" + input.string(), output.string());
    fruitless.subscribe("NOTHING", [](const Arrival&) {});
    while (fruitless.handle(milliseconds(0))) {
    }
    try {
      fruitless.close();
      ADD_FAILURE() << "a log of nothing was written";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("on X (100), Y (100)"), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(std::filesystem::file_size(output), size) << "what was there stays";

  LcmBus read_only("file://" + input.string());
  EXPECT_THROW(read_only.publish("Z", numbered(1)), InputError);
  std::filesystem::remove(input);
  std::filesystem::remove(output);
}

}  // namespace
}  // namespace houghstream
