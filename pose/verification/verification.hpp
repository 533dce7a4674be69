#pragma once

#include <Eigen/Geometry>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/frame.hpp"
#include "pose/region.hpp"

namespace houghstream {

/// Comparison of the model with what is measured, at a pose.
struct VerificationSettings {
  double tolerance_m = 0.008;  ///< measured and model depth agree; 3 sigma is added
  int points = 600;            ///< of a view whose colours are compared
};

/// The rendered model against the measured depth, pixel by pixel.
struct Verification {
  int rendered = 0;                ///< pixels of the model inside the image
  int agreeing = 0;                ///< measured within the tolerance
  int violating = 0;               ///< measured behind the model: the camera saw through it
  int occluded = 0;                ///< measured in front of the model; says nothing about the pose
  int outline_ends = 0;            ///< places just outside the outline where the surface ends: measured well behind it
  int outline_continues = 0;       ///< where the measured surface goes on as if there were no outline
  float visible_fraction() const;  ///< agreeing of rendered, 0 if nothing is rendered
  float free_space_violation() const;  ///< violating of rendered, 0 if nothing is rendered
};

Verification verify_pose(const RgbdFrame& frame, const Mesh& mesh, const Eigen::Isometry3d& T_camera_object,
                         const DepthTolerance& tolerance);

}  // namespace houghstream
