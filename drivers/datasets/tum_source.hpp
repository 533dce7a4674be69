#pragma once

#include <filesystem>
#include <memory>

#include "drivers/frame_source.hpp"

namespace houghstream {

/// Frames of a folder of the TUM RGB-D benchmark (Sturm et al., IROS 2012): rgb.txt and depth.txt with lines "SECONDS
/// FILE", # for comments; depth registered to colour, 5000 steps a metre. Each depth image is paired with the colour
/// image nearest in time, within 20 ms and none used twice, the closest pairs first; what finds no partner is left out.
/// A frame takes the depth's time. Throws InputError where lists or images are missing or nothing can be paired.
std::unique_ptr<FrameSource> open_tum_source(const std::filesystem::path& folder, const Camera& camera);

}  // namespace houghstream
