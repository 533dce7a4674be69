#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/types/chroma_map.hpp"
#include "pipeline/types/teaching.hpp"
#include "tools/view/drawing/world_view.hpp"

namespace houghstream::view {

/// Holds the last status of a process.
struct ProcessState {
  std::string name;           ///< executable
  std::int64_t pid = 0;       ///< distinguishes several of one name
  float rate_hz = 0.0F;       ///< frames finished per second
  std::int64_t skipped = 0;   ///< frames passed over since its start
  std::int64_t lost = 0;      ///< frames that never arrived; -1 = unknown
  std::int64_t refused = 0;   ///< frames that could not be understood
  std::int64_t heard_us = 0;  ///< time of its reception, local clock
  bool ended = false;         ///< no status came within the heartbeat timeout of five seconds
};

/// Describes the stream at one moment.
struct StreamState {
  double frames_hz = 0.0;               ///< frames of the camera that arrive here per second
  std::vector<ProcessState> processes;  ///< processes of recent statuses, and ended ones of the last minute, by name
  std::optional<Teaching> teaching;     ///< of an object that is shown at present
  std::optional<WorldState> world;      ///< of a recent message of hs-track
  std::map<std::string, ChromaMap> colours;  ///< colour maps by camera, where hs-pose has learnt them
};

/// Keeps the rates of a stream. Every function may be called from any thread; times are microseconds of one clock.
class StreamWatch {
 public:
  void note_frame(std::int64_t now_us);
  void note_process(ProcessState process);
  void note_teaching(Teaching teaching, std::int64_t now_us);
  void note_colours(const CameraChroma& colours, std::int64_t now_us);
  void note_world(const WorldObjects& world, std::int64_t now_us);
  /// Notes the boxes of the objects of the next world: hs-track publishes them just before it.
  void note_placed(ObjectPlacements placed);

  /// A process that has been silent for five seconds has ended; it is listed for a minute more, unless another one of
  /// its name is alive. A teaching or a world that is silent for so long is gone.
  StreamState state(std::int64_t now_us);

 private:
  std::vector<ProcessState> listed_processes(std::int64_t now_us) const;

  std::mutex mutex_;
  std::deque<std::int64_t> arrivals_us_;
  std::map<std::pair<std::string, std::int64_t>, ProcessState> processes_;  // by name and process id
  std::optional<Teaching> teaching_;
  std::int64_t taught_us_ = 0;                                         // time of its reception
  std::map<std::string, std::pair<ChromaMap, std::int64_t>> colours_;  // map and time of its reception, by camera
  WorldState world_;
  std::optional<ObjectPlacements> placed_;                                // of the world that comes next
  std::int64_t world_us_ = std::numeric_limits<std::int64_t>::min() / 2;  // time of its reception
};

/// Selects the camera whose frames are shown, of those on the bus: the first one received until another one is
/// requested. May be used from any thread.
class SelectedCamera {
 public:
  /// A frame of this camera has come.
  void note(const std::string& channel);

  /// Selects the next camera in the order of their names.
  void next();

  /// While none was heard, each one is.
  bool is_shown(const std::string& channel) const;

  /// The channels of all cameras that were heard, in order.
  std::vector<std::string> heard() const;

 private:
  mutable std::mutex mutex_;
  std::set<std::string> heard_;
  std::string shown_;
};

}  // namespace houghstream::view
