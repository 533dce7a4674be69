#pragma once

#include <filesystem>
#include <memory>

#include "drivers/frame_source.hpp"

namespace houghstream {

/// Frames of a flat folder (drivers/files/frame_folder.hpp) in natural order, at 30 Hz.
std::unique_ptr<FrameSource> open_uw_source(const std::filesystem::path& folder, const Camera& camera);

}  // namespace houghstream
