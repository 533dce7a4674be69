#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <functional>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "tests/pipeline/test_frame.hpp"

namespace houghstream {

/// Runs a process in a thread on an in-process bus, and stops it as a user does: with SIGTERM.
class ProcessOnMemq {
 public:
  explicit ProcessOnMemq(const std::vector<std::string>& watched) {
    catch_stop_signals();
    for (const std::string& name : watched) {
      bus.subscribe(name, [this, name](const ReceivedMessage& arrival) {
        const std::lock_guard<std::mutex> lock(mutex_);
        seen_[name].push_back({arrival.bytes.data, arrival.bytes.data + arrival.bytes.size});
      });
    }
  }

  ~ProcessOnMemq() {
    if (thread_.joinable()) stop();
  }

  void start(const std::function<void(LcmBus&)>& process) {
    thread_ = std::thread([this, process] { process(bus); });
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // until it has subscribed
  }

  std::size_t count(const std::string& name) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return seen_[name].size();
  }

  template <typename Message>
  Message at(const std::string& name, std::size_t index) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::vector<std::uint8_t>& bytes = seen_[name].at(index);
    return decode_message<Message>({bytes.data(), bytes.size()});
  }

  template <typename Message>
  Message last(const std::string& name) {
    return at<Message>(name, count(name) - 1);
  }

  /// Returns a message of a type that this project sends and never reads.
  template <typename Message>
  Message only_sent(const std::string& name, std::size_t index) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::vector<std::uint8_t>& bytes = seen_[name].at(index);
    Message message{};
    EXPECT_EQ(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size())) << name;
    return message;
  }

  /// Waits until that many messages have come on the channel; false after two seconds.
  bool wait_for(const std::string& name, std::size_t messages) {
    for (int i = 0; i < 400 && count(name) < messages; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return count(name) >= messages;
  }

  /// Milliseconds that the process took to end.
  double stop() {
    const auto start = std::chrono::steady_clock::now();
    std::raise(SIGTERM);
    thread_.join();
    // The process' own receiver has ended; its last message waits in the queue.
    bus.handle(std::chrono::milliseconds(50));
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }

  LcmBus bus{"memq://"};

 private:
  std::mutex mutex_;
  std::map<std::string, std::vector<std::vector<std::uint8_t>>> seen_;
  std::thread thread_;
};

/// Detections of a frame with a bowl.
inline Detections one_bowl(std::int64_t utime, const std::string& camera = channel::kFrame) {
  Detection bowl;
  bowl.class_id = 1;
  bowl.class_name = "bowl";
  bowl.box_px = {1, 2, 3, 4};
  Detections detections;
  detections.frame = {camera, utime};
  detections.detections = {bowl};
  return detections;
}

}  // namespace houghstream
