#pragma once

#include "tools/render/world/rooms/put_down.hpp"

namespace houghstream::world {

/// Gives the position at which a hand holds an object.
struct HeldPlace {
  Eigen::Vector2d over = Eigen::Vector2d::Zero();  ///< the point of the table below it, metres
  double arm_azimuth_rad = 0.0;                    ///< direction of the arm about z; 0 = from +x
  std::vector<Eigen::Isometry3d> views;            ///< T_camera_world of the views that will be rendered
};

/// Height at which objects are held, from the table to their lowest point, metres.
inline constexpr double kMinHeldM = 0.05;
inline constexpr double kMaxHeldM = 0.30;

/// Fraction of a held object that the hand occludes, over the views.
inline constexpr double kMinGripped = 0.10;
inline constexpr double kMaxGripped = 0.35;

/// Returns a rotation, uniform over all (Shoemake, "Uniform Random Rotations", Graphics Gems III, 1992).
Eigen::Matrix3d any_attitude(Random& random);

/// Makes a hand at the end of an arm that holds a placed asset: it occludes 10 to 35 % of it over the views. Its axes
/// are its `T_world_object`'s columns, the first from the asset towards the arm. Throws InputError where no such grip
/// is found.
PlacedAsset take_hold(const PlacedAsset& placed, const HeldPlace& place, Random& random);

/// Puts an object over the table in any attitude into a hand at the end of an arm; the group's first member is the
/// hand. The group frame is the world's. Throws InputError where no grip is found that occludes 10 to 35 % of it.
AssetGroup hold(const AssetPtr& thing, int object_id, const HeldPlace& place, Random& random);

}  // namespace houghstream::world
