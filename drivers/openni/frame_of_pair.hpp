#pragma once

#include <string>

#include "drivers/openni/openni_device.hpp"
#include "drivers/openni/timestamp_pairing.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/types/frame.hpp"

// What the source of a camera and that of a .oni file share.

namespace houghstream {

/// How far apart depth and colour may be taken: half the time between two images, and a little for jitter.
inline std::int64_t pairing_tolerance_us(const CameraMode& mode) {
  return std::int64_t{550'000} / mode.rate_hz;
}

inline RgbdFrame frame_of_pair(const ImagePair& pair, const Camera& camera, std::int64_t utime) {
  RgbdFrame frame;
  frame.id.utime = utime;
  frame.colour = pair.colour.image;
  frame.depth = depth_from_millimetres(pair.depth.image);
  frame.camera = camera;
  return frame;
}

/// The camera that the options name, else the device's nominal one. Throws InputError where sizes differ.
inline Camera camera_of_device(const OpenniDevice& device, const CameraOptions& options) {
  if (!options.camera) return device.nominal_camera();
  const Camera& camera = *options.camera;
  require(camera.width == device.mode().width && camera.height == device.mode().height,
          "--camera is for images of {}x{}, the images are {}", camera.width, camera.height, mode_text(device.mode()));
  return camera;
}

}  // namespace houghstream
