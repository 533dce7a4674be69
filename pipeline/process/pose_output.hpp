#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/types/camera.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/object_pose.hpp"

namespace houghstream {

/// A frame, and how long it took to decode.
struct DecodedFrame {
  RgbdFrame frame;
  StageTime decoding;  ///< pose.decode
};

/// Decodes an images_t. Throws InputError where it is none.
DecodedFrame decode_for_poses(const std::vector<std::uint8_t>& bytes, const std::string& channel,
                              const std::optional<Camera>& camera);

/// Throws InputError for more detections at once than could be worked on within Heartbeat::kPatience.
void require_max_detections(const Detections& detections);

/// Where the transforms of poses go: to <OBJECT>_TO_CAMERA where there is one camera, to <OBJECT>_TO_<CAMERA'S CHANNEL>
/// where the channels are a pattern, and from the moment on when detections of another camera's frames are heard.
/// Every function may be called from any thread.
class TransformPublisher {
 public:
  TransformPublisher(LcmBus& bus, const std::string& frame_channels);

  /// Detections of a frame on this other channel have come.
  void note_other_camera(const std::string& channel);

  /// A rigid_transform_t for each valid pose.
  void publish(const ObjectPoses& poses);

 private:
  LcmBus& bus_;
  std::string frame_channels_;
  std::atomic<bool> several_cameras_;
};

}  // namespace houghstream
