#pragma once

#include <memory>
#include <optional>
#include <string>

#include "drivers/files/json_file.hpp"
#include "drivers/frame_source.hpp"
#include "drivers/openni/camera_options.hpp"
#include "tools/common/command_line.hpp"

namespace houghstream::capture {

/// Options of the source and of a camera.
struct SourceOptions {
  std::string source;
  openni::CameraOptions live;
  std::optional<std::string> mode;  ///< see parse_camera_mode; default: that of CameraMode
  std::string camera;
  bool fixed_exposure = false;
  bool fixed_white_balance = false;
};

void add_source_options(CommandLine& app, SourceOptions& options);

/// Opens openni2[:CAMERA], oni:FILE, or what open_frame_source() knows. Throws InputError, also for an option that the
/// source cannot heed.
std::unique_ptr<FrameSource> open_source(const SourceOptions& options, const openni::CameraListener& listener);

/// Returns the text of --list-devices: the connected cameras. Throws InputError where OpenNI2 finds no driver.
std::string devices_text();

/// Returns the same for scripts: [{"uri", "vendor", "name", "serial", "modes": [{"width", "height", "rate_hz"}]}].
/// Values that the driver does not state are null.
OrderedJson devices_json();

}  // namespace houghstream::capture
