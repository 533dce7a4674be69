#include "tools/capture/capture_options.hpp"

#include <utility>

#include "drivers/datasets/open_frame_source.hpp"
#include "drivers/files/camera_info.hpp"
#include "drivers/openni/camera_options.hpp"
#include "drivers/openni/camera_source.hpp"
#include "drivers/openni/openni_device.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/printable.hpp"
#include "tools/common/usage_error.hpp"

namespace houghstream::capture {
namespace {

struct Specification {
  std::string kind;
  std::string value;  // behind the first colon
};

Specification split(const std::string& source) {
  const std::size_t colon = source.find(':');
  return {source.substr(0, colon), colon == std::string::npos ? "" : source.substr(colon + 1)};
}

openni::CameraOptions camera_options(const SourceOptions& options) {
  openni::CameraOptions live = options.live;
  if (options.mode) live.mode = openni::parse_camera_mode(*options.mode);
  live.auto_exposure = !options.fixed_exposure;
  live.auto_white_balance = !options.fixed_white_balance;
  if (!options.camera.empty()) live.camera = camera_of_option(options.camera);
  return live;
}

/// Throws InputError for an option that only a camera can heed.
void require_no_camera_option(const SourceOptions& options) {
  const std::pair<const char*, bool> given[] = {{"--mode", options.mode.has_value()},
                                                {"--no-auto-exposure", options.fixed_exposure},
                                                {"--no-auto-white-balance", options.fixed_white_balance},
                                                {"--assume-registered", options.live.assume_registered},
                                                {"--record", !options.live.record.empty()},
                                                {"--record-jpeg", options.live.record_jpeg}};
  for (const auto& [name, is_given] : given)
    require_usage(!is_given, "{} goes with --source openni2, not with {}", name, options.source);
}

}  // namespace

void add_source_options(CommandLine& app, SourceOptions& options) {
  app.add_option("--source", options.source,
                 "openni2[:CAMERA] (CAMERA is a URI, #1, #2, ... or a serial number; default: the first), oni:FILE, "
                 "bop:DIR, uw:DIR, tum:DIR or bag:FILE (ROS 1)");
  app.add_option("--camera", options.camera,
                 "openni2, oni: intrinsics, a ROS camera_info YAML file or WIDTHxHEIGHT,fx,fy,cx,cy; default: from the "
                 "field of view that the device states");
  app.add_option("--mode", options.mode, "openni2: size and rate, WIDTHxHEIGHT@RATE")
      .default_str(openni::mode_text(openni::CameraMode()));
  app.add_flag("--no-auto-exposure", options.fixed_exposure, "openni2: leave the exposure as it is");
  app.add_flag("--no-auto-white-balance", options.fixed_white_balance, "openni2: leave the white balance as it is");
  app.add_flag("--assume-registered", options.live.assume_registered,
               "openni2: the camera's depth is registered to colour without being asked");
  app.add_option("--record", options.live.record, "openni2: also record to this .oni file, 60 MB a second");
  app.add_flag("--record-jpeg", options.live.record_jpeg, "with --record: colour as JPEG, much smaller, with losses");
}

std::unique_ptr<FrameSource> open_source(const SourceOptions& options, const openni::CameraListener& listener) {
  const auto [kind, value] = split(options.source);
  if (kind == "openni2") {
    require_usage(!options.live.record_jpeg || !options.live.record.empty(),
                  "--record-jpeg goes with --record FILE.oni");
    return openni::open_camera_source(value, camera_options(options), listener);
  }
  require_no_camera_option(options);
  if (kind == "oni" && !value.empty())
    return openni::open_oni_source(value, camera_options(options), listener.stop_requested);
  require_usage(options.camera.empty(), "--camera goes with --source openni2 or oni, not with {}", options.source);
  require_usage(kind != "klg" && kind != "log",
                "source '{}': of recordings hs-log import makes a log, and lcm-logplayer plays logs", options.source);
  return open_frame_source(options.source, "openni2, openni2:CAMERA, oni:FILE, ");
}

std::string devices_text() {
  const std::vector<openni::CameraDescription> cameras = openni::list_cameras(true);
  if (cameras.empty()) return "no camera found by OpenNI2's drivers";
  return openni::cameras_text(cameras);
}

OrderedJson devices_json() {
  const auto known = [](const std::string& text) {
    return text.empty() ? OrderedJson() : OrderedJson(printable(text));
  };
  OrderedJson devices = OrderedJson::array();
  for (const openni::CameraDescription& camera : openni::list_cameras(true)) {
    OrderedJson device;
    device["uri"] = printable(camera.uri);
    device["vendor"] = known(camera.vendor);
    device["name"] = known(camera.name);
    device["serial"] = known(camera.serial);
    device["modes"] = OrderedJson::array();
    for (const openni::CameraMode& mode : camera.modes)
      device["modes"].push_back({{"width", mode.width}, {"height", mode.height}, {"rate_hz", mode.rate_hz}});
    devices.push_back(std::move(device));
  }
  return devices;
}

}  // namespace houghstream::capture
