#pragma once

#include <functional>
#include <thread>
#include <vector>

#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "tests/pipeline/test_frame.hpp"
#include "tools/view/bus_watcher.hpp"

namespace houghstream::view {

/// An in-process bus with a watcher that draws every frame, as the processes of a stream would see it.
struct WatchedBus {
  WatchedBus() = default;
  explicit WatchedBus(std::string pattern) : channels(std::move(pattern)) {}

  static MatchSettings every_frame() {
    MatchSettings match;
    match.rate_hz = 1000.0;
    return match;
  }

  void publish_frame(std::int64_t utime, const std::string& camera = channel::kFrame) {
    bus.publish(camera, to_message(make_test_frame(utime), WireFormat{}, utime - 1));
  }

  /// Results of a detector of this object and of hs-pose for a frame.
  void publish_results(const FrameId& frame, const std::string& object = "bowl") {
    Detections detections;
    detections.frame = frame;
    detections.detections.resize(1);
    detections.detections[0].class_id = 1;
    detections.detections[0].class_name = object;
    detections.detections[0].box_px = {10.0F, 10.0F, 20.0F, 20.0F};
    bus.publish(channel::kDetections, to_message(detections));
    ObjectPoses poses;
    poses.frame = frame;
    poses.poses.resize(1);
    poses.poses[0].class_name = object;
    poses.poses[0].detection_index = 0;
    poses.poses[0].status = PoseStatus::kNotConverged;
    bus.publish(channel::kPoses, to_message(poses));
  }
  void publish_results(std::int64_t utime) { publish_results({channel::kFrame, utime}); }

  std::optional<MatchedFrame> next() { return watcher.next(std::chrono::seconds(10)); }

  /// Waits until it holds; false after ten seconds.
  static bool comes_true(const std::function<bool()>& condition) {
    for (int i = 0; i < 1000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return condition();
  }

  /// Returns the summary of hs-view at its end.
  status_t last_words() {
    std::optional<status_t> last;
    watcher.stop();  // from here on this thread receives
    bus.subscribe(channel::kStatus,
                  [&](const ReceivedMessage& arrival) { last = decode_message<status_t>(arrival.bytes); });
    watcher.finish();
    while (!last && bus.handle(std::chrono::milliseconds(1000))) {
    }
    return last.value_or(status_t{});
  }

  LcmBus bus{"memq://"};
  std::string channels = channel::kFrame;
  BusWatcher watcher{bus, channels, every_frame(), 10};
};

/// Returns the encoded message of a frame, with nothing found in it.
inline MatchedFrame matched_frame(std::int64_t utime) {
  MatchedFrame matched;
  matched.id = {channel::kFrame, utime};
  matched.frame_bytes = encode_message(to_message(make_test_frame(utime), WireFormat{}, 0));
  return matched;
}

/// Returns a frame as a third-party program sends it: without a camera.
inline MatchedFrame matched_frame_without_camera(std::int64_t utime) {
  images_t message = to_message(make_test_frame(utime), WireFormat{}, 0);
  for (image_t& image : message.images) {
    image.metadata.clear();
    image.nmetadata = 0;
  }
  MatchedFrame matched;
  matched.id = {channel::kFrame, utime};
  matched.frame_bytes = encode_message(message);
  return matched;
}

}  // namespace houghstream::view
