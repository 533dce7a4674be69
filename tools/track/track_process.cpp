#include "tools/track/track_process.hpp"

#include <atomic>
#include <mutex>

#include "pipeline/base/log_line.hpp"
#include "pipeline/base/log_throttle.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/process/frame_synchroniser.hpp"
#include "pipeline/process/process_loop.hpp"
#include "pipeline/process/reception.hpp"
#include "tools/track/heartbeat_monitor.hpp"
#include "tools/track/recent_detections.hpp"
#include "tools/track/world_reference.hpp"

namespace houghstream::track {
namespace {

using std::chrono::milliseconds;

ByteView view(const std::vector<std::uint8_t>& bytes) {
  return {bytes.data(), bytes.size()};
}

class TrackProcess {
 public:
  TrackProcess(LcmBus& bus, const TrackProcessOptions& options, const CurrentModels& models)
      : bus_(bus),
        options_(options),
        models_(models),
        status_(options.process),
        reception_(bus, status_, options.frame_channels),
        synchroniser_(false, false, extrinsics_gate()),
        used_models_(models()),
        tracker_(*used_models_, {}),
        output_(bus, options.output),
        world_reference_(options.camera_poses) {
    output_.set_models(*used_models_);
  }

  tracks::ExtrinsicCheck run() {
    status_.set_known_objects(options_.objects);
    reception_.subscribe_to_frames(CountedAs::kOther, [this](const ReceivedFrame& frame) { add_frame(frame); });
    reception_.subscribe_to_results<detections_t>(channel::kDetections, CountedAs::kOther,
                                                  [this](const ReceivedResult& result) { add_detections(result); });
    reception_.subscribe_to_results<object_poses_t>(channel::kPoses, CountedAs::kReceived,
                                                    [this](const ReceivedResult& result) { add_poses(result); });
    reception_.subscribe_to_messages<rigid_transform_t>(
        ".*_TO_WORLD", [this](const rigid_transform_t& message, const ReceivedMessage& arrival) {
          add_transform(message, arrival.channel);
        });
    // Its own last status may come when it has ended itself.
    bus_.subscribe(channel::kStatus,
                   [heartbeats = heartbeats_](const ReceivedMessage& arrival) { heartbeats->on_status(arrival); });
    log_info("ready: frames from {}, poses from {} at {}", options_.frame_channels, channel::kPoses, bus_.url());
    run_process_loop(bus_, status_, [this](milliseconds timeout) { return step(timeout); });
    synchroniser_.flush();
    count_dropped();
    require(!bus_.is_log() || poses_ > 0,
            "{}: no poses of frames on {}, expected a log with frames, detections and poses", bus_.url(),
            options_.frame_channels);
    const std::int64_t poses = poses_;
    require(!bus_.is_log() || without_frame_ < poses,
            "{}: {} object_poses_t and the frames of none, expected a log with frames, detections and poses; hs-pose "
            "--keep-frames keeps all three",
            bus_.url(), poses);
    end_process(bus_, status_);
    return check_;
  }

 private:
  void add_frame(const ReceivedFrame& frame) {
    detections_.forget(frame.id);
    synchroniser_.add_frame(frame.id, shared_copy(frame.bytes));
    const std::lock_guard<std::mutex> lock(mutex_);
    newest_[frame.id.channel] = frame.id.utime;  // has as many cameras as the synchroniser accepts
  }

  void add_detections(const ReceivedResult& result) {
    detections_.add(detections_from_message(decode_message<detections_t>(result.bytes)));
  }

  void add_poses(const ReceivedResult& result) {
    synchroniser_.add_result(result.id, {result.bytes.data, result.bytes.data + result.bytes.size});
    ++poses_;
  }

  void add_transform(const rigid_transform_t& message, const std::string& channel) {
    constexpr std::size_t kSuffix = 9;  // length of "_TO_WORLD"
    world_reference_.add(channel.substr(0, channel.size() - kSuffix), message.utime, transform_from_message(message));
    synchroniser_.recheck_gate();
  }

  /// Returns the gate by which poses pass once their camera's pose at their time is known, wait while its transforms
  /// may still come, and are refused otherwise: they are never placed at the origin.
  FrameGate extrinsics_gate() {
    FrameGate gate;
    gate.decide = [this](const FrameId& frame, double age_s) -> FrameGate::Decision {
      const tracks::CameraPose pose = world_reference_.camera_pose(frame, age_s < options_.wait_s);
      if (!pose.T_world_camera && pose.may_come) return {FrameGate::Answer::kWait, ""};
      if (!pose.T_world_camera) return {FrameGate::Answer::kRefuse, pose.reason};
      T_world_camera_ = *pose.T_world_camera;
      return {FrameGate::Answer::kAccept, ""};
    };
    gate.now_us = [this] { return reception_.now_us(); };
    gate.awaited = "the transforms of their cameras";
    return gate;
  }

  bool step(milliseconds timeout) {
    const std::optional<SynchronisedMessages> pair = synchroniser_.pop(timeout);
    count_dropped();
    if (!bus_.is_log()) heartbeats_->log_timed_out(reception_.now_us());
    if (!pair) return false;
    if (world_reference_.consume_reset()) tracker_.reset();
    process(*pair);
    return true;
  }

  void process(const SynchronisedMessages& pair) {
    try {
      StageClock clock;
      const ObjectPoses poses = poses_from_message(decode_message<object_poses_t>(view(pair.result)));
      check_.add(poses, T_world_camera_, *used_models_);
      if (options_.check || publish_objects(*pair.frame, poses, clock))
        status_.count_processed(std::chrono::steady_clock::now() - pair.arrival);
      report_inconsistencies();
    } catch (const std::exception& error) {
      status_.count_refused(error.what(), "work");
    }
  }

  /// Returns false for a frame that is too late.
  bool publish_objects(const std::vector<std::uint8_t>& frame, const ObjectPoses& poses, StageClock& clock) {
    if (const auto models = models_(); models != used_models_) {
      used_models_ = models;
      tracker_.set_models(*models);
      output_.set_models(*models);
    }
    const Detections detections = detections_.find(poses.frame);
    std::optional<RgbdFrame> image;
    const auto decode = [&]() -> const RgbdFrame* {
      if (!image) {
        image = depth_frame_from_message(decode_message<images_t>(view(frame)), poses.frame.channel, options_.camera);
        clock.mark("track.decode");
      }
      return &*image;
    };
    const FrameHeader header = read_frame_header(view(frame));
    std::optional<WorldObjects> objects =
        tracker_.update({poses, &detections, T_world_camera_, decode, newest_of(poses.frame.channel),
                         FrameNumber{header.sequence, header.utime, header.run}});
    if (!objects) {
      status_.count_skipped(1);  // a late result of a frame whose successors have been processed
      return false;
    }
    clock.mark("track.update");
    if (tracker_.refused() > 0)
      status_.note_bad_message(fmt::format("frame {}: no room for {} objects more, expected at most {} in all",
                                           to_string(poses.frame), tracker_.refused(),
                                           tracks::ObjectTrackerSettings().max_objects));
    objects->world = world_reference_.name();
    objects->stages.insert(objects->stages.end(), clock.times().begin(), clock.times().end());
    output_.publish(*objects, tracks::place_objects(*objects, *used_models_));
    return true;
  }

  std::optional<std::int64_t> newest_of(const std::string& camera) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = newest_.find(camera);
    return found == newest_.end() ? std::nullopt : std::optional<std::int64_t>(found->second);
  }

  void refuse(const FrameId& frame, const std::string& reason) {
    status_.count_refused(fmt::format("poses of frame {}: {}", to_string(frame), reason), "place");
  }

  void count_dropped() {
    const FrameSynchroniser::Dropped dropped = synchroniser_.pop_dropped();
    status_.count_skipped(dropped.skipped);
    without_frame_ += static_cast<std::int64_t>(dropped.without_frame.size());
    for (const FrameId& frame : dropped.without_frame) refuse(frame, "the frame itself has not come");
    for (const FrameSynchroniser::Refused& pair : dropped.refused) refuse(pair.id, pair.reason);
  }

  void report_inconsistencies() {
    for (const tracks::ExtrinsicInconsistency& pair : check_.inconsistencies()) {
      const std::string line =
          fmt::format("{} sees objects {:.1f} cm from where {} sees them: one of their places is wrong", pair.second,
                      100.0 * pair.offset_m.norm(), pair.first);
      const auto admitted = throttle_.admit(pair.first + pair.second, line, std::chrono::steady_clock::now());
      if (!admitted || bus_.is_log()) continue;
      log_warning("{}", *admitted);
      status_.set_last_error(line);
    }
  }

  LcmBus& bus_;
  const TrackProcessOptions& options_;
  const CurrentModels& models_;
  StatusReporter status_;
  Reception reception_;
  FrameSynchroniser synchroniser_;  // synchronises poses and their frames
  std::shared_ptr<const tracks::TrackModels> used_models_;
  tracks::Tracker tracker_;
  WorldOutput output_;
  WorldReference world_reference_;
  // Camera pose of the last pair that passed the gate.
  Eigen::Isometry3d T_world_camera_ = Eigen::Isometry3d::Identity();
  tracks::ExtrinsicCheck check_;
  LogThrottle throttle_;  // logs inconsistencies
  std::shared_ptr<HeartbeatMonitor> heartbeats_ = std::make_shared<HeartbeatMonitor>();
  std::int64_t without_frame_ = 0;  // poses
  RecentDetections detections_;
  // Members written by the receiving thread.
  mutable std::mutex mutex_;
  std::map<std::string, std::int64_t> newest_;  // utimes of the frames that came last, by channel
  std::atomic<std::int64_t> poses_{0};
};

}  // namespace

tracks::ExtrinsicCheck run_track_process(LcmBus& bus, const TrackProcessOptions& options, const CurrentModels& models) {
  return TrackProcess(bus, options, models).run();
}

}  // namespace houghstream::track
