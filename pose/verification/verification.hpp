#pragma once

#include <Eigen/Geometry>

#include "pipeline/base/settings_fields.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/frame.hpp"
#include "pose/seen/depth_score.hpp"
#include "pose/seen/region.hpp"

namespace houghstream {

/// Comparison of the model with what is measured, at a pose.
struct VerificationSettings {
  double tolerance_m = kDepthTolerance_m;  ///< measured and model depth agree; 3 sigma is added
  int points = 600;                        ///< number of a view's points whose colours are compared
};

template <typename Visit>
void fields(const VerificationSettings& /*settings*/, const Visit& visit) {
  using S = VerificationSettings;
  visit(number("tolerance_m", &S::tolerance_m, 0, 1, "m"));
  visit(number("points", &S::points, 1, 100000));
}

/// Counts from the comparison of the rendered model with the measured depth, pixel by pixel.
struct Verification {
  int rendered = 0;                     ///< pixels of the model inside the image
  int depth_inliers = 0;                ///< measured within the tolerance
  int free_space_violations = 0;        ///< measured behind the model: the camera saw through it
  int occluded = 0;                     ///< measured in front of the model; neutral for the pose
  int boundary_samples = 0;             ///< places where the model's outline was looked across
  float boundary_continuations = 0.0F;  ///< samples where the scene continues across it, see BoundarySample
  float visible_fraction() const;       ///< depth inliers over rendered pixels; 0 if nothing is rendered
  float free_space_violation() const;   ///< free-space violations over rendered pixels; 0 if nothing is rendered
};

/// Returns the counts, without the boundary's, at the projected points instead of the rendered pixels, which cover the
/// view evenly. Points at grazing angles are left out, since the view's direction is only near the pose's.
Verification verify_projected_view(const ProjectedView& projected, const DepthTolerance& tolerance);

/// Renders the model and compares it with the frame. `colours` are those of the frame about the object; with nullptr
/// any colour counts as continued.
Verification verify_pose(const RgbdFrame& frame, const Mesh& mesh, const Eigen::Isometry3d& T_camera_object,
                         const DepthTolerance& tolerance, const LabRegion* colours = nullptr);

}  // namespace houghstream
