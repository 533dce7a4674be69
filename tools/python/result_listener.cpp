#include "tools/python/result_listener.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include "pipeline/base/stop_signal.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/placed_objects_message.hpp"
#include "pipeline/process/reception.hpp"
#include "pipeline/types/frame_results.hpp"
#include "tools/common/last_messages.hpp"

namespace houghstream {
namespace {

/// Results that wait to be popped: from a network those of a camera's newest frame, which several processes may have
/// published; from a log all.
class ResultQueue {
 public:
  explicit ResultQueue(bool keeps_all) : keeps_all_(keeps_all) {}

  void push(const std::string& kind, const FrameId& frame, StreamResult result) {
    constexpr std::size_t kMaxWaiting = 256;  // a sender of rubbish may make up cameras
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!keeps_all_) {
      waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(),
                                    [&](const Waiting& waiting) {
                                      return waiting.kind == kind && waiting.frame.channel == frame.channel &&
                                             waiting.frame.utime != frame.utime;
                                    }),
                     waiting_.end());
      if (waiting_.size() >= kMaxWaiting) waiting_.pop_front();
    }
    waiting_.push_back({kind, frame, std::move(result)});
    filled_.notify_one();
  }

  void fail(std::exception_ptr failure) {
    const std::lock_guard<std::mutex> lock(mutex_);
    failure_ = std::move(failure);
    filled_.notify_one();
  }

  /// Returns the oldest result; throws the failure where nothing waits.
  std::optional<StreamResult> pop(std::chrono::milliseconds timeout) {
    std::unique_lock<std::mutex> lock(mutex_);
    filled_.wait_for(lock, timeout, [this] { return !waiting_.empty() || failure_ != nullptr; });
    if (waiting_.empty() && failure_ != nullptr) std::rethrow_exception(failure_);
    if (waiting_.empty()) return std::nullopt;
    StreamResult result = std::move(waiting_.front().result);
    waiting_.pop_front();
    return result;
  }

  bool is_empty() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return waiting_.empty();
  }

 private:
  struct Waiting {
    std::string kind;  // channel of the result
    FrameId frame;
    StreamResult result;
  };

  bool keeps_all_;
  mutable std::mutex mutex_;
  std::condition_variable filled_;
  std::deque<Waiting> waiting_;
  std::exception_ptr failure_;
};

}  // namespace

struct ResultListener::State {
  explicit State(const ListenOptions& options)
      : bus(options.url, "", Existing::kReplaced, AtStart::kFail),
        reception(bus, status, options.cameras),
        results(bus.is_log()) {
    if (options.poses) subscribe_to_poses();
    if (options.objects) subscribe_to_objects();
  }

  void subscribe_to_objects() {
    reception.subscribe_to_messages<placed_objects_t>(channel::kPlacedObjects,
                                                      [this](const placed_objects_t& message, const ReceivedMessage&) {
                                                        placed.add(placed_objects_from_message(message));
                                                      });
    reception.subscribe_to_results<objects_t>(
        channel::kObjects, CountedAs::kOther, [this](const ReceivedResult& result) {
          PlacedWorld placed_world{world_from_message(decode_message<objects_t>(result.bytes)), std::nullopt};
          const WorldObjects& world = placed_world.world;
          const ObjectPlacements* known = placed.find([&](const ObjectPlacements& other) {
            return other.frame == world.frame && other.world == world.world && other.world_number == world.world_number;
          });
          if (known != nullptr) placed_world.placed = *known;
          results.push(channel::kObjects, result.id, std::move(placed_world));
        });
  }

  void subscribe_to_poses() {
    reception.subscribe_to_results<detections_t>(
        channel::kDetections, CountedAs::kOther, [this](const ReceivedResult& result) {
          detections.add(detections_from_message(decode_message<detections_t>(result.bytes)));
        });
    reception.subscribe_to_messages<pose_probabilities_t>(
        channel::kPoseProbabilities,
        [this](const pose_probabilities_t& message, const ReceivedMessage&) { probabilities.add(message); });
    reception.subscribe_to_results<object_poses_t>(
        channel::kPoses, CountedAs::kOther, [this](const ReceivedResult& result) {
          PosedDetections posed{poses_from_message(decode_message<object_poses_t>(result.bytes)), std::nullopt};
          probabilities.find([&](const auto& message) { return apply_probabilities(message, posed.poses); });
          const Detections* answered =
              detections.find([&](const Detections& other) { return is_result_of(posed.poses, other); });
          if (answered != nullptr) posed.detections = *answered;
          results.push(channel::kPoses, result.id, std::move(posed));
        });
  }

  void receive() {
    constexpr std::chrono::milliseconds kTimeout(50);
    try {
      while (!stopping) bus.handle(kTimeout);
    } catch (...) {
      results.fail(std::current_exception());
    }
  }

  StatusReporter status{"listener"};  // counts and logs what is refused; nothing of it is published
  LcmBus bus;
  Reception reception;
  LastMessages<Detections> detections;
  LastMessages<pose_probabilities_t> probabilities;
  LastMessages<ObjectPlacements> placed;
  ResultQueue results;
  bool log_has_ended = false;
  std::atomic<bool> stopping{false};
  std::thread receiver;  // receives from a network
};

ResultListener::ResultListener(const ListenOptions& options) : state_(std::make_unique<State>(options)) {
  if (state_->bus.is_log()) return;
  const BlockStopSignals block;  // signals are for the threads of the program
  state_->receiver = std::thread([this] { state_->receive(); });
}

ResultListener::~ResultListener() {
  state_->stopping = true;
  if (state_->receiver.joinable()) state_->receiver.join();
}

std::optional<StreamResult> ResultListener::next(std::chrono::milliseconds timeout) {
  if (!state_->bus.is_log()) return state_->results.pop(timeout);
  const auto until = std::chrono::steady_clock::now() + timeout;
  while (state_->results.is_empty() && !state_->log_has_ended && std::chrono::steady_clock::now() < until) {
    state_->log_has_ended = !state_->bus.handle(timeout);
  }
  return state_->results.pop(std::chrono::milliseconds(0));
}

bool ResultListener::has_ended() const {
  return state_->log_has_ended && state_->results.is_empty();
}

}  // namespace houghstream
