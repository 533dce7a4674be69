#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "pipeline/types/camera.hpp"
#include "tools/render/world/objects/asset.hpp"

// A world to be photographed. World frame: z up, metres, origin on the middle of the table top (or turntable).

namespace houghstream::world {

/// Holds an asset with its pose.
struct PlacedAsset {
  AssetPtr thing;
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  int object_id = 0;         ///< TaughtObject::id of an object in the ground truth, else 0
  bool casts_shadow = true;  ///< false for walls: lamps may stand behind them
};

/// A lamp or window, far enough away to be a point, with a penumbra as if it had a size.
struct Light {
  Eigen::Vector3d position_world = Eigen::Vector3d(0.0, 0.0, 2.0);
  Eigen::Vector3f colour_bgr = Eigen::Vector3f::Ones();  ///< linear, what a white surface facing it reflects
  double penumbra_m = 0.02;                              ///< radius over which shadow edges fade
  bool casts_shadow = true;
};

/// Settings of the simulated colour camera.
struct ColourCameraSettings {
  double mean_level = 0.2;         ///< automatic exposure brings the image's mean towards this, linear, 0 to 1
  double exposure_bias = 1.0;      ///< factor on what automatic exposure chose
  std::optional<double> exposure;  ///< factor on the light, where it is not chosen from the image itself
  double blur_px = 0.6;            ///< standard deviation of the lens's blur, pixels
  double shot_noise = 0.008;       ///< deviation of the noise at full level; grows with the square root of the level
  double read_noise = 0.003;       ///< deviation of the noise at level 0
  double vignetting = 0.15;        ///< light lost in the corners, 0 to 1
  Eigen::Vector3f white_balance_bgr = Eigen::Vector3f::Ones();
};

/// Returns the camera of nearly all renderings: 640x480, as the usual structured-light cameras.
Camera synthetic_camera();

struct World {
  std::vector<PlacedAsset> items;
  std::vector<Light> lights;
  Eigen::Vector3f ambient_bgr = Eigen::Vector3f::Constant(0.3F);  ///< linear light from everywhere
  double focus_radius_m = 1.2;  ///< shadows are kept within this distance of the origin
  ColourCameraSettings photo;
  Camera camera = synthetic_camera();
};

/// Returns the pose of a camera at `eye` looking at `target` with the image upright.
Eigen::Isometry3d look_at(const Eigen::Vector3d& eye_world, const Eigen::Vector3d& target_world);

}  // namespace houghstream::world
