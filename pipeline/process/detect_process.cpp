#include "pipeline/process/detect_process.hpp"

#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/process/decoded_frames.hpp"
#include "pipeline/process/detection_throttle.hpp"
#include "pipeline/process/latest_per_channel.hpp"
#include "pipeline/process/process_loop.hpp"
#include "pipeline/process/reception.hpp"

namespace houghstream {
namespace {

class DetectProcess {
 public:
  DetectProcess(LcmBus& bus, const DetectProcessOptions& options, const DetectObjects& detect)
      : bus_(bus),
        options_(options),
        detect_(detect),
        status_(options.process),
        reception_(bus, status_, options.frame_channels, options.keep_frames),
        throttle_(options.max_rate_hz) {}

  void run() {
    status_.set_known_objects(options_.objects);
    catch_stop_signals();
    reception_.subscribe_to_frames(CountedAs::kReceived, [this](const ReceivedFrame& frame) { add_frame(frame); });
    if ((options_.max_rate_hz > 0.0 || options_.on_poses) && !bus_.is_log()) {
      reception_.subscribe_to_results<object_poses_t>(channel::kPoses, CountedAs::kOther,
                                                      [this](const ReceivedResult& poses) { note_poses(poses); });
    }
    if (options_.on_camera_colours && !bus_.is_log()) {
      reception_.subscribe_to_messages<camera_colours_t>(
          channel::kCameraColours, [this](const camera_colours_t& message, const ReceivedMessage&) {
            options_.on_camera_colours(camera_colours_from_message(message));
          });
    }
    log_info("ready: frames from {} at {}", options_.frame_channels, bus_.url());
    run_process_loop(bus_, status_, [this](std::chrono::milliseconds timeout) { return step(timeout); });
    status_.count_skipped(static_cast<std::int64_t>(newest_.waiting()));
    end_process(bus_, status_);
  }

 private:
  void add_frame(const ReceivedFrame& frame) {
    if (!throttle_.is_due(frame.id) || push(frame)) status_.count_skipped(1);
  }

  /// Returns whether a frame was dropped: this one, or the one that it replaces.
  bool push(const ReceivedFrame& frame) {
    EncodedFrame encoded{frame.id, shared_copy(frame.bytes), frame.time};
    return frame.order == FrameOrder::kLate ? newest_.push_late(frame.id.channel, std::move(encoded), frame.bytes.size)
                                            : newest_.push(frame.id.channel, std::move(encoded), frame.bytes.size);
  }

  void note_poses(const ReceivedResult& result) {
    const ObjectPoses poses = poses_from_message(decode_message<object_poses_t>(result.bytes));
    if (options_.max_rate_hz > 0.0) note_losses(poses);
    if (options_.on_poses) options_.on_poses(poses);
  }

  /// Expedites the next detection of a camera on which a followed object is lost, or has become doubtful.
  void note_losses(const ObjectPoses& poses) {
    constexpr float kDoubtful = 0.5F;
    int followed = 0;
    int doubtful = 0;
    for (const ObjectPose& pose : poses.poses) {
      const bool is_lost = !has_pose(pose.status) && pose.status != PoseStatus::kOccluded;
      if (pose.detection_index < 0 && is_lost) throttle_.expedite(poses.frame.channel);
      followed += pose.detection_index < 0 ? 1 : 0;
      doubtful += pose.detection_index < 0 && has_pose(pose.status) && pose.quality < kDoubtful ? 1 : 0;
    }
    if (followed > 0) throttle_.note_doubts(poses.frame.channel, doubtful);
  }

  bool step(std::chrono::milliseconds timeout) {
    const std::optional<EncodedFrame> encoded = newest_.pop(timeout);
    if (!encoded) return false;
    try {
      const RgbdFrame frame = decode_frame({encoded->bytes->data(), encoded->bytes->size()}, encoded->id.channel,
                                           options_.camera, "detect.decode");
      Detections detections = detect_(frame);
      detections.frame = frame.id;
      bus_.publish(channel::kDetections, to_message(detections));
      status_.count_processed(std::chrono::steady_clock::now() - encoded->arrival);
    } catch (const std::exception& error) {
      status_.count_refused(error.what(), encoded->id.channel + " work");
    }
    return true;
  }

  LcmBus& bus_;
  const DetectProcessOptions& options_;
  const DetectObjects& detect_;
  StatusReporter status_;
  Reception reception_;
  LatestPerChannel<EncodedFrame> newest_;
  DetectionThrottle throttle_;
};

}  // namespace

void run_detect_process(LcmBus& bus, const DetectProcessOptions& options, const DetectObjects& detect) {
  DetectProcess(bus, options, detect).run();
}

}  // namespace houghstream
