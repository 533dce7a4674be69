#pragma once

#include <string>
#include <vector>

#include "drivers/openni/camera_options.hpp"

namespace houghstream::openni {

/// Identity of a camera that is plugged in.
struct CameraDescription {
  std::string uri;  ///< OpenNI2's name of it; for USB cameras it holds bus and port
  std::string vendor;
  std::string name;
  std::string serial;             ///< empty where the driver does not state it
  std::vector<CameraMode> modes;  ///< modes of both depth and colour
};

/// The camera that is meant by a URI, "#1" (the first), a serial number, or "" (the first). Throws InputError naming
/// those that are there.
const CameraDescription& choose_camera(const std::vector<CameraDescription>& cameras, const std::string& selector);

/// Returns one line for each camera, as --list-devices prints them.
std::string cameras_text(const std::vector<CameraDescription>& cameras);

}  // namespace houghstream::openni
