#pragma once

#include <memory>
#include <string>

#include "drivers/frame_source.hpp"

namespace houghstream {

/// Frames that the source of a test scene gives: 10 s at 30 Hz.
inline constexpr int kRenderSourceFrames = 300;

/// A test scene (drivers/synth/scenes.hpp), rendered frame by frame as it is asked for; stamped like a dataset's
/// images. Throws InputError listing the known names.
std::unique_ptr<FrameSource> open_render_source(const std::string& name);

}  // namespace houghstream
