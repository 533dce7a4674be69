#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "pipeline/base/log_throttle.hpp"
#include "pipeline/bus/sequence_count.hpp"
#include "pipeline/types/frame_id.hpp"

namespace houghstream::tracks {

/// When a camera looked last.
struct CameraClock {
  std::int64_t utime = 0;         ///< on the world's clock
  std::int64_t results = 0;       ///< of the frame of this time; none before the first frame
  double seconds = 0.0;           ///< from the frame before to the one of this time, as far as they count
  std::set<std::string> classes;  ///< that the frame of this time was told of
  std::set<std::string> missed;   ///< that have been looked for in it, and of which something was not found
};

/// What a result's time says of it.
enum class TimeOrder {
  kNext,  ///< of a frame as new as its camera's last one, or newer
  kLate,  ///< to be passed over: its camera's later frames are known, or it is of an earlier run, or its time is wrong
  kAnew   ///< time goes back: a new world begins with it
};

/// A frame whose result has come.
struct StampedFrame {
  FrameId id;
  FrameNumber number;             ///< of its source, as far as that says one
  std::int64_t newest_utime = 0;  ///< of the frame of this camera that has come last
};

/// The clocks of a world's cameras, and the world's own, which goes on where theirs are set. Not thread-safe.
class WorldClock {
 public:
  /// A result whose time lies more than a second from its camera's last one is passed over until the next one, or
  /// another camera's, lies beside it: one wrong stamp is nobody's time. Then, where it is ahead, time has passed (a
  /// minute at most). Where it is behind and the frames' numbers go on, the camera's clock was set back and the world
  /// goes on; else a new world begins, at once where the numbers tell that the source was started again. Of an older
  /// frame whose camera goes on, the result has only taken long. Throws InputError for a frame that is more than a
  /// second older than another camera's, as clocks that disagree make it; where thirty have come one after the other,
  /// the other camera is no more, and the thirtieth is the beginning of a new world. Steps and new worlds are said,
  /// once a second at most.
  TimeOrder order_of(const StampedFrame& frame);

  /// The camera's clock, set to this frame.
  CameraClock& set(const StampedFrame& frame);

  /// No camera has looked yet.
  void begin_world();

  /// The world's clock minus the frames' utimes: 0 as long as no clock was set.
  std::int64_t ahead_us() const { return ahead_us_; }

 private:
  struct Camera {
    CameraClock clock;
    FrameNumber number;       // of the last frame
    double interval_s = 0.0;  // from the frame before to the last one; 0 before the second
  };

  TimeOrder order_after(const Camera& camera, const StampedFrame& frame, std::int64_t utime);
  TimeOrder order_behind(const Camera& camera, const StampedFrame& frame, std::int64_t utime);
  TimeOrder order_ahead(std::int64_t last_utime, const StampedFrame& frame, std::int64_t utime);
  bool is_confirmed(std::int64_t last_utime, const FrameId& frame, std::int64_t utime);
  void move_to(std::int64_t world_utime, const FrameId& frame);
  void tell_new_world(const FrameId& frame, std::int64_t last_utime);
  void warn(const std::string& line);

  std::map<std::string, Camera> cameras_;        // by channel
  std::map<std::string, std::int64_t> doubted_;  // by channel, the time that lies far from the camera's last one
  std::optional<FrameId> newest_;                // of all cameras, on the world's clock
  std::int64_t ahead_us_ = 0;
  int behind_ = 0;  // frames one after the other that were refused as too old
  LogThrottle lines_;
};

}  // namespace houghstream::tracks
