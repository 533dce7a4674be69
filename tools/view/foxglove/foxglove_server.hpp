#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tools/foxglove/foxglove_messages.hpp"
#include "tools/view/http/http_address.hpp"

namespace houghstream::view {

/// Serves messages to Foxglove over WebSockets (subprotocol foxglove.websocket.v1,
/// https://github.com/foxglove/ws-protocol, and its successor foxglove.sdk.v1, of which this is a part), in a thread of
/// its own and of low priority. Each topic is a channel, which is advertised when its first message comes. A client
/// that subscribes to a topic of scene updates gets the last one first, since a model is sent once.
///
/// A client that reads too slowly loses messages of images and boxes, which are counted, and it is told; one that
/// cannot even take the scene updates is closed. A browser may connect from Foxglove's pages, from pages of this
/// machine and of the names in the address; other websites are refused. Any function may be called from any thread.
class FoxgloveServer {
 public:
  /// Maximum number of clients, of topics, and of bytes that may wait for one client.
  static constexpr std::size_t kMaxClients = 16;
  static constexpr std::size_t kMaxTopics = 1000;
  static constexpr std::size_t kWaitingBytes = std::size_t{16} << 20U;

  /// Listens. Throws InputError where that address cannot be listened at.
  explicit FoxgloveServer(const HttpAddress& address, std::size_t waiting_bytes = kWaitingBytes);
  /// Closes all connections, within a quarter of a second.
  ~FoxgloveServer();
  FoxgloveServer(const FoxgloveServer&) = delete;
  FoxgloveServer& operator=(const FoxgloveServer&) = delete;

  int port() const;
  /// Returns the addresses that Foxglove is given, "ws://...": of this machine, or of each of its networks.
  std::vector<std::string> urls() const;

  bool has_clients() const;

  /// Sends a message to those who have subscribed to its topic, and returns before it is sent. One topic too many is
  /// passed over.
  void publish(foxglove::FoxgloveMessage message);

  /// Returns the number of messages that slow clients have lost, or that this machine was too busy to send.
  std::int64_t dropped() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace houghstream::view
