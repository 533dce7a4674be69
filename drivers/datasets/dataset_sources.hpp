#pragma once

#include <filesystem>
#include <memory>

#include "drivers/frame_source.hpp"

// Datasets on disk as sources of frames. All throw InputError where files are missing or no images.

namespace houghstream {

/// Opens the frames of a BOP scene folder, in the order of their image ids, at 30 Hz.
std::unique_ptr<FrameSource> open_bop_source(const std::filesystem::path& folder);

/// Opens the frames of a flat folder (drivers/files/frame_folder.hpp) in natural order, at 30 Hz.
std::unique_ptr<FrameSource> open_uw_source(const std::filesystem::path& folder, const Camera& camera);

/// Opens the frames of a folder of the TUM RGB-D benchmark (Sturm et al., IROS 2012): rgb.txt and depth.txt with lines
/// "SECONDS FILE", # for comments; depth registered to colour, 5000 steps a metre. Each depth image is paired with the
/// colour image nearest in time, within 20 ms and none used twice, the closest pairs first; images without a partner
/// are left out. A frame takes the depth's time. Throws InputError where lists or images are missing or nothing can be
/// paired.
std::unique_ptr<FrameSource> open_tum_source(const std::filesystem::path& folder, const Camera& camera);

}  // namespace houghstream
