#include "pipeline/process/follow_process.hpp"

#include <unistd.h>

#include <atomic>
#include <memory>
#include <thread>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/process/frame_synchroniser.hpp"
#include "pipeline/process/latest_per_channel.hpp"
#include "pipeline/process/model_check.hpp"
#include "pipeline/process/pose_output.hpp"
#include "pipeline/process/process_loop.hpp"
#include "pipeline/process/recent_frames.hpp"

namespace houghstream {
namespace {

using std::chrono::milliseconds;

struct EncodedFrame {
  FrameId id;
  SharedBytes bytes;
  std::chrono::steady_clock::time_point arrival;
};

class FollowProcess {
 public:
  FollowProcess(LcmBus& bus, const PoseProcessOptions& options, const FollowPoses& poses)
      : bus_(bus),
        options_(options),
        poses_(poses),
        channels_(options.frame_channels),
        status_(options.process),
        detections_(!bus.is_log(), false),
        models_(options.models),
        transforms_(bus, options.frame_channels) {}

  void run() {
    status_.set_known_objects(options_.objects);
    catch_stop_signals();
    bus_.subscribe_to_frames(options_.frame_channels,
                             [this](const ReceivedMessage& arrival) { receive_frame(arrival); });
    bus_.subscribe(channel::kDetections, [this](const ReceivedMessage& arrival) { receive_detections(arrival); });
    log_info("ready: follows in frames from {}, detections from {} at {}", options_.frame_channels,
             channel::kDetections, bus_.url());
    if (bus_.is_log()) {
      run_process_loop(bus_, status_,
                       [this](milliseconds) { return follow_newest(milliseconds(0)) || answer_next(milliseconds(0)); });
    } else {
      run_live();
    }
    status_.count_skipped(static_cast<std::int64_t>(frames_.waiting()));
    warn(models_.at_end());
    if (looks_ > 0)
      log_info("looks: {} came, {} answered, {} passed over for newer ones", looks_.load(), answered_, overtaken_);
    end_process(bus_, status_);
  }

 private:
  /// Frames do not wait for answers, which take longer and come at leisure.
  void run_live() {
    std::atomic<bool> running{true};
    std::thread answering;
    {
      const BlockStopSignals block;
      answering = std::thread([&] {
        constexpr int kPolite = 2;
        if (nice(kPolite) == -1) log_debug("the priority of answers cannot be lowered");
        const SerialScope alone;  // its helpers would be of its priority, and kept for who follows
        while (running) answer_next(milliseconds(100));
      });
    }
    const auto finish = [&] {
      running = false;
      answering.join();
    };
    try {
      run_process_loop(bus_, status_, [this](milliseconds timeout) { return follow_newest(timeout); });
    } catch (...) {
      finish();
      throw;
    }
    finish();
  }

  void receive_frame(const ReceivedMessage& arrival) {
    if (!channels_.is_name() && !is_frame_message(arrival.bytes)) return;
    if (options_.keep_frames) bus_.publish(arrival.channel, arrival.bytes, arrival.event_us);
    try {
      const FrameHeader header = read_frame_header(arrival.bytes);
      const FrameOrder order = status_.note_number({header.sequence, header.utime, header.run}, arrival.channel);
      if (order == FrameOrder::kDuplicate && !bus_.is_log()) return;
      EncodedFrame frame{{arrival.channel, header.utime}, shared_copy(arrival.bytes), arrival.time};
      detections_.add_frame(frame.id, frame.bytes);  // refuses one camera too many
      status_.count_received();
      const std::size_t bytes = arrival.bytes.size;
      const bool passed_over = order == FrameOrder::kLate ? frames_.push_late(arrival.channel, std::move(frame), bytes)
                                                          : frames_.push(arrival.channel, std::move(frame), bytes);
      if (passed_over) status_.count_skipped(1);
    } catch (const InputError& error) {
      status_.count_received();
      status_.count_refused(fmt::format("message on {}: {}", arrival.channel, error.what()), arrival.channel);
    }
  }

  void receive_detections(const ReceivedMessage& arrival) {
    try {
      FrameSynchroniser::require_size(arrival.bytes.size);
      check_wire(arrival.bytes, detections_t::getHash(), detections_t::getTypeName());
      const FrameId frame = read_result_frame(arrival.bytes, arrival.channel);
      if (!bus_.is_log() && repeats_.is_repeated(frame, arrival.bytes.data, arrival.bytes.size, arrival.time))
        return status_.note_duplicate();
      if (channels_.matches(frame.channel)) {
        if (options_.keep_frames) bus_.publish(arrival.channel, arrival.bytes, arrival.event_us);
        detections_.add_detections(frame, {arrival.bytes.data, arrival.bytes.data + arrival.bytes.size});
        ++looks_;
      } else {
        transforms_.note_other_camera(frame.channel);
      }
    } catch (const InputError& error) {
      status_.note_bad_message(fmt::format("message on {}: {}", arrival.channel, error.what()));
    }
  }

  bool follow_newest(milliseconds timeout) {
    const std::optional<EncodedFrame> encoded = frames_.pop(timeout);
    if (!encoded) return false;
    try {
      DecodedFrame decoded = decode_for_poses(*encoded->bytes, encoded->id.channel, options_.camera);
      decoded.frame.stages.push_back(decoded.decoding);
      const RecentFrames::Decoded frame = std::make_shared<const DecodedFrame>(std::move(decoded));
      recent_.keep(frame);
      std::optional<ObjectPoses> poses = poses_.follow(frame->frame);
      if (!poses) {
        status_.count_skipped(1);
        return true;
      }
      poses->frame = encoded->id;
      bus_.publish(channel::kPoses, to_message(*poses));
      transforms_.publish(*poses);
      status_.count_processed(std::chrono::steady_clock::now() - encoded->arrival);
    } catch (const std::exception& error) {
      status_.count_refused(error.what(), encoded->id.channel + " work");
    }
    return true;
  }

  bool answer_next(milliseconds timeout) {
    const std::optional<SynchronisedMessages> pair = detections_.pop(timeout);
    const FrameSynchroniser::Dropped dropped = detections_.pop_dropped();
    overtaken_ += dropped.skipped;
    for (const FrameId& frame : dropped.without_frame) {
      status_.note_bad_message(fmt::format("detections of frame {}: the frame itself has not come", to_string(frame)));
    }
    if (!pair) return false;
    try {
      bus_.publish(channel::kPoses, to_message(answer(*pair)));
      ++answered_;
    } catch (const std::exception& error) {
      status_.note_bad_message(error.what());
    }
    return true;
  }

  ObjectPoses answer(const SynchronisedMessages& pair) {
    Detections detections =
        detections_from_message(decode_message<detections_t>({pair.detections.data(), pair.detections.size()}));
    if (!bus_.is_log()) require_max_detections(detections);
    RecentFrames::Decoded decoded = recent_.find(pair.id);
    if (!decoded) {
      decoded = std::make_shared<const DecodedFrame>(decode_for_poses(*pair.frame, pair.id.channel, options_.camera));
    }
    detections.stages.push_back(decoded->decoding);
    note_models();
    warn(models_.note(detections));
    ObjectPoses poses = poses_.answer(decoded->frame, detections);
    poses.frame = pair.id;
    return poses;
  }

  // A store's objects may have become others meanwhile.
  void note_models() {
    if (!options_.objects || models_.settled()) return;
    for (const KnownObject& object : options_.objects().objects) models_.add_model(object.name);
  }

  static void warn(const std::optional<std::string>& words) {
    if (words) log_warning("{}", *words);
  }

  LcmBus& bus_;
  const PoseProcessOptions& options_;
  const FollowPoses& poses_;
  ChannelPattern channels_;
  StatusReporter status_;
  LatestPerChannel<EncodedFrame> frames_;
  FrameSynchroniser detections_;
  RecentFrames recent_;
  ModelCheck models_;  // of who answers
  TransformPublisher transforms_;
  DuplicateFilter repeats_;
  std::atomic<std::int64_t> looks_{0};  // results of the detector that came
  std::int64_t answered_ = 0;           // with poses, of who answers
  std::int64_t overtaken_ = 0;          // passed over for newer ones, before they were answered
};

}  // namespace

void run_follow_process(LcmBus& bus, const PoseProcessOptions& options, const FollowPoses& poses) {
  require(!options.keep_frames || bus.is_log(), "frames are kept of a log (-l file://LOG), not of {}", bus.url());
  FollowProcess(bus, options, poses).run();
}

}  // namespace houghstream
