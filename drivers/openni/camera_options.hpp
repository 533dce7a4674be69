#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/types/camera.hpp"

// Settings of a camera, and the callbacks of its events.

namespace houghstream::openni {

/// Gives the size and rate of a camera's images, the same for depth and colour.
struct CameraMode {
  int width = 640;
  int height = 480;
  int rate_hz = 30;
};

inline bool operator==(const CameraMode& a, const CameraMode& b) {
  return a.width == b.width && a.height == b.height && a.rate_hz == b.rate_hz;
}

/// Returns a text such as "640x480@30".
std::string mode_text(const CameraMode& mode);

/// Returns a text such as "640x480@30, 320x240@30"; "none" for no mode.
std::string modes_text(const std::vector<CameraMode>& modes);

/// Parses WIDTHxHEIGHT or WIDTHxHEIGHT@RATE, the form of the option --mode; 30 Hz without a rate. Throws InputError.
CameraMode parse_camera_mode(const std::string& text);

/// Settings of a camera.
struct CameraOptions {
  CameraMode mode;
  bool auto_exposure = true;
  bool auto_white_balance = true;
  /// Depth must be registered to colour by the camera; a camera that cannot is refused, unless this option asserts that
  /// its depth is registered anyhow.
  bool assume_registered = false;
  std::optional<Camera> camera;  ///< intrinsics; default: from the colour sensor's field of view
  std::string record;            ///< record to this .oni file, or where it is there, to FILE_2.oni and so on
  bool replace_record = false;   ///< a file that is there is replaced instead, but not one of the same run
  bool record_jpeg = false;      ///< colour as JPEG in it: a fifth of the size, but no longer bit by bit what was seen
};

/// Returns whether the process that runs a camera is to end. An empty function means never.
using StopRequested = std::function<bool()>;

/// Callbacks of a camera to the process that runs it. Each may be empty.
struct CameraListener {
  StopRequested stop_requested;                              ///< asked ten times a second or more
  std::function<void(const std::string& reason)> on_error;   ///< the camera is gone, is back, cannot be opened
  std::function<void(std::int64_t number)> on_depth_number;  ///< the device's count of each depth image that is used
};

}  // namespace houghstream::openni
