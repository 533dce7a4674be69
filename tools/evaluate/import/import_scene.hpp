#pragma once

#include <filesystem>

#include "pipeline/types/camera.hpp"

namespace houghstream {

/// Turns SOURCE/boxes.json (drawn_boxes.hpp) with SOURCE/FRAME_color.png and FRAME_depth.png into a BOP scene whose
/// objects have boxes only: scene_gt.json without poses, scene_gt_info.json with visib_fract 1, names.json with ids in
/// the order of the names. Returns the number of frames. Throws InputError.
int import_boxes(const std::filesystem::path& source, const std::filesystem::path& scene_folder);

/// Turns a video of the UW RGB-D Scenes Dataset into a BOP scene whose objects have boxes only, as import_boxes()
/// writes them. `video` is SCENE/SCENE_K with SCENE_K_N.png and SCENE_K_N_depth.png (uint16 millimetres), N from 1;
/// beside it lies SCENE_K.mat (uw_boxes.py says what of it is read). Returns the number of frames. Throws InputError.
int import_uw_scene(const std::filesystem::path& video, const Camera& camera,
                    const std::filesystem::path& scene_folder);

}  // namespace houghstream
