#include "pipeline/process/pose_process.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <memory>
#include <set>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/process/frame_synchroniser.hpp"
#include "pipeline/process/model_check.hpp"
#include "pipeline/process/pose_history.hpp"
#include "pipeline/process/pose_output.hpp"
#include "pipeline/process/process_loop.hpp"
#include "pipeline/process/recent_frames.hpp"

namespace houghstream {
namespace {

std::vector<std::uint8_t> copy(ByteView bytes) {
  return {bytes.data, bytes.data + bytes.size};
}

ByteView view(const std::vector<std::uint8_t>& bytes) {
  return {bytes.data(), bytes.size()};
}

/// What was found in a frame so far, by all its detectors.
struct HeardClasses {
  FrameId frame;
  std::int64_t number = 0;  // SynchronisedMessages::frame_number
  std::set<std::string> names;
};

class PoseProcess {
 public:
  PoseProcess(LcmBus& bus, const PoseProcessOptions& options, const EstimatePoses& estimate)
      : bus_(bus),
        options_(options),
        estimate_(estimate),
        channels_(options.frame_channels),
        status_(options.process),
        inbox_(!bus.is_log()),
        models_(options.models),
        transforms_(bus, options.frame_channels) {}

  void run() {
    status_.set_known_objects(options_.objects);
    catch_stop_signals();
    bus_.subscribe_to_frames(options_.frame_channels,
                             [this](const ReceivedMessage& arrival) { receive_frame(arrival); });
    bus_.subscribe(channel::kDetections, [this](const ReceivedMessage& arrival) { receive_detections(arrival); });
    log_info("ready: frames from {}, detections from {} at {}", options_.frame_channels, channel::kDetections,
             bus_.url());
    run_process_loop(bus_, status_, [this](std::chrono::milliseconds timeout) { return step(timeout); });
    inbox_.flush();
    count_dropped();
    warn(models_.at_end());
    tell_missing_frames();
    end_process(bus_, status_);
  }

 private:
  void receive_frame(const ReceivedMessage& arrival) {
    if (!channels_.is_name() && !is_frame_message(arrival.bytes)) return;
    if (options_.keep_frames) bus_.publish(arrival.channel, arrival.bytes, arrival.event_us);
    try {
      const FrameHeader header = read_frame_header(arrival.bytes);
      const FrameOrder order = status_.note_number({header.sequence, header.utime, header.run}, arrival.channel);
      if (order == FrameOrder::kDuplicate && !bus_.is_log()) return;
      inbox_.add_frame({arrival.channel, header.utime}, shared_copy(arrival.bytes));
    } catch (const InputError& error) {
      status_.note_bad_message(fmt::format("message on {}: {}", arrival.channel, error.what()));
    }
  }

  void receive_detections(const ReceivedMessage& arrival) {
    try {
      FrameSynchroniser::require_size(arrival.bytes.size);
      check_wire(arrival.bytes, detections_t::getHash(), detections_t::getTypeName());
      const FrameId frame = read_result_frame(arrival.bytes, arrival.channel);
      if (!bus_.is_log() && repeats_.is_repeated(frame, arrival.bytes.data, arrival.bytes.size, arrival.time))
        return status_.note_duplicate();
      if (sources_.size() < FrameSynchroniser::kCameras) sources_.insert(frame.channel);
      ++detections_;
      if (!channels_.matches(frame.channel)) {
        ++others_;
        transforms_.note_other_camera(frame.channel);
        return;
      }
      if (options_.keep_frames) bus_.publish(arrival.channel, arrival.bytes, arrival.event_us);
      inbox_.add_detections(frame, copy(arrival.bytes));
      status_.count_received();
    } catch (const InputError& error) {
      status_.count_received();
      status_.count_refused(fmt::format("message on {}: {}", arrival.channel, error.what()), "message");
    }
  }

  bool step(std::chrono::milliseconds timeout) {
    const std::optional<SynchronisedMessages> pair = inbox_.pop(timeout);
    count_dropped();
    if (!pair) {
      decode_ahead();
      return false;
    }
    try {
      publish(poses_of(*pair));
      status_.count_processed(std::chrono::steady_clock::now() - pair->arrival);
    } catch (const std::exception& error) {
      status_.count_refused(error.what(), "work");
    }
    return true;
  }

  // A camera's newest frame is decoded while its detections are on the way. What cannot be understood is told when they
  // come.
  void decode_ahead() {
    const std::optional<ArrivedFrame> fresh = inbox_.pop_unmatched_frame();
    if (!fresh) return;
    try {
      ahead_.keep(decoded(fresh->id, *fresh->bytes));
    } catch (const InputError&) {
    }
  }

  RecentFrames::Decoded decoded(const FrameId& id, const std::vector<std::uint8_t>& bytes) const {
    return std::make_shared<const DecodedFrame>(decode_for_poses(bytes, id.channel, options_.camera));
  }

  ObjectPoses poses_of(const SynchronisedMessages& pair) {
    Detections detections = detections_from_message(decode_message<detections_t>(view(pair.detections)));
    if (!bus_.is_log()) require_max_detections(detections);
    if (detections.detections.empty()) return {detections.frame, {}, detections.stages};
    const RecentFrames::Decoded ahead = ahead_.find(pair.id);
    const RecentFrames::Decoded frame = ahead ? ahead : decoded(pair.id, *pair.frame);
    detections.stages.push_back(frame->decoding);
    note_shared_classes(detections, pair.frame_number);
    note_models();
    warn(models_.note(detections));
    ObjectPoses poses = estimate_(frame->frame, detections, memory_.before(detections));
    poses.frame = pair.id;
    memory_.keep(poses);
    return poses;
  }

  // Two detectors that know the same object give it two poses.
  void note_shared_classes(const Detections& detections, std::int64_t frame_number) {
    constexpr std::size_t kFrames = 16;
    const auto heard = std::find_if(heard_.begin(), heard_.end(),
                                    [&](const HeardClasses& classes) { return classes.frame == detections.frame; });
    std::set<std::string> names;
    for (const Detection& detection : detections.detections) names.insert(detection.class_name);
    if (heard == heard_.end()) {
      heard_.push_back({detections.frame, frame_number, std::move(names)});
      if (heard_.size() > kFrames) heard_.pop_front();
      return;
    }
    if (heard->number != frame_number) {
      memory_.note_again(detections.frame);
      *heard = {detections.frame, frame_number, std::move(names)};
      return;
    }
    for (const std::string& name : names) {
      if (heard->names.insert(name).second) continue;
      status_.note_bad_message(fmt::format(
          "frame {}: two detectors find '{}', which gets two poses; expected detectors of different objects",
          to_string(detections.frame), name));
    }
  }

  // A store's objects may have become others meanwhile.
  void note_models() {
    if (!options_.objects || models_.settled()) return;
    for (const KnownObject& object : options_.objects().objects) models_.add_model(object.name);
  }

  void publish(const ObjectPoses& poses) {
    bus_.publish(channel::kPoses, to_message(poses));
    transforms_.publish(poses);
  }

  static void warn(const std::optional<std::string>& words) {
    if (words) log_warning("{}", *words);
  }

  void count_dropped() {
    const FrameSynchroniser::Dropped dropped = inbox_.pop_dropped();
    status_.count_skipped(dropped.skipped);
    without_frame_ += static_cast<std::int64_t>(dropped.without_frame.size());
    for (const FrameId& frame : dropped.without_frame) {
      status_.count_refused(fmt::format("detections of frame {}: the frame itself has not come", to_string(frame)),
                            "no frame");
    }
  }

  void tell_missing_frames() const {
    // On a network another process may work on other cameras' detections; of a log it is said.
    const std::int64_t others = others_;
    const std::int64_t all = detections_ - (bus_.is_log() ? 0 : others);
    const std::int64_t missing = without_frame_ + (bus_.is_log() ? others : 0);
    if (missing == 0) return;
    const std::string words = fmt::format("{} of {} detections_t had no frame on {}; they name {}", missing, all,
                                          options_.frame_channels, fmt::join(sources_, ", "));
    require(!bus_.is_log() || missing < all, "{}: {}; hs-detect --keep-frames keeps them", bus_.url(), words);
    log_warning("{}", words);
  }

  LcmBus& bus_;
  const PoseProcessOptions& options_;
  const EstimatePoses& estimate_;
  ChannelPattern channels_;
  StatusReporter status_;
  FrameSynchroniser inbox_;
  RecentFrames ahead_;  // decoded before their detections have come
  PoseHistory memory_;
  std::deque<HeardClasses> heard_;
  ModelCheck models_;
  TransformPublisher transforms_;
  // What the receiving thread has seen.
  std::set<std::string> sources_;
  DuplicateFilter repeats_;
  std::atomic<std::int64_t> detections_{0};
  std::atomic<std::int64_t> others_{0};  // of them, of other cameras' frames
  std::int64_t without_frame_ = 0;       // of the rest
};

}  // namespace

void run_pose_process(LcmBus& bus, const PoseProcessOptions& options, const EstimatePoses& estimate) {
  require(!options.keep_frames || bus.is_log(), "frames are kept of a log (-l file://LOG), not of {}", bus.url());
  PoseProcess(bus, options, estimate).run();
}

}  // namespace houghstream
