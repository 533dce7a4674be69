#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Names an image pair of a flat folder, such as the scenes of the UW RGB-D datasets.
struct FrameFiles {
  std::string name;
  std::filesystem::path colour;  ///< NAME_color.png, NAME-color.png or NAME.png
  std::filesystem::path depth;   ///< NAME_depth.png or NAME-depth.png, uint16 millimetres
};

/// Returns whether an existing folder holds image pairs or parts of them. An image without depth counts too, so that
/// its folder is refused and not passed over.
bool has_frame_pairs(const std::filesystem::path& folder);

/// Returns all pairs of a folder in natural order. Throws InputError when the folder is missing or without pairs, or an
/// image lacks its partner.
std::vector<FrameFiles> list_frame_pairs(const std::filesystem::path& folder);

/// Returns `folder` itself and those anywhere below it that hold image pairs, in natural order, for instance the
/// background videos of the UW datasets (background/background_K/). Throws InputError when there is none.
std::vector<std::filesystem::path> list_frame_folders(const std::filesystem::path& folder);

/// Throws InputError when the images are unreadable or their sizes disagree with each other or with the camera.
RgbdFrame read_frame_pair(const FrameFiles& pair, const Camera& camera, std::int64_t utime);

}  // namespace houghstream
