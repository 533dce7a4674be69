#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "pipeline/text/limited_lines.hpp"
#include "pipeline/types/frame_id.hpp"

namespace houghstream::tracks {

/// When a camera looked last.
struct CameraClock {
  std::int64_t utime = 0;
  std::int64_t results = 0;       ///< of the frame of this time; none before the first frame
  double seconds = 0.0;           ///< from the frame before to the one of this time, as far as they count
  std::set<std::string> classes;  ///< that the frame of this time was told of
  std::set<std::string> missed;   ///< that have been looked for in it, and of which something was not found
};

/// What a result's time says of it.
enum class TimeOrder {
  kNext,  ///< of a frame as new as its camera's last one, or newer
  kLate,  ///< to be passed over: its camera's later frames are known, or it is of an earlier run
  kAnew   ///< time goes back: a new world begins with it
};

/// The clocks of a world's cameras. Not thread-safe.
class WorldClock {
 public:
  /// `newest_utime`: of the frame of this camera that has come last. Time goes back where that does, by more than a
  /// second: of an older frame whose camera goes on, the result has only taken long. Throws InputError for a frame that
  /// is more than a second older than another camera's, as clocks that disagree make it; where thirty have come one
  /// after the other, the other camera is no more, and the thirtieth is the beginning of a new world. A new world is
  /// said, once a second at most.
  TimeOrder order_of(const FrameId& frame, std::int64_t newest_utime);

  /// The camera's clock, set to this frame.
  CameraClock& set(const FrameId& frame);

  /// No camera has looked yet.
  void begin_world();

 private:
  void tell_new_world(const FrameId& frame, std::int64_t last_utime);

  std::map<std::string, CameraClock> cameras_;  // by channel
  std::optional<FrameId> newest_;               // of all cameras
  int behind_ = 0;                              // frames one after the other that were refused as too old
  LimitedLines lines_;
};

}  // namespace houghstream::tracks
