#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/types/camera.hpp"

namespace houghstream::virtual_camera {

/// Behaviour of the virtual camera, read from a text file with one "key value" per line; the value may contain blanks,
/// and # starts a comment. The file may be rewritten while the camera runs: keys that concern only new images take
/// effect with the next one.
struct CameraScript {
  std::string scene;                   ///< BOP scene folder that is played, again and again; empty: the test pattern
  std::vector<std::string> serials;    ///< one for each camera; default: VC0001
  std::vector<Camera> sizes;           ///< modes: sizes; of the test pattern only, a scene has its own
  int rate_hz = 30;                    ///< images per second, in all modes
  bool plugged = true;                 ///< whether the cameras are plugged in
  bool can_sync = true;                ///< depth and colour can be taken at the same time
  bool can_register = true;            ///< depth can be registered to colour
  bool registers_running = false;      ///< depth can be registered only while a stream runs
  int register_late = 0;               ///< depth images after that which are not registered yet
  double colour_phase_ms = 0.0;        ///< unless synchronised, colour is taken so long after depth
  double colour_late_ms = 0.0;         ///< colour arrives so long after it was taken
  int drop_depth_every = 0;            ///< each so-many-th depth image is lost; 0: none
  int drop_colour_every = 0;           ///< each so-many-th colour image is lost; 0: none
  double clock_ahead_ms = 0.0;         ///< a change makes the device's clock jump by the difference
  double clock_drift_ppm = 0.0;        ///< the device's clock runs faster by so much
  std::filesystem::path shutter_file;  ///< gets a line per depth image: number, device time, host utime
};

/// Throws InputError naming file and line. Without a file everything is at its default.
CameraScript read_camera_script(const std::filesystem::path& file);

}  // namespace houghstream::virtual_camera
