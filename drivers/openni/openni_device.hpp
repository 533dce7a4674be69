#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/openni/camera_choice.hpp"
#include "drivers/openni/camera_options.hpp"
#include "drivers/openni/timestamp_pairing.hpp"

namespace houghstream::openni {

/// Interval at which stop requests and unplugged cameras are polled.
inline constexpr std::chrono::milliseconds kPollInterval(50);

/// Timeout for an image of a file: disks may be asleep.
inline constexpr std::chrono::seconds kFileTimeout(5);

/// The cameras that OpenNI2's drivers have found. `closely` also opens each for its serial number and modes, which
/// stay empty where it cannot be opened, for instance because another process uses it. Throws InputError where
/// OpenNI2 finds no driver.
std::vector<CameraDescription> list_cameras(bool closely);

/// Keeps OpenNI2 running, so that it notices cameras that come and go, until the last holder lets go of it. Throws
/// InputError where it finds no driver.
std::shared_ptr<const void> keep_openni_running();

/// Runs a camera or a .oni file through OpenNI2, from construction to destruction. All code that knows OpenNI2 is
/// behind it. It must be used from a thread that lasts as long as the process, see PersistentThread.
class OpenniDevice {
 public:
  /// Opens a camera: registered, synchronised where it can, not mirrored. Throws InputError where it lacks the mode
  /// (listing those it has) or the registration. Waiting here and in wait() ends as soon as `stop_requested` returns
  /// true.
  static std::unique_ptr<OpenniDevice> open_camera(const std::string& uri, const CameraOptions& options,
                                                   const StopRequested& stop_requested = {});

  /// Opens a .oni file, which gives each image as soon as it is asked for. Throws InputError.
  static std::unique_ptr<OpenniDevice> open_file(const std::string& file, const StopRequested& stop_requested = {});

  ~OpenniDevice();

  /// Returns the next image in the order of arrival; nothing after `timeout`. A camera's first images, which may be
  /// from before its depth was registered, are left out, and so is one that does not match the mode, for instance cut
  /// short on the way; in a file it makes this throw InputError, as does a file's end before all its images have come.
  std::optional<SensorImage> wait(std::chrono::milliseconds timeout);

  /// The camera has been unplugged, or all images of the file have been given.
  bool ended() const;

  const CameraMode& mode() const;

  /// Returns the camera of the options, else the nominal one. Throws InputError where its size is not the mode's.
  Camera camera(const CameraOptions& options) const;

  /// Returns intrinsics from the colour sensor's field of view, with the principal point in the middle. Throws
  /// InputError where the device does not state it.
  Camera nominal_camera() const;

 private:
  struct State;
  explicit OpenniDevice(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace houghstream::openni
