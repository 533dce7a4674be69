#include "drivers/openni/camera_options.hpp"

#include <cstdio>

#include "pipeline/base/checks.hpp"

namespace houghstream::openni {

std::string mode_text(const CameraMode& mode) {
  return fmt::format("{}x{}@{}", mode.width, mode.height, mode.rate_hz);
}

std::string modes_text(const std::vector<CameraMode>& modes) {
  std::string text;
  for (const CameraMode& mode : modes) text += (text.empty() ? "" : ", ") + mode_text(mode);
  return text.empty() ? "none" : text;
}

CameraMode parse_camera_mode(const std::string& text) {
  CameraMode mode;
  int with_rate = -1;
  int size_only = -1;
  std::sscanf(text.c_str(), "%5dx%5d%n@%4d%n", &mode.width, &mode.height, &size_only, &mode.rate_hz, &with_rate);
  const int end = static_cast<int>(text.size());
  const bool positive = mode.width > 0 && mode.height > 0 && mode.rate_hz > 0;
  require((with_rate == end || size_only == end) && positive,
          "--mode '{}', expected WIDTHxHEIGHT or WIDTHxHEIGHT@RATE, for instance 640x480@30", text);
  return mode;
}

}  // namespace houghstream::openni
