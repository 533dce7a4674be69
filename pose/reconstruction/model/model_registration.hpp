#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream::reconstruction {

/// A model of which only a part was observed.
struct PartialModel {
  const Mesh* mesh = nullptr;
  const std::vector<bool>* observed = nullptr;  ///< whether each vertex was observed
};

struct ModelRegistration {
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  ///< motion from model b's frame to model a's
  double median_m = 0.0;  ///< median distance of b's observed surface from a's, where both were observed
};

/// Registers model b to model a of the same object: starting from rotations spread over all directions, or about z
/// alone where both stand `upright`, by point-to-plane registration under Tukey's weights (Chen & Medioni 1992).
/// Distance and colour select the best result. Returns nothing where none is within 4 mm. The same input gives the same
/// result.
std::optional<ModelRegistration> register_models(const PartialModel& a, const PartialModel& b, bool upright,
                                                 int threads);

}  // namespace houghstream::reconstruction
