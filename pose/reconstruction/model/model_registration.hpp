#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream::reconstruction {

/// A model with what of it was seen.
struct PartlySeen {
  const Mesh* mesh = nullptr;
  const std::vector<bool>* seen = nullptr;  ///< per vertex
};

struct ModelRegistration {
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  ///< motion from model b's frame to model a's
  double median_m = 0.0;  ///< distance of b's seen surface from a's, where both were seen
};

/// Lays model b on model a, of the same object: from rotations all round, or about z alone where both stand `upright`,
/// by point-to-plane registration under Tukey's weights (Chen & Medioni 1992), chosen by distance and colour. None
/// where nothing fits within 4 mm. Same input, same result.
std::optional<ModelRegistration> register_models(const PartlySeen& a, const PartlySeen& b, bool upright, int threads);

}  // namespace houghstream::reconstruction
