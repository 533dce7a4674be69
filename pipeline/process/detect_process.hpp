#pragma once

#include <functional>
#include <optional>
#include <string>

#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/types/chroma_map.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/known_objects.hpp"
#include "pipeline/types/object_pose.hpp"

namespace houghstream {

struct DetectProcessOptions {
  std::string process = "hs-detect";             ///< its name in status_t
  std::string frame_channels = channel::kFrame;  ///< a ChannelPattern: one camera's channel, or several cameras'
  std::optional<Camera> camera;                  ///< camera of frames that do not bring their own
  /// Looks per second of each camera (--looks-per-second); 0 = as many as possible. A look is a run of the detector on
  /// a frame.
  double max_rate_hz = 0.0;
  bool keep_frames = false;               ///< for a log: copies the frames' events to the output log too
  std::function<KnownObjects()> objects;  ///< objects of its store, for the status; empty = no store
  /// Called on a network, in the receiving thread, with the poses of any camera's frame; empty = not called.
  std::function<void(const ObjectPoses&)> on_poses;
  /// Called on a network, in the receiving thread, with the colours that hs-pose has learnt of a camera; empty = not
  /// called.
  std::function<void(const CameraChroma&)> on_camera_colours;
};

using DetectObjects = std::function<Detections(const RgbdFrame&)>;

/// Receives frames and publishes `detect`'s result for each one that is processed: on a network always the newest of
/// each camera, the cameras in turn; from a log every one. Results have the frame id, whatever `detect` sets.
/// With `max_rate_hz` the frames between two detections are skipped, by their own times, so that a log is processed
/// alike each time; when hs-pose reports that it has lost an object that it followed, the next detection for that
/// camera comes sooner. A frame that cannot be understood is counted, reported and dropped; where the channels are a
/// pattern, messages that are no images_t are ignored. Throws InputError where frames are to be kept without a log;
/// returns as run_process_loop does.
void run_detect_process(LcmBus& bus, const DetectProcessOptions& options, const DetectObjects& detect);

}  // namespace houghstream
