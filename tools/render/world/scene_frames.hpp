#pragma once

#include <vector>

#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/types/frame.hpp"
#include "tools/render/world/optics/shading.hpp"
#include "tools/render/world/scenes.hpp"

namespace houghstream {

/// The camera of everything rendered: 640x480, as the usual structured-light cameras.
Camera synthetic_camera();

/// A rendered frame with the truth about the taught objects in it.
struct SceneFrame {
  RgbdFrame frame;
  std::vector<TrueObject> objects;     ///< by id; those of which enough is seen
  std::vector<cv::Mat> visible_masks;  ///< CV_8UC1 0/255, one per object
};

/// Colour and measured depth seen from a camera. `noise_seed` names the frame's noise.
SceneFrame render_frame(const LitWorld& lit_world, const Eigen::Isometry3d& T_camera_world, std::uint64_t noise_seed);

/// Frame `index` of `count` along the scene's camera path. The utime is left 0: sources stamp their frames.
SceneFrame render_scene_frame(const Scene& scene, const LitWorld& lit_world, int index, int count);

}  // namespace houghstream
