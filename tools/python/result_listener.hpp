#pragma once

#include <chrono>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "pipeline/types/detection.hpp"
#include "pipeline/types/object_pose.hpp"
#include "pipeline/types/placed_objects.hpp"
#include "pipeline/types/tracked_object.hpp"

namespace houghstream {

struct ListenOptions {
  std::string url;             ///< as LcmBus takes it; a file:// log is read to its end
  std::string cameras = ".*";  ///< ChannelPattern of the frames whose results are wanted
  bool poses = true;           ///< results of hs-pose are wanted
  bool objects = true;         ///< those of hs-track are wanted
};

/// Poses of one frame, with the detections that they belong to where these have come before them.
struct PosedDetections {
  ObjectPoses poses;
  std::optional<Detections> detections;
};

/// The world after a frame, with what its objects take up where that has come before it.
struct PlacedWorld {
  WorldObjects world;
  std::optional<ObjectPlacements> placed;
};

using StreamResult = std::variant<PosedDetections, PlacedWorld>;

/// Receives the results of a stream for a program that takes them one after another. Of a network the newest frame's
/// results of each camera wait: a slow program misses frames and never lags behind. Of a log each result is returned.
/// One thread may call it; it receives in a thread of its own.
class ResultListener {
 public:
  /// Throws InputError where the URL is none, the log cannot be read, the network cannot be reached, or the pattern is
  /// none.
  explicit ResultListener(const ListenOptions& options);
  ~ResultListener();

  /// Returns the next result; nothing where none has come within `timeout`, and at the end of a log. Throws InputError
  /// where the log is damaged or the network fails.
  std::optional<StreamResult> next(std::chrono::milliseconds timeout);

  /// Returns whether a log has been read to its end and all of its results have been returned.
  bool has_ended() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace houghstream
