#pragma once

#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pose/reconstruction/model_agreement.hpp"
#include "pose/reconstruction/tracking/take.hpp"

namespace houghstream::reconstruction {

/// What a take says of its object.
struct ShownModel {
  Mesh mesh;               ///< metres; origin at the middle of its foot, z up as it stood; closed, normals, colours
  std::vector<bool> seen;  ///< per vertex: some view shows it; the others close the surface
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();  ///< world: of the take
  std::vector<ShownView> views;                                      ///< those that show it, in the keyframes' order
  double agreement_m = 0.0;   ///< see disagreement(), of all views that the model is made of
  double seen_through = 0.0;  ///< see seen_through_share()
};

struct ModelMaking {
  double voxel_m = 0.0015;  ///< of the model; twice that for what is larger than 0.3 m
  double coarse_voxel_m = 0.004;
  double foot_m = 0.005;   ///< below that table and object are not told apart: the object is continued downwards
  double beside_m = 0.01;  ///< of the object that may belong to it
  int threads = 1;         ///< any number gives the same result
};

/// Makes the model of a take's object: all that the keyframes show in its place is fused (Curless & Levoy 1996), the
/// part that hangs together above the table where the object was chosen is kept, and the masks come of that model and
/// of the depth, so that they hold neither table nor hand. Throws InputError where there is no such part.
ShownModel make_model(const Take& take, const ModelMaking& settings);

/// DepthView::light of the take's keyframes: `number` where the camera moved and the light stood still about the
/// object.
int light_of(const Take& take, int number);

}  // namespace houghstream::reconstruction
