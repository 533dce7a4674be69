#include "pipeline/bus/lcm_bus.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <thread>

#include "pipeline/base/log_line.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "tests/expect_says.hpp"
#include "tests/pipeline/test_frame.hpp"
#include "tests/test_files.hpp"

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
  bus.subscribe("X", [&](const ReceivedMessage& arrival) { seen = decode_message<detections_t>(arrival.bytes).utime; });
  bus.publish("X", numbered(42));
  EXPECT_TRUE(bus.handle(milliseconds(100)));
  EXPECT_EQ(seen, 42);
  EXPECT_FALSE(bus.is_log());
}

TEST(LcmBus, ThrowingHandlersDoNotStopIt) {
  LcmBus bus("memq://");
  int calls = 0;
  bus.subscribe("X", [&](const ReceivedMessage&) {
    ++calls;
    throw std::runtime_error("handler failed");
  });
  bus.publish("X", numbered(1));
  bus.publish("X", numbered(2));
  EXPECT_TRUE(bus.handle(milliseconds(100)));
  EXPECT_TRUE(bus.handle(milliseconds(100)));
  EXPECT_EQ(calls, 2);
}

/// Returns the channels, of those that hold messages, from which a subscriber of `pattern` gets them.
std::string heard(LcmBus& bus, const std::string& pattern, const std::function<void()>& play) {
  std::string names;
  bus.subscribe(pattern, [&](const ReceivedMessage& arrival) { names += arrival.channel + " "; });
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
    bus.subscribe("X", [&](const ReceivedMessage&) { throw std::runtime_error("handler failed"); });
    for (int i = 0; i < 50; ++i) {
      bus.publish("X", numbered(i));
      bus.handle(milliseconds(100));
    }
  }
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 2) << log;
  EXPECT_NE(log.find("49 more messages dropped"), std::string::npos) << log;
}

/// Runs a server of tcpq that receives all messages of its clients, and forwards none. Nobody can connect before
/// start().
class TcpServer {
 public:
  explicit TcpServer(bool is_started = true) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    const bool is_bound = bind(socket_, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                          getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) == 0;
    EXPECT_TRUE(is_bound);
    url_ = "tcpq://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    if (is_started) start();
  }
  ~TcpServer() {
    finish();
    close(socket_);
  }
  TcpServer(const TcpServer&) = delete;
  TcpServer& operator=(const TcpServer&) = delete;

  void start() {
    EXPECT_EQ(listen(socket_, 4), 0);
    thread_ = std::thread([this] {
      for (int client = accept(socket_, nullptr, nullptr); client >= 0; client = accept(socket_, nullptr, nullptr))
        clients_.emplace_back([this, client] { serve(client); });
    });
  }

  const std::string& url() const { return url_; }

  /// Messages that have come whole on channel X once the clients have gone; -1 where parts of two were mixed.
  int messages() {
    finish();
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

  /// Takes no further client and waits until those that there are have gone.
  void finish() {
    if (!thread_.joinable()) return;
    shutdown(socket_, SHUT_RDWR);
    thread_.join();
    for (std::thread& client : clients_) client.join();
  }

  void serve(int client) {
    constexpr std::uint32_t kPublish = 1;
    constexpr std::uint32_t kUnsubscribe = 3;
    const bool has_greeted = number(client) != 0 && number(client) != 0;  // magic and version
    const std::uint32_t hello[] = {htonl(0x287617fa), htonl(0x0100)};
    if (has_greeted) send(client, hello, sizeof hello, 0);
    while (const std::uint32_t type = has_greeted ? number(client) : 0) {
      std::string name(std::min(number(client), 100U), ' ');
      take(client, name.data(), name.size());
      if (type > kPublish && type <= kUnsubscribe) continue;
      std::string data(std::min(number(client), 100'000U), ' ');
      const bool whole = take(client, data.data(), data.size()) && type == kPublish && name == "X" && !data.empty() &&
                         data.find_first_not_of(data[0]) == std::string::npos;
      messages_ = whole ? messages_ + 1 : -1;
      if (!whole) break;
    }
    close(client);
  }

  int socket_;
  std::string url_;
  std::atomic<int> messages_{0};
  std::vector<std::thread> clients_;
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

TEST(LcmBus, WithoutAServerItWaitsAndCountsWhatIsNotSent) {
  testing::internal::CaptureStderr();
  start_log("test", LogLevel::kInfo);
  LcmBus bus("tcpq://127.0.0.1:1");
  bus.subscribe("X", [](const ReceivedMessage&) {});
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 12; ++i) {
    EXPECT_TRUE(bus.handle(milliseconds(50)));
    EXPECT_FALSE(bus.publish("X", numbered(i)));
  }
  EXPECT_GE(std::chrono::steady_clock::now() - start, milliseconds(600));
  EXPECT_FALSE(bus.is_reachable());
  EXPECT_EQ(bus.unsent(), 12);
  const std::string log = testing::internal::GetCapturedStderr();
  const std::string words = "not connected to the server at 127.0.0.1:1 (Connection refused); waiting";
  EXPECT_NE(log.find(words), std::string::npos) << log;
  EXPECT_EQ(log.find(words, log.find(words) + 1), std::string::npos) << log;
}

TEST(LcmBus, AServerThatComesLaterIsFoundByWhoPublishesNothing) {
  TcpServer server(false);
  LcmBus bus(server.url());
  bus.subscribe("X", [](const ReceivedMessage&) {});
  EXPECT_TRUE(bus.handle(milliseconds(10)));
  EXPECT_FALSE(bus.is_reachable());
  server.start();
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!bus.is_reachable() && std::chrono::steady_clock::now() < end) bus.handle(milliseconds(10));
  EXPECT_TRUE(bus.is_reachable());
  EXPECT_EQ(bus.last_outage().rfind("the bus could not be reached for ", 0), 0U) << bus.last_outage();
}

TEST(LcmBus, FramesOnAnotherChannelAreNamed) {
  testing::internal::CaptureStderr();
  start_log("test", LogLevel::kInfo);
  LcmBus bus("memq://");
  int frames = 0;
  bus.subscribe_to_frames("WANTED", [&](const ReceivedMessage&) { ++frames; });
  const images_t frame = to_message(make_test_frame(1), WireFormat{}, 1);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  while (std::chrono::steady_clock::now() < end) {
    bus.publish("OTHER", frame);
    bus.publish("NO_FRAMES", numbered(1));
    for (int i = 0; i < 4; ++i) bus.handle(milliseconds(10));
  }
  bus.publish("WANTED", frame);
  for (int i = 0; i < 200 && frames == 0; ++i) bus.handle(milliseconds(10));
  EXPECT_EQ(frames, 1);
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_NE(log.find("memq://: no frame on WANTED; frames come on OTHER\n"), std::string::npos) << log;
}

constexpr int kRefused = 3;
constexpr int kNoNetworks = 77;

/// Starts a process that opens a bus in a network without any route, and ends with kRefused where that is refused.
pid_t open_without_route(AtStart at_start) {
  const pid_t child = fork();
  if (child != 0) return child;
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) _exit(kNoNetworks);
  try {
    LcmBus bus("udpm://239.255.76.67:7667?ttl=1", "", Existing::kReplaced, at_start);
  } catch (const InputError&) {
    _exit(kRefused);
  }
  _exit(0);
}

TEST(LcmBus, WithoutARouteItWaitsAndTellsTheServiceManagerSo) {
  const std::string place = testing::TempDir() + "lcm_bus_test_notify." + std::to_string(getpid());
  const int manager = socket(AF_UNIX, SOCK_DGRAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  place.copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(bind(manager, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  setenv("NOTIFY_SOCKET", place.c_str(), 1);
  const pid_t child = open_without_route(AtStart::kWait);
  unsetenv("NOTIFY_SOCKET");
  int status = 0;
  pollfd heard{manager, POLLIN, 0};
  bool has_ended = false;
  while (poll(&heard, 1, 20) == 0 && !has_ended) has_ended = waitpid(child, &status, WNOHANG) == child;
  if (has_ended && WIFEXITED(status) && WEXITSTATUS(status) == kNoNetworks) GTEST_SKIP() << "no network namespaces";
  ASSERT_FALSE(has_ended) << status;
  std::string words(100, ' ');
  words.resize(static_cast<std::size_t>(std::max<ssize_t>(recv(manager, words.data(), words.size(), 0), 0)));
  EXPECT_EQ(words, "EXTEND_TIMEOUT_USEC=60000000");
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  close(manager);
  std::filesystem::remove(place);
}

TEST(LcmBus, WithoutARouteItIsRefusedWhereThatWasAskedFor) {
  int status = 0;
  waitpid(open_without_route(AtStart::kFail), &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == kNoNetworks) GTEST_SKIP() << "no network namespaces";
  EXPECT_EQ(WEXITSTATUS(status), kRefused);
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
  bus.subscribe("X", [&](const ReceivedMessage& arrival) {
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
    fruitless.subscribe("NOTHING", [](const ReceivedMessage&) {});
    while (fruitless.handle(milliseconds(0))) {
    }
    expect_says(error_of([&] { fruitless.close(); }), {"on X (100), Y (100)"});
  }
  EXPECT_EQ(std::filesystem::file_size(output), size) << "what was there stays";

  LcmBus read_only("file://" + input.string());
  EXPECT_THROW(read_only.publish("Z", numbered(1)), InputError);
  std::filesystem::remove(input);
  std::filesystem::remove(output);
}

}  // namespace
}  // namespace houghstream
