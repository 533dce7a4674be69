#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/process/byte_budget.hpp"
#include "pipeline/process/detector_count.hpp"
#include "pipeline/process/reception.hpp"
#include "pipeline/types/frame_id.hpp"

namespace houghstream {

/// An encoded frame that is kept for results still to come.
struct StoredFrame {
  FrameId id;
  SharedBytes bytes;
};

/// An encoded result of a frame (detections, or poses), with the encoded frame itself.
struct SynchronisedMessages {
  FrameId id;
  SharedBytes frame;
  std::int64_t arrival_number = 0;  ///< number of the frame in order of arrival, since a frame id may come again
  std::vector<std::uint8_t> result;
  std::chrono::steady_clock::time_point arrival;  ///< arrival of the result
};

/// Decides whether each pair is handed out; without `decide` every pair is. `decide` is called with
/// the synchroniser locked, in the thread that pops, for the oldest pairs first and again for those that must wait.
struct FrameGate {
  enum class Answer { kAccept, kWait, kRefuse };
  struct Decision {
    Answer answer = Answer::kAccept;
    std::string reason;  ///< reason of a refusal
  };
  /// `age_s` is the time since this pair was decided on first, seconds.
  std::function<Decision(const FrameId&, double age_s)> decide;
  std::function<std::int64_t()> now_us;  ///< the clock of the ages, microseconds; it may be a log's
  std::string awaited;                   ///< names, in a sentence, what pairs wait for
};

/// Matches results with their frames, whichever of the two comes first, for any number of cameras and of senders on
/// each (as message_filters of ROS does by exact time). Nothing is decoded. Ages are counted in frames of the camera,
/// not in seconds, so that a log gives the same pairs at any speed. May be used from any thread.
class FrameSynchroniser {
 public:
  /// Size of the cache of encoded frames, which are kept for results still to come: 64 of each camera, and fewer where
  /// those of all cameras have more bytes than this. First the camera with the most frames drops its oldest; where each
  /// has one left, the earliest goes. The last frame that has come stays, however large it is.
  static constexpr std::size_t kCachedFrames = 64;
  static constexpr std::size_t kCachedBytes = std::size_t{192} << 20U;
  /// Maximum number of pending results of each camera, which wait for their frame or for pop(); the oldest are dropped.
  static constexpr std::size_t kMaxPending = 128;
  /// Maximum number of bytes of the pending results of all cameras; above it, the camera with the most results drops
  /// its oldest.
  static constexpr std::size_t kMaxPendingBytes = std::size_t{128} << 20U;
  /// Frames on more channels are refused, since an untrusted sender may make up channels without end.
  static constexpr std::size_t kCameras = 64;
  /// Maximum number of deferred pairs, those of all cameras that wait for the gate, and of the bytes of their frames;
  /// the oldest are refused.
  static constexpr std::size_t kMaxDeferred = 1024;
  static constexpr std::size_t kMaxDeferredBytes = kCachedBytes;
  /// Results without their frame wait for this many further frames of the camera, then are dropped.
  static constexpr std::int64_t kMaxLagFrames = 30;

  /// With `newest_first`, pop() serves the cameras in turn, and drops older results of a camera: one of each of
  /// its detectors stays. Otherwise everything is processed in the order of arrival. `offers_unmatched_frames`
  /// enables pop_unmatched_frame().
  explicit FrameSynchroniser(bool newest_first, bool offers_unmatched_frames = true, FrameGate gate = {})
      : newest_first_(newest_first), offers_unmatched_frames_(offers_unmatched_frames), gate_(std::move(gate)) {}

  /// Throws InputError for one camera too many.
  void add_frame(const FrameId& id, SharedBytes bytes);
  /// Adds a result of frame `id`. Throws InputError for one camera too many.
  void add_result(const FrameId& id, std::vector<std::uint8_t> bytes);

  /// Pops the next pair that the gate accepts; waits for one up to `timeout`, or, with `newest_first`, until a frame
  /// comes.
  std::optional<SynchronisedMessages> pop(std::chrono::milliseconds timeout);

  /// Lets pop() ask the gate again at once, since the awaited data may have arrived.
  void recheck_gate();

  /// Returns the newest frame of a camera, where `newest_first`, and where neither it nor its pair has been popped:
  /// there is time to decode it while its result is on the way. The frame is kept for its result.
  std::optional<StoredFrame> pop_unmatched_frame();

  /// Frames and results that were dropped since the last call.
  struct Refused {
    FrameId id;
    std::string reason;
  };
  struct Dropped {
    std::int64_t skipped = 0;            ///< dropped for newer ones, or where there were too many
    std::vector<FrameId> without_frame;  ///< results whose frame never came, by its id
    std::vector<Refused> refused;        ///< refused by the gate, or while they waited for it
  };
  Dropped pop_dropped();

  /// Drops all results that still wait, for their frame or for the gate.
  void flush();

 private:
  struct CachedFrame {
    StoredFrame frame;
    std::int64_t number = 0;  // SynchronisedMessages::arrival_number
    ByteBudget::Reservation reservation;
  };
  struct PendingResult {
    FrameId id;
    std::vector<std::uint8_t> bytes;
    std::chrono::steady_clock::time_point arrival;
    std::int64_t number = 0;         // order of arrival, over all cameras
    std::int64_t frames_before = 0;  // frames of the camera that had arrived when it did
    ByteBudget::Reservation reservation;
  };
  struct DeferredPair {
    SynchronisedMessages pair;
    std::int64_t since_us = 0;            // time on the gate's clock
    ByteBudget::Reservation reservation;  // bytes of the frame, which may have left the cache
  };
  struct Camera {
    std::deque<CachedFrame> frames;     // the newest last
    std::deque<PendingResult> pending;  // results in the order of arrival
    std::int64_t frame_count = 0;
    bool has_unmatched_frame = false;  // whether pop_unmatched_frame() may return the last frame
    std::int64_t last_served = 0;      // value of serve_count_ when it was served last

    const CachedFrame* find_frame(const FrameId& id) const;
    std::optional<std::size_t> first_matched() const;
  };

  Camera& find_or_add_camera(const std::string& channel);
  Camera& largest_camera();
  void limit_frame_bytes();
  void limit_pending_bytes();
  Camera* next_camera();
  void drop_stale(const std::string& channel, Camera& camera);
  void drop_first(Camera& camera);
  void drop_unmatchable(Camera& camera);
  SynchronisedMessages pop_pair(Camera& camera);
  std::optional<SynchronisedMessages> next_pair();
  FrameGate::Answer decide_by_gate(const FrameId& id, std::int64_t since_us);
  void defer(SynchronisedMessages pair, std::int64_t since_us);
  bool has_any_unmatched_frame() const;

  bool newest_first_;
  bool offers_unmatched_frames_;
  FrameGate gate_;
  std::mutex mutex_;
  std::condition_variable changed_;
  ByteBudget frame_bytes_;                 // frames of all cameras
  ByteBudget pending_bytes_;               // results of all cameras
  ByteBudget deferred_bytes_;              // frames of pairs that wait for the gate
  std::map<std::string, Camera> cameras_;  // by channel name
  std::deque<DeferredPair> deferred_;      // oldest first
  DetectorCount detectors_;                // of each camera, estimated
  std::int64_t result_count_ = 0;          // results that have arrived
  std::int64_t frame_count_ = 0;           // frames that have arrived
  std::int64_t serve_count_ = 0;
  Dropped dropped_;
};

}  // namespace houghstream
