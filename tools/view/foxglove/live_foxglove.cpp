#include "tools/view/foxglove/live_foxglove.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/base/thread_priority.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/placed_objects_message.hpp"
#include "pipeline/messages/wire_check.hpp"

namespace houghstream::view {
namespace {

constexpr std::size_t kMaxWaiting = 1000;  // messages; of each camera one frame at most
constexpr std::size_t kMaxWaitingBytes = std::size_t{192} << 20U;
constexpr std::chrono::milliseconds kPollInterval(100);
const std::string kCameraPoses = ".*_TO_WORLD";

HttpAddress address_of(const LiveFoxgloveSettings& settings) {
  HttpAddress address = parse_http_address(settings.address, "--foxglove");
  for (const std::string& name : settings.names) address.names.push_back(parse_host_name(name));
  return address;
}

}  // namespace

LiveFoxglove::LiveFoxglove(LcmBus& bus, const LiveFoxgloveSettings& settings, ModelSource models)
    : frame_channels_(settings.frame_channels),
      server_(address_of(settings)),
      conversion_(settings.camera),
      model_source_(std::move(models)) {
  log_info("Foxglove: open a connection to {}", fmt::join(server_.urls(), " or "));
  const auto note = [this](const ReceivedMessage& message) { push(message); };
  for (const std::string& channel : {settings.frame_channels, channel::kDetections, channel::kPoses,
                                     channel::kPlacedObjects, channel::kObjects, kCameraPoses})
    bus.subscribe(channel, note);
  const BlockStopSignals block;
  thread_ = std::thread([this] { run(); });
}

LiveFoxglove::~LiveFoxglove() {
  is_ending_ = true;
  filled_.notify_one();
  thread_.join();
  if (passed_over_ > 0 || server_.dropped() > 0)
    log_info("Foxglove: {} messages were passed over here, {} on connections that are too slow", passed_over_,
             server_.dropped());
}

void LiveFoxglove::push(const ReceivedMessage& message) {
  const bool is_frame = is_frame_message(message.bytes);
  const std::size_t size = message.bytes.size;
  if (!server_.has_clients() || (!is_frame && size > Reception::kMaxResultBytes)) return;
  Waiting item{message.channel, shared_copy(message.bytes), is_frame, {}};
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto older = std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& other) {
      return is_frame && other.is_frame && other.channel == item.channel;
    });
    const std::size_t before = waiting_.size();
    if (older != waiting_.end()) waiting_.erase(older);
    while (!waiting_.empty() && (waiting_.size() >= kMaxWaiting || bytes_.total() + size > kMaxWaitingBytes))
      waiting_.pop_front();
    passed_over_ += static_cast<std::int64_t>(before - waiting_.size());
    item.reservation = bytes_.reserve(size);
    waiting_.push_back(std::move(item));
  }
  filled_.notify_one();
}

std::optional<LiveFoxglove::Waiting> LiveFoxglove::pop() {
  std::unique_lock<std::mutex> lock(mutex_);
  filled_.wait_for(lock, kPollInterval, [this] { return is_ending_ || !waiting_.empty(); });
  if (waiting_.empty()) return std::nullopt;
  Waiting item = std::move(waiting_.front());
  item.reservation = {};
  waiting_.pop_front();
  return item;
}

void LiveFoxglove::update_models() {
  const std::shared_ptr<const ClassModels> models = model_source_();
  if (models == models_) return;
  models_ = models;
  if (models_) conversion_.set_models(*models_);
}

LiveConversion::Messages LiveFoxglove::convert(const Waiting& waiting) {
  const ByteView bytes{waiting.bytes->data(), waiting.bytes->size()};
  if (waiting.is_frame) return conversion_.add_frame(decode_message<images_t>(bytes), waiting.channel);
  if (waiting.channel == channel::kDetections)
    return conversion_.add_detections(detections_from_message(decode_message<detections_t>(bytes)));
  if (waiting.channel == channel::kPoses)
    return conversion_.add_poses(poses_from_message(decode_message<object_poses_t>(bytes)));
  if (waiting.channel == channel::kObjects)
    return conversion_.add_world(world_from_message(decode_message<objects_t>(bytes)));
  if (waiting.channel == channel::kPlacedObjects) {
    conversion_.add_placements(placed_objects_from_message(decode_message<placed_objects_t>(bytes)));
    return {};
  }
  if (frame_channels_.matches(waiting.channel)) return {};  // an expression may match what is no frame
  const auto message = decode_message<rigid_transform_t>(bytes);
  return conversion_.add_camera_pose(waiting.channel, message.utime, transform_from_message(message));
}

void LiveFoxglove::run() {
  yield_to_results("converting for Foxglove");
  while (!is_ending_) {
    try {
      if (server_.has_clients()) update_models();
      const std::optional<Waiting> waiting = pop();
      if (!waiting) continue;
      for (foxglove::FoxgloveMessage& message : convert(*waiting)) server_.publish(std::move(message));
    } catch (const std::exception& error) {  // OpenCV's too: no message may end the program
      const auto admitted = complaints_.admit("foxglove", error.what(), LogThrottle::Clock::now());
      if (admitted) log_error("for Foxglove: {}", *admitted);
    }
  }
}

}  // namespace houghstream::view
