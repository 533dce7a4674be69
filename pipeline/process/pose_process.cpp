#include "pipeline/process/pose_process.hpp"

#include <fmt/ranges.h>

#include <atomic>
#include <cstdlib>
#include <map>
#include <set>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/process/decoded_frames.hpp"
#include "pipeline/process/frame_synchroniser.hpp"
#include "pipeline/process/latest_per_channel.hpp"
#include "pipeline/process/model_check.hpp"
#include "pipeline/process/pose_history.hpp"
#include "pipeline/process/process_loop.hpp"
#include "pipeline/process/reception.hpp"

namespace houghstream {
namespace {

using std::chrono::milliseconds;

// More detections at once could not be processed within Heartbeat::kHeartbeatTimeout.
void require_max_detections(const Detections& detections) {
  constexpr std::size_t kMax = 512;
  require(detections.detections.size() <= kMax, "frame {}: {} detections, expected at most {}",
          to_string(detections.frame), detections.detections.size(), kMax);
}

/// Publishes the transforms of poses on the channels named in pose_process.hpp. Every function may be called from any
/// thread.
class TransformPublisher {
 public:
  TransformPublisher(LcmBus& bus, const std::string& frame_channels, const std::function<NamedFrames()>& named_frames)
      : bus_(bus),
        frame_channels_(frame_channels),
        named_frames_(named_frames),
        several_cameras_(!ChannelPattern(frame_channels).is_name()) {}

  /// Notes that detections of a frame on this other channel have come.
  void note_other_camera(const std::string& channel) {
    if (several_cameras_.exchange(true)) return;
    log_info("detections of frames on {} are heard too: transforms go to <OBJECT>_TO_{}", channel,
             channel::camera_name(frame_channels_));
  }

  /// Publishes a rigid_transform_t for each valid pose, and for each frame that is named on its object.
  void publish(const ObjectPoses& poses) {
    const std::string camera = several_cameras_ ? poses.frame.channel : "";
    const NamedFrames named = named_frames_ ? named_frames_() : NamedFrames();
    for (const ObjectPose& pose : poses.poses) {
      if (!pose.T_camera_object) continue;
      bus_.publish(channel::to_camera(pose.class_name, camera), to_message(poses.frame.utime, *pose.T_camera_object));
      const auto frames = named.find(pose.class_name);
      if (frames == named.end()) continue;
      for (const ObjectFrame& frame : frames->second)
        bus_.publish(channel::to_camera(pose.class_name + "_" + frame.name, camera),
                     to_message(poses.frame.utime, *pose.T_camera_object * frame.T_object_frame));
    }
  }

 private:
  LcmBus& bus_;
  std::string frame_channels_;
  std::function<NamedFrames()> named_frames_;
  std::atomic<bool> several_cameras_;
};

/// Estimates and publishes the poses of detections. Where it follows objects as well, frames are processed first, and
/// the status counts them; detections are then processed in the background, and counted separately.
class PoseProcess {
 public:
  /// Does not follow where `follow` is empty.
  PoseProcess(LcmBus& bus, const PoseProcessOptions& options, const EstimatePoses& estimate, const FollowFrame& follow)
      : bus_(bus),
        options_(options),
        estimate_(estimate),
        follow_(follow),
        status_(options.process),
        reception_(bus, status_, options.frame_channels, options.keep_frames),
        synchroniser_(!bus.is_log(), !follow),
        decoded_(options.camera, "pose.decode"),
        model_check_(options.models),
        transforms_(bus, options.frame_channels, options.frames) {}

  void run() {
    status_.set_known_objects(options_.objects);
    catch_stop_signals();
    reception_.subscribe_to_frames(follow_ ? CountedAs::kReceived : CountedAs::kOther,
                                   [this](const ReceivedFrame& frame) { add_frame(frame); });
    reception_.subscribe_to_results<detections_t>(
        channel::kDetections, follow_ ? CountedAs::kOther : CountedAs::kReceived,
        [this](const ReceivedResult& detections) { add_detections(detections); },
        [this](const FrameId& frame) { note_other_camera(frame); });
    log_info("ready: {}frames from {}, detections from {} at {}", follow_ ? "follows in " : "", options_.frame_channels,
             channel::kDetections, bus_.url());
    const WorkStep process = [this](milliseconds timeout) { return process_next(timeout); };
    if (follow_) {
      run_process_loop(
          bus_, status_, [this](milliseconds timeout) { return follow_newest(timeout); }, process);
      status_.count_skipped(static_cast<std::int64_t>(newest_.waiting()));
    } else {
      run_process_loop(bus_, status_, process);
      synchroniser_.flush();
      count_dropped();
    }
    warn(model_check_.finish());
    if (!follow_) log_missing_frames();
    if (follow_ && detections_ > 0)
      log_info("looks: {} came, {} answered, {} passed over for newer ones", detections_.load(), processed_results_,
               skipped_results_);
    end_process(bus_, status_);
  }

 private:
  void add_frame(const ReceivedFrame& frame) {
    const SharedBytes bytes = shared_copy(frame.bytes);
    synchroniser_.add_frame(frame.id, bytes);  // refuses one camera too many
    if (!follow_) return;
    EncodedFrame encoded{frame.id, bytes, frame.time};
    const bool is_skipped = frame.order == FrameOrder::kLate
                                ? newest_.push_late(frame.id.channel, std::move(encoded), bytes->size())
                                : newest_.push(frame.id.channel, std::move(encoded), bytes->size());
    if (is_skipped) status_.count_skipped(1);
  }

  void add_detections(const ReceivedResult& detections) {
    note_camera(detections.id);
    ++detections_;
    synchroniser_.add_result(detections.id, {detections.bytes.data, detections.bytes.data + detections.bytes.size});
  }

  void note_other_camera(const FrameId& frame) {
    note_camera(frame);
    ++other_camera_detections_;
    transforms_.note_other_camera(frame.channel);
  }

  void note_camera(const FrameId& frame) {
    if (cameras_.size() < FrameSynchroniser::kCameras) cameras_.insert(frame.channel);
  }

  /// The probabilities are published first: a receiver of the poses then has them too.
  void publish(const ObjectPoses& poses) {
    bus_.publish(channel::kPoseProbabilities, probabilities_to_message(poses));
    bus_.publish(channel::kPoses, to_message(poses));
  }

  /// Publishes once a second of each camera's frames what is known of it, as soon as some of it is.
  void publish_camera(const FrameId& frame) {
    constexpr std::int64_t kPeriodUs = 1'000'000;
    const auto sent = camera_sent_us_.find(frame.channel);
    if (sent != camera_sent_us_.end() && std::abs(frame.utime - sent->second) < kPeriodUs) return;
    const CameraChroma colours = options_.camera_colours ? options_.camera_colours(frame.channel) : CameraChroma();
    const std::optional<CameraTiming> timing =
        options_.camera_timing ? options_.camera_timing(frame.channel) : std::nullopt;
    if (colours.objects.empty() && !timing) return;
    camera_sent_us_[frame.channel] = frame.utime;
    if (!colours.objects.empty()) bus_.publish(channel::kCameraColours, to_message(colours));
    if (timing) bus_.publish(channel::kCameraTiming, to_message(*timing));
  }

  bool follow_newest(milliseconds timeout) {
    const std::optional<EncodedFrame> encoded = newest_.pop(timeout);
    if (!encoded) return false;
    try {
      std::optional<ObjectPoses> poses = follow_(*decoded_.decode(encoded->bytes, encoded->id.channel));
      if (!poses) {
        status_.count_skipped(1);
        return true;
      }
      poses->frame = encoded->id;
      publish(*poses);
      publish_camera(poses->frame);
      transforms_.publish(*poses);
      status_.count_processed(std::chrono::steady_clock::now() - encoded->arrival);
    } catch (const std::exception& error) {
      status_.count_refused(error.what(), encoded->id.channel + " work");
    }
    return true;
  }

  bool process_next(milliseconds timeout) {
    const std::optional<SynchronisedMessages> pair = synchroniser_.pop(timeout);
    count_dropped();
    if (!pair) {
      decode_ahead();
      return false;
    }
    try {
      const ObjectPoses poses = estimate_poses(*pair);
      publish(poses);
      if (follow_) {
        ++processed_results_;
      } else {
        publish_camera(poses.frame);
        transforms_.publish(poses);
        status_.count_processed(std::chrono::steady_clock::now() - pair->arrival);
      }
    } catch (const std::exception& error) {
      refuse(error.what(), "work");
    }
    return true;
  }

  // Decodes a camera's newest frame while its detections are on the way. An error is reported when they come.
  void decode_ahead() {
    const std::optional<StoredFrame> unmatched = synchroniser_.pop_unmatched_frame();
    if (!unmatched) return;
    try {
      decoded_.decode(unmatched->bytes, unmatched->id.channel);
    } catch (const InputError&) {
    }
  }

  ObjectPoses estimate_poses(const SynchronisedMessages& pair) {
    Detections detections =
        detections_from_message(decode_message<detections_t>({pair.result.data(), pair.result.size()}));
    if (!bus_.is_log()) require_max_detections(detections);
    if (!follow_ && detections.detections.empty()) return {detections.frame, {}, detections.stages};
    const DecodedFrames::Decoded frame = decoded_.decode(pair.frame, pair.id.channel);
    detections.stages.push_back(frame->stages.back());
    if (!follow_) warn_of_shared_classes(detections, pair.arrival_number);
    update_model_check();
    warn(model_check_.note(detections));
    ObjectPoses poses = estimate_(*frame, detections, follow_ ? ObjectPoses{} : history_.find_warm_start(detections));
    poses.frame = pair.id;
    if (!follow_) history_.add(poses);
    return poses;
  }

  void warn_of_shared_classes(const Detections& detections, std::int64_t arrival_number) {
    for (const std::string& name : history_.note_classes(detections, arrival_number)) {
      status_.note_bad_message(fmt::format(
          "frame {}: two detectors find '{}', which gets two poses; expected detectors of different objects",
          to_string(detections.frame), name));
    }
  }

  // The objects of a store may have changed meanwhile.
  void update_model_check() {
    if (!options_.objects || model_check_.is_done()) return;
    for (const KnownObject& object : options_.objects().objects) model_check_.add_model(object.name);
  }

  static void warn(const std::optional<std::string>& words) {
    if (words) log_warning("{}", *words);
  }

  void count_dropped() {
    const FrameSynchroniser::Dropped dropped = synchroniser_.pop_dropped();
    if (follow_) {
      skipped_results_ += dropped.skipped;
    } else {
      status_.count_skipped(dropped.skipped);
    }
    without_frame_ += static_cast<std::int64_t>(dropped.without_frame.size());
    for (const FrameId& frame : dropped.without_frame)
      refuse(fmt::format("detections of frame {}: the frame itself has not come", to_string(frame)), "no frame");
  }

  void refuse(const std::string& reason, const std::string& kind) {
    if (follow_) {
      status_.note_bad_message(reason);
    } else {
      status_.count_refused(reason, kind);
    }
  }

  void log_missing_frames() const {
    // On a network another process may handle other cameras' detections; in a log none does, so they are reported.
    const std::int64_t others = bus_.is_log() ? other_camera_detections_.load() : 0;
    const std::int64_t all = detections_ + others;
    const std::int64_t missing = without_frame_ + others;
    if (missing == 0) return;
    const std::string words = fmt::format("{} of {} detections_t had no frame on {}; they name {}", missing, all,
                                          options_.frame_channels, fmt::join(cameras_, ", "));
    require(!bus_.is_log() || missing < all, "{}: {}; hs-detect --keep-frames keeps them", bus_.url(), words);
    log_warning("{}", words);
  }

  LcmBus& bus_;
  const PoseProcessOptions& options_;
  const EstimatePoses& estimate_;
  const FollowFrame& follow_;
  StatusReporter status_;
  Reception reception_;
  LatestPerChannel<EncodedFrame> newest_;  // frames for the thread that follows
  FrameSynchroniser synchroniser_;
  DecodedFrames decoded_;
  PoseHistory history_;
  ModelCheck model_check_;
  TransformPublisher transforms_;
  std::map<std::string, std::int64_t> camera_sent_us_;  // frame time by camera
  std::int64_t without_frame_ = 0;                      // detections
  std::int64_t processed_results_ = 0;                  // results processed while following
  std::int64_t skipped_results_ = 0;                    // results dropped for newer ones while following
  // These are set by the receiving thread.
  std::set<std::string> cameras_;                         // cameras that detections name
  std::atomic<std::int64_t> detections_{0};               // detections of frames on these channels
  std::atomic<std::int64_t> other_camera_detections_{0};  // detections of other cameras' frames
};

}  // namespace

void run_pose_process(LcmBus& bus, const PoseProcessOptions& options, const EstimatePoses& estimate) {
  PoseProcess(bus, options, estimate, {}).run();
}

void run_follow_process(LcmBus& bus, const PoseProcessOptions& options, const FollowPoses& poses) {
  const EstimatePoses process_detections = [&](const RgbdFrame& frame, const Detections& detections,
                                               const ObjectPoses&) {
    return poses.process_detections(frame, detections);
  };
  PoseProcess(bus, options, process_detections, poses.follow).run();
}

}  // namespace houghstream
