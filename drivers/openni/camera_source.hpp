#pragma once

#include <memory>
#include <string>

#include "drivers/frame_source.hpp"
#include "drivers/openni/camera_options.hpp"

namespace houghstream::openni {

/// Opens the frames of an OpenNI2 camera as they come. `selector` is a URI, "#1", a serial number, or "" for the first
/// one. A frame is a depth image with the colour image that was taken nearest to it; its utime is the depth image's
/// capture time on the host's clock. A camera that disappears is waited for and opened again; next() returns nothing
/// only when the listener asks to stop. Throws InputError where the camera is not there at the start, or lacks a
/// requested mode.
std::unique_ptr<FrameSource> open_camera_source(const std::string& selector, const CameraOptions& options,
                                                const CameraListener& listener);

/// Opens the frames of a .oni file, every one, stamped from dataset_utime(0) on at the intervals of the recording; of
/// the options only `camera` counts. It ends early where a stop is requested. Throws InputError where the file cannot
/// be read to its end.
std::unique_ptr<FrameSource> open_oni_source(const std::string& file, const CameraOptions& options,
                                             const StopRequested& stop_requested = {});

}  // namespace houghstream::openni
