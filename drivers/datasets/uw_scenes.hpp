#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "drivers/files/frame_folder.hpp"

namespace houghstream {

/// An annotated object: its instance ("coffee_mug_5", the names of read_uw_training_views) and where it is seen.
struct UwBox {
  std::string name;
  cv::Rect box_px;
};

struct UwSceneFrame {
  FrameFiles images;
  std::vector<UwBox> boxes;
};

/// A video of the UW RGB-D Scenes Dataset (Lai, Bo, Ren, Fox, ICRA 2011; the first version, not v2). `folder` is
/// SCENE/SCENE_K with SCENE_K_N.png and SCENE_K_N_depth.png (uint16 millimetres), N from 1; beside it lies SCENE_K.mat.
/// Of that file we rely on what published readers of it rely on: a cell array `bboxes` with one cell for each frame in
/// order, each empty or a struct array with `category` (text), `instance` (number), `top`, `bottom`, `left` and `right`
/// (pixels of the box, first and last one included; MATLAB counts them from 1). An edge one pixel outside the image is
/// taken as its border. Throws InputError naming the file where frames or boxes are missing, unreadable or absurd.
std::vector<UwSceneFrame> read_uw_scene(const std::filesystem::path& folder, const cv::Size& image_size);

}  // namespace houghstream
