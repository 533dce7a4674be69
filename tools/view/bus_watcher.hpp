#pragma once

#include <atomic>
#include <chrono>
#include <houghstream/pose_probabilities_t.hpp>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <thread>

#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/process/process_loop.hpp"
#include "pipeline/process/reception.hpp"
#include "tools/common/last_messages.hpp"
#include "tools/view/drawing/stream_watch.hpp"
#include "tools/view/frame_matcher.hpp"

namespace houghstream::view {

/// Listens to frames, detections and poses in a thread of its own, so that slow drawing never delays receiving.
class BusWatcher {
 public:
  /// Starts to listen to `bus`, which must outlive it. `frame_channels` is a ChannelPattern; of several cameras one is
  /// shown at a time. `waiting_frames` may queue up to be drawn. Throws InputError where the network cannot be used, or
  /// where it is a log.
  BusWatcher(LcmBus& bus, const std::string& frame_channels, const MatchSettings& match, std::size_t waiting_frames);
  ~BusWatcher();
  BusWatcher(const BusWatcher&) = delete;
  BusWatcher& operator=(const BusWatcher&) = delete;

  /// Returns the next frame to draw, or nothing when none comes within `timeout`.
  std::optional<MatchedFrame> next(std::chrono::milliseconds timeout) { return queue_.pop(timeout); }

  /// Note the outcome of a frame that was popped, for the status that is published once a second.
  void note_drawn(const MatchedFrame& frame);
  void note_refused(const std::string& reason) { status_.count_refused(reason); }
  void note_skipped() { status_.count_skipped(1); }
  /// Something about a frame that was drawn all the same.
  void note_trouble(const std::string& reason) { status_.note_bad_message(reason); }

  /// Returns the camera whose frames are shown; frames of the others are skipped.
  SelectedCamera& cameras() { return cameras_; }

  /// Returns the rates of the shown camera, and the statuses of the processes.
  StreamState stream_state();
  std::int64_t frames_lost() const { return status_.message().frames_lost; }

  /// Sends an image to those for whom frames are too large.
  void publish_preview(const cv::Mat& image, std::int64_t utime);

  /// Stops listening; frames that wait can still be taken.
  void stop();

  /// Logs the account of received, drawn and skipped frames at the end.
  void finish() { end_process(bus_, status_); }

 private:
  void subscribe_to_results();
  void subscribe_to_status();
  void subscribe_to_teaching();
  void subscribe_to_colours();
  void subscribe_to_world();
  void add_frame(const ReceivedFrame& frame);
  void listen();
  void hand_over();

  LcmBus& bus_;
  StatusReporter status_{"hs-view"};
  Reception reception_;
  SelectedCamera cameras_;
  FrameMatcher matcher_;
  LastMessages<pose_probabilities_t> probabilities_;  // come before their poses
  std::int64_t passed_over_told_ = 0;                 // skipped frames of the matcher that the status has counted
  StreamWatch stream_;
  MatchedFrameQueue queue_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace houghstream::view
