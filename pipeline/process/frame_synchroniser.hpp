#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/messages/wire_reader.hpp"
#include "pipeline/process/byte_budget.hpp"
#include "pipeline/process/detector_count.hpp"
#include "pipeline/types/frame_id.hpp"

namespace houghstream {

/// An encoded frame's bytes, which are copied once, off the bus, however many keep them.
using SharedBytes = std::shared_ptr<const std::vector<std::uint8_t>>;
SharedBytes shared_copy(ByteView bytes);

/// An encoded frame.
struct ArrivedFrame {
  FrameId id;
  SharedBytes bytes;
};

/// Encoded detections with the encoded frame that they were found in.
struct SynchronisedMessages {
  FrameId id;
  SharedBytes frame;
  std::int64_t frame_number = 0;  ///< of all frames in their order of arrival: a name may come again
  std::vector<std::uint8_t> detections;
  std::chrono::steady_clock::time_point arrival;  ///< of the detections
};

/// Brings detections together with their own frame, whichever comes first, for any number of cameras and of detectors
/// on each. Nothing is decoded. Ages are counted in frames of the camera, not in seconds, so that a log gives the same
/// pairs at any speed. May be used from any thread.
class FrameSynchroniser {
 public:
  /// Frames of each camera that are kept for detections still to come: 64, and fewer where those of all cameras have
  /// more bytes than this. First the camera with the most frames gives up its oldest; where each has one left, the one
  /// that has come first goes. The last frame that has come stays, however large it is.
  static constexpr std::size_t kHistory = 64;
  static constexpr std::size_t kHistoryBytes = std::size_t{192} << 20U;
  /// Detections of each camera that wait, for their frame or their turn; the oldest go. Larger ones (two thousand
  /// detections have so many bytes) are refused.
  static constexpr std::size_t kWaiting = 128;
  static constexpr std::size_t kWaitingBytes = std::size_t{1} << 20U;
  /// Of the detections of all cameras that wait; where there are more, the camera with the most gives up its oldest.
  static constexpr std::size_t kAllWaitingBytes = std::size_t{128} << 20U;
  /// Frames on more channels are refused: a sender of rubbish may make up channels without end.
  static constexpr std::size_t kCameras = 64;
  /// Detections whose frame is not here wait for this many further frames of the camera, then are given up.
  static constexpr std::int64_t kMaxLagFrames = 30;

  /// `newest_first`: pop() serves the cameras in turn, and passes over older detections of a camera: of each of its
  /// detectors one result stays. Otherwise everything is worked on in the order of arrival. `ahead`:
  /// pop_unmatched_frame() is used.
  explicit FrameSynchroniser(bool newest_first, bool ahead = true) : newest_first_(newest_first), ahead_(ahead) {}

  /// Throws InputError where detections or poses of so many bytes are refused.
  static void require_size(std::size_t bytes);

  /// Throws InputError for one camera too many.
  void add_frame(const FrameId& id, SharedBytes bytes);
  /// `id` is the frame that they were found in. Throws InputError for one camera too many, and for too many bytes.
  void add_detections(const FrameId& id, std::vector<std::uint8_t> bytes);

  /// The next pair, waiting for one up to `timeout`, or, with `newest_first`, until a frame comes.
  std::optional<SynchronisedMessages> pop(std::chrono::milliseconds timeout);

  /// Ends the waiting of pop(), now or of the next call: something else has come that its caller waits for.
  void wake();

  /// The newest frame of a camera, where `newest_first`, and where neither it nor its pair has been taken: there is
  /// time to decode it while its detections are on the way. It stays here for them.
  std::optional<ArrivedFrame> pop_unmatched_frame();

  /// What was dropped since the last call.
  struct Dropped {
    std::int64_t skipped = 0;            ///< passed over for newer ones, or for too many
    std::vector<FrameId> without_frame;  ///< of detections whose frame never came
  };
  Dropped pop_dropped();

  /// Gives up all detections that still wait for their frame.
  void flush();

 private:
  struct Kept {
    ArrivedFrame frame;
    std::int64_t number = 0;  // SynchronisedMessages::frame_number
    ByteBudget::Held held;
  };
  struct Waiting {
    FrameId id;
    std::vector<std::uint8_t> bytes;
    std::chrono::steady_clock::time_point arrival;
    std::int64_t number = 0;         // in the order of arrival, of all cameras
    std::int64_t frames_before = 0;  // frames of the camera that had arrived when it did
    ByteBudget::Held held;
  };
  struct Camera {
    std::deque<Kept> frames;      // the last ones
    std::deque<Waiting> waiting;  // detections in the order of arrival
    std::int64_t frames_seen = 0;
    bool fresh = false;     // the last frame may be taken ahead
    std::int64_t turn = 0;  // when it was served last

    const Kept* find_frame(const FrameId& id) const;
    std::optional<std::size_t> first_complete() const;
  };

  Camera& camera_of(const std::string& channel);
  Camera& camera_to_shorten();
  void keep_within_bytes();
  void keep_waiting_within_bytes();
  Camera* next_camera();
  void drop_stale(const std::string& channel, Camera& camera);
  void give_up_first(Camera& camera);
  void drop_unmatchable(Camera& camera);
  SynchronisedMessages take_pair(Camera& camera);
  bool any_fresh() const;

  bool newest_first_;
  bool ahead_;
  std::mutex mutex_;
  std::condition_variable changed_;
  ByteBudget frame_bytes_;                 // of all cameras
  ByteBudget waiting_bytes_;               // of their detections
  std::map<std::string, Camera> cameras_;  // by channel
  DetectorCount detectors_;
  std::int64_t arrivals_ = 0;  // of detections
  std::int64_t frames_ = 0;    // that have arrived
  std::int64_t turns_ = 0;
  bool woken_ = false;
  Dropped dropped_;
};

}  // namespace houghstream
