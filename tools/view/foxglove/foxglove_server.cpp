#include "tools/view/foxglove/foxglove_server.hpp"

#define ASIO_STANDALONE
// One thread runs the handlers, and its queue has a lock; the thread sanitizer does not know fences.
#define ASIO_DISABLE_FENCED_BLOCK
#define _WEBSOCKETPP_CPP11_STL_  // NOLINT(bugprone-reserved-identifier): the library's own
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <utility>
#include <websocketpp/base64/base64.hpp>
#include <websocketpp/config/asio_no_tls.hpp>
#include <websocketpp/server.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/log_throttle.hpp"
#include "pipeline/base/printable.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/base/thread_priority.hpp"
#include "tools/foxglove/protobuf_message.hpp"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "numbers are sent as they lie in memory");

namespace houghstream::view {
namespace {

using Socket = websocketpp::server<websocketpp::config::asio>;
using Handle = websocketpp::connection_hdl;
using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;

const std::array<std::string, 2> kSubprotocols = {"foxglove.websocket.v1", "foxglove.sdk.v1"};
constexpr std::size_t kMaxRequestBytes = std::size_t{256} << 10U;
constexpr std::size_t kMaxSubscriptions = 2 * FoxgloveServer::kMaxTopics;
constexpr std::size_t kLastingFactor = 4;  // so many times more may wait for a client with what must not be lost
constexpr std::chrono::milliseconds kCloseTimeout(200);

/// One connection.
struct Client {
  std::map<std::uint32_t, std::size_t> subscriptions;  // channel by the client's number
  std::int64_t dropped = 0;
  std::int64_t dropped_told = 0;
  Clock::time_point told;
};

/// One topic.
struct Topic {
  std::string name;
  std::string type;
  std::optional<std::string> last;  // the last message of a topic whose messages hold until the next one
};

bool is_lasting(const std::string& type) {
  return type == "foxglove.SceneUpdate";
}

Json describe_topic(std::size_t number, const Topic& topic) {
  const std::string schema = foxglove::encode_descriptor(topic.type);
  return {{"id", number},
          {"topic", topic.name},
          {"encoding", "protobuf"},
          {"schemaName", topic.type},
          {"schema", websocketpp::base64_encode(schema)},
          {"schemaEncoding", "protobuf"}};
}

/// Returns a message as it is sent to one subscription: opcode, number of the subscription, time, data.
std::string frame_data(std::uint32_t subscription, std::string_view data) {
  constexpr char kMessageData = 1;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto time = static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
  std::string bytes(1 + sizeof subscription + sizeof time, kMessageData);
  std::memcpy(bytes.data() + 1, &subscription, sizeof subscription);
  std::memcpy(bytes.data() + 1 + sizeof subscription, &time, sizeof time);
  return bytes.append(data);
}

/// Returns what a client asks for, or a value that is no object where that is no JSON, or nested too deep.
Json parse_request(const std::string& text) {
  try {
    check_json_nesting(text, "request");
  } catch (const InputError&) {
    return {};  // the client is told that it is no request
  }
  return Json::parse(text, nullptr, false);
}

/// Returns a list of numbers of 32 bits; others are left out.
std::vector<std::uint32_t> numbers_in(const Json& list) {
  std::vector<std::uint32_t> numbers;
  if (!list.is_array()) return numbers;
  for (const Json& entry : list) {
    if (entry.is_number_unsigned() && entry.get<std::uint64_t>() <= UINT32_MAX) numbers.push_back(entry);
  }
  return numbers;
}

/// Returns whether a browser may connect from a page of this origin. What is no website, as Foxglove's desktop program,
/// may: it can do as it likes anyhow.
bool admits_origin(const HttpAddress& address, const std::string& origin) {
  const std::size_t colon = origin.find("://");
  const std::string scheme = origin.substr(0, colon);
  if (scheme != "http" && scheme != "https") return true;
  const std::string host = origin.substr(std::min(colon + 3, origin.size()));
  return (scheme == "https" && (host == "app.foxglove.dev" || host == "studio.foxglove.dev")) ||
         answers_to(address, host);
}

}  // namespace

// All functions of State but open() run in its thread, and so do the handlers of the socket: nothing of it is shared
// but what is atomic.
struct FoxgloveServer::State {
  State(const HttpAddress& where, std::size_t bytes) : address(where), waiting_bytes(bytes) {}

  void open();
  bool accept(const Handle& handle);
  void greet(const Handle& handle);
  void forget(const Handle& handle);
  void take_request(const Handle& handle, const std::string& text);
  void subscribe(const Handle& handle, Client& client, const Json& request);
  void publish(const foxglove::FoxgloveMessage& message);
  void end_clients();
  void send_text(const Handle& handle, const Json& json);
  void send_status(const Handle& handle, const std::string& words);
  void send_data(const Handle& handle, Client& client, std::uint32_t subscription, std::string_view data);
  void drop(const Handle& handle, Client& client);
  std::optional<std::size_t> find_topic(const foxglove::FoxgloveMessage& message);

  HttpAddress address;
  std::size_t waiting_bytes;
  Socket socket;
  std::thread thread;
  std::map<Handle, Client, std::owner_less<Handle>> clients;
  std::vector<Topic> topics;
  std::map<std::string, std::size_t> topic_numbers;
  LogThrottle complaints;
  std::atomic<std::size_t> client_count{0};
  std::atomic<std::size_t> posted_bytes{0};  // of messages that wait for the thread
  std::atomic<std::int64_t> dropped{0};
};

void FoxgloveServer::State::open() {
  socket.clear_access_channels(websocketpp::log::alevel::all);
  socket.clear_error_channels(websocketpp::log::elevel::all);
  socket.init_asio();
  socket.set_reuse_addr(true);
  socket.set_max_message_size(kMaxRequestBytes);
  socket.set_validate_handler([this](const Handle& handle) { return accept(handle); });
  socket.set_open_handler([this](const Handle& handle) { greet(handle); });
  socket.set_close_handler([this](const Handle& handle) { forget(handle); });
  socket.set_message_handler([this](const Handle& handle, const Socket::message_ptr& message) {
    if (message->get_opcode() == websocketpp::frame::opcode::text) take_request(handle, message->get_payload());
  });
  socket.set_http_handler([this](const Handle& handle) {
    const auto connection = socket.get_con_from_hdl(handle);
    connection->set_status(websocketpp::http::status_code::upgrade_required);
    connection->set_body("This is a WebSocket for Foxglove: open a connection to it there.\n");
  });
  websocketpp::lib::error_code error;
  socket.listen(address.host, std::to_string(address.port), error);
  require(!error, "--foxglove {}:{}: {}", address.host, address.port, error.message());
  websocketpp::lib::asio::error_code unknown;
  address.port = socket.get_local_endpoint(unknown).port();
  socket.start_accept(error);
  require(!error, "--foxglove {}:{}: {}", address.host, address.port, error.message());
}

/// Returns whether a client may connect, before it does.
bool FoxgloveServer::State::accept(const Handle& handle) {
  const auto connection = socket.get_con_from_hdl(handle);
  const auto refuse = [&](websocketpp::http::status_code::value status, const std::string& words) {
    connection->set_status(status);
    connection->set_body(words + "\n");
    const std::string line =
        fmt::format("Foxglove at {} is refused: {}", connection->get_remote_endpoint(), printable(words));
    if (const auto admitted = complaints.admit("refused", line, Clock::now())) log_warning("{}", *admitted);
    return false;
  };
  const std::string origin = connection->get_request_header("Origin");
  if (!admits_origin(address, origin))
    return refuse(websocketpp::http::status_code::forbidden,
                  "a page of " + origin + " may not connect; for its name start hs-view with --http-host NAME");
  const std::vector<std::string>& offered = connection->get_requested_subprotocols();
  const auto known = std::find_if(kSubprotocols.begin(), kSubprotocols.end(), [&](const std::string& protocol) {
    return std::count(offered.begin(), offered.end(), protocol) > 0;
  });
  if (known == kSubprotocols.end())
    return refuse(websocketpp::http::status_code::bad_request, "expected the subprotocol " + kSubprotocols[0]);
  if (clients.size() >= kMaxClients)
    return refuse(websocketpp::http::status_code::service_unavailable,
                  fmt::format("{} clients are connected already", clients.size()));
  connection->select_subprotocol(*known);
  return true;
}

void FoxgloveServer::State::greet(const Handle& handle) {
  clients[handle];
  client_count = clients.size();
  send_text(handle, {{"op", "serverInfo"},
                     {"name", "hs-view"},
                     {"capabilities", Json::array()},
                     {"metadata", Json::object()},
                     {"sessionId", fmt::format("{}-{}", getpid(), address.port)}});
  Json channels = Json::array();
  for (std::size_t i = 0; i < topics.size(); ++i) channels.push_back(describe_topic(i, topics[i]));
  send_text(handle, {{"op", "advertise"}, {"channels", channels}});
}

void FoxgloveServer::State::forget(const Handle& handle) {
  const auto client = clients.find(handle);
  if (client == clients.end()) return;
  if (client->second.dropped > 0)
    log_warning("a client of Foxglove that reads too slowly has lost {} messages", client->second.dropped);
  clients.erase(client);
  client_count = clients.size();
}

void FoxgloveServer::State::take_request(const Handle& handle, const std::string& text) {
  const Json request = parse_request(text);
  const auto client = clients.find(handle);
  if (client == clients.end()) return;
  const std::string op = request.is_object() && request.contains("op") && request["op"].is_string()
                             ? request["op"].get<std::string>()
                             : "";
  if (op == "subscribe" && request.contains("subscriptions")) {
    subscribe(handle, client->second, request["subscriptions"]);
  } else if (op == "unsubscribe" && request.contains("subscriptionIds")) {
    for (const std::uint32_t number : numbers_in(request["subscriptionIds"]))
      client->second.subscriptions.erase(number);
  } else {
    send_status(handle, "hs-view takes the requests subscribe and unsubscribe");
  }
}

void FoxgloveServer::State::subscribe(const Handle& handle, Client& client, const Json& request) {
  if (!request.is_array()) return;
  for (const Json& entry : request) {
    if (!entry.is_object()) continue;
    const std::vector<std::uint32_t> numbers =
        numbers_in({entry.value("id", Json()), entry.value("channelId", Json())});
    if (numbers.size() != 2 || numbers[1] >= topics.size() || client.subscriptions.size() >= kMaxSubscriptions) {
      send_status(handle, "a subscription names no channel of hs-view");
      continue;
    }
    client.subscriptions[numbers[0]] = numbers[1];
    const Topic& topic = topics[numbers[1]];
    if (topic.last) send_data(handle, client, numbers[0], *topic.last);
  }
}

// A connection that has just gone takes nothing, and its close handler follows: such errors need no answer.
void FoxgloveServer::State::send_text(const Handle& handle, const Json& json) {
  websocketpp::lib::error_code gone;
  socket.send(handle, json.dump(-1, ' ', false, Json::error_handler_t::replace), websocketpp::frame::opcode::text,
              gone);
}

void FoxgloveServer::State::send_status(const Handle& handle, const std::string& words) {
  constexpr int kWarning = 1;
  send_text(handle, {{"op", "status"}, {"level", kWarning}, {"message", words}});
}

void FoxgloveServer::State::send_data(const Handle& handle, Client& client, std::uint32_t subscription,
                                      std::string_view data) {
  websocketpp::lib::error_code gone;
  const auto connection = socket.get_con_from_hdl(handle, gone);
  if (gone) return;
  const std::size_t waiting = connection->get_buffered_amount() + data.size();
  const bool lasts = is_lasting(topics[client.subscriptions[subscription]].type);
  if (lasts && waiting > kLastingFactor * waiting_bytes) {
    connection->close(websocketpp::close::status::try_again_later, "the connection is too slow", gone);
  } else if (!lasts && waiting > waiting_bytes) {
    drop(handle, client);
  } else {
    connection->send(frame_data(subscription, data), websocketpp::frame::opcode::binary);
  }
}

void FoxgloveServer::State::publish(const foxglove::FoxgloveMessage& message) {
  const std::optional<std::size_t> number = find_topic(message);
  if (!number) return;
  if (is_lasting(message.type)) topics[*number].last = message.data;
  for (auto& [handle, client] : clients) {
    for (const auto& [subscription, wanted] : client.subscriptions) {
      if (wanted == *number) send_data(handle, client, subscription, message.data);
    }
  }
}

void FoxgloveServer::State::end_clients() {
  websocketpp::lib::error_code unasked;
  socket.stop_listening(unasked);
  for (const auto& [handle, client] : clients)
    socket.close(handle, websocketpp::close::status::going_away, "hs-view ends", unasked);
}

void FoxgloveServer::State::drop(const Handle& handle, Client& client) {
  ++client.dropped;
  ++dropped;
  const Clock::time_point now = Clock::now();
  if (now - client.told < std::chrono::seconds(1)) return;
  send_status(handle, fmt::format("{} messages were dropped: the connection is too slow",
                                  client.dropped - client.dropped_told));
  client.told = now;
  client.dropped_told = client.dropped;
}

std::optional<std::size_t> FoxgloveServer::State::find_topic(const foxglove::FoxgloveMessage& message) {
  const auto known = topic_numbers.find(message.topic);
  if (known != topic_numbers.end()) return known->second;
  if (topics.size() >= kMaxTopics) return std::nullopt;
  topics.push_back({message.topic, message.type, std::nullopt});
  const std::size_t number = topic_numbers[message.topic] = topics.size() - 1;
  const Json channels = Json::array({describe_topic(number, topics.back())});
  for (const auto& [handle, client] : clients) send_text(handle, {{"op", "advertise"}, {"channels", channels}});
  return number;
}

FoxgloveServer::FoxgloveServer(const HttpAddress& address, std::size_t waiting_bytes)
    : state_(std::make_unique<State>(address, waiting_bytes)) {
  const std::string problem = listening_problem(address);
  require(problem.empty(), "--foxglove {}:{}: {}", address.host, address.port, problem);
  state_->open();
  const BlockStopSignals block;
  state_->thread = std::thread([state = state_.get()] {
    yield_to_results("serving Foxglove");
    state->socket.run();
  });
}

FoxgloveServer::~FoxgloveServer() {
  websocketpp::lib::asio::post(state_->socket.get_io_service(), [state = state_.get()] { state->end_clients(); });
  const Clock::time_point end = Clock::now() + kCloseTimeout;
  while (has_clients() && Clock::now() < end) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  state_->socket.stop();
  state_->thread.join();
}

int FoxgloveServer::port() const {
  return state_->address.port;
}

std::vector<std::string> FoxgloveServer::urls() const {
  const std::string& host = state_->address.host;
  std::vector<std::string> hosts = network_addresses(host);
  if (hosts.empty()) hosts.push_back(is_local(host) ? "localhost" : host);
  std::vector<std::string> urls;
  for (const std::string& name : hosts) {
    const bool is_ipv6 = name.find(':') != std::string::npos;
    urls.push_back(fmt::format("ws://{}:{}", is_ipv6 ? "[" + name + "]" : name, port()));
  }
  return urls;
}

bool FoxgloveServer::has_clients() const {
  return state_->client_count > 0;
}

void FoxgloveServer::publish(foxglove::FoxgloveMessage message) {
  const std::size_t size = message.data.size();
  if (!is_lasting(message.type) && state_->posted_bytes + size > kLastingFactor * state_->waiting_bytes) {
    ++state_->dropped;  // the thread itself is late
    return;
  }
  state_->posted_bytes += size;
  websocketpp::lib::asio::post(state_->socket.get_io_service(),
                               [state = state_.get(), size, message = std::move(message)] {
                                 state->posted_bytes -= size;
                                 state->publish(message);
                               });
}

std::int64_t FoxgloveServer::dropped() const {
  return state_->dropped;
}

}  // namespace houghstream::view
