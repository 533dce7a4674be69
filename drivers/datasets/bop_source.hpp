#pragma once

#include <filesystem>
#include <memory>

#include "drivers/frame_source.hpp"

namespace houghstream {

/// Frames of a BOP scene folder, in the order of their image ids, at 30 Hz.
std::unique_ptr<FrameSource> open_bop_source(const std::filesystem::path& folder);

}  // namespace houghstream
