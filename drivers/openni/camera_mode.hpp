#pragma once

#include <string>
#include <vector>

namespace houghstream {

/// Size and rate of a camera's images, the same for depth and colour.
struct CameraMode {
  int width = 640;
  int height = 480;
  int rate_hz = 30;
};

inline bool operator==(const CameraMode& a, const CameraMode& b) {
  return a.width == b.width && a.height == b.height && a.rate_hz == b.rate_hz;
}

/// "640x480@30".
std::string mode_text(const CameraMode& mode);

/// "640x480@30, 320x240@30"; "none" for no mode.
std::string modes_text(const std::vector<CameraMode>& modes);

/// Parses WIDTHxHEIGHT or WIDTHxHEIGHT@RATE, the form of the option --mode; 30 Hz without a rate. Throws InputError.
CameraMode parse_camera_mode(const std::string& text);

}  // namespace houghstream
