#include "tools/capture/capture_options.hpp"

#include "drivers/openni/camera_options.hpp"
#include "drivers/openni/camera_source.hpp"
#include "drivers/openni/openni_device.hpp"
#include "pipeline/base/checks.hpp"

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
  live.mode = openni::parse_camera_mode(options.mode);
  live.auto_exposure = !options.fixed_exposure;
  live.auto_white_balance = !options.fixed_white_balance;
  if (!options.camera.empty()) live.camera = openni::camera_of_option(options.camera);
  return live;
}

}  // namespace

void add_source_options(CommandLine& app, SourceOptions& options) {
  app.add_option("--source", options.source,
                 "openni2[:CAMERA] (CAMERA is a URI, #1, #2, ... or a serial number; default: the first), oni:FILE, "
                 "bop:DIR, uw:DIR or tum:DIR");
  app.add_option("--camera", options.camera,
                 "openni2, oni: intrinsics, a ROS camera_info YAML file or WIDTHxHEIGHT,fx,fy,cx,cy; default: from the "
                 "field of view that the device states");
  app.add_option("--mode", options.mode, "openni2: size and rate, WIDTHxHEIGHT@RATE").capture_default_str();
  app.add_flag("--no-auto-exposure", options.fixed_exposure, "openni2: leave the exposure as it is");
  app.add_flag("--no-auto-white-balance", options.fixed_white_balance, "openni2: leave the white balance as it is");
  app.add_flag("--assume-registered", options.live.assume_registered,
               "openni2: the camera's depth is registered to colour without being asked");
  app.add_option("--record", options.live.record, "openni2: also record to this .oni file, 60 MB a second");
  app.add_flag("--record-jpeg", options.live.record_jpeg, "with --record: colour as JPEG, much smaller, with losses");
}

std::unique_ptr<FrameSource> open_source(const SourceOptions& options, const openni::CameraListener& listener) {
  const auto [kind, value] = split(options.source);
  const bool live = kind == "openni2";
  require(live || options.live.record.empty(), "--record goes with --source openni2, not with {}", options.source);
  if (live) return openni::open_camera_source(value, camera_options(options), listener);
  if (kind == "oni" && !value.empty())
    return openni::open_oni_source(value, camera_options(options), listener.stop_requested);
  require(options.camera.empty(), "--camera goes with --source openni2 or oni, not with {}", options.source);
  return open_frame_source(options.source);
}

std::string devices_text() {
  const std::vector<openni::CameraDescription> cameras = openni::list_cameras(true);
  if (cameras.empty()) return "no camera found by OpenNI2's drivers";
  return openni::cameras_text(cameras);
}

}  // namespace houghstream::capture
