#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "drivers/openni/camera_mode.hpp"
#include "pipeline/types/camera.hpp"

namespace houghstream {

/// How a camera is to be run.
struct CameraOptions {
  CameraMode mode;
  bool auto_exposure = true;
  bool auto_white_balance = true;
  /// Depth is registered to colour by the camera; one that cannot is refused, unless this says that its depth comes
  /// registered anyhow.
  bool assume_registered = false;
  std::optional<Camera> camera;  ///< intrinsics; default: from the colour sensor's field of view
  std::string record;            ///< record to this .oni file; after an absence, to FILE_2.oni and so on
  bool record_jpeg = false;      ///< colour as JPEG in it: a fifth of the size, but no longer bit by bit what was seen
};

/// What a camera says to the process that runs it, and asks it. Each may be left empty.
struct CameraListener {
  std::function<bool()> stop_requested;                    ///< asked ten times a second or more
  std::function<void(const std::string& reason)> trouble;  ///< the camera is gone, is back, cannot be opened
  std::function<void(std::int64_t number)> depth_number;   ///< the device's count of each depth image that is used
};

}  // namespace houghstream
