#include "tools/studies/tracks/matching.hpp"

#include <algorithm>
#include <limits>

#include "pose/model/symmetry.hpp"
#include "pose/tracks/assignment.hpp"

namespace houghstream::studies {

Eigen::Isometry3d as_the_truth(const PublishedObject& object, const TrueInstance& truth,
                               const ClassSymmetries& symmetries) {
  const auto known = symmetries.find(truth.class_name);
  if (known == symmetries.end()) return object.T_world_object;
  return nearest_equivalent(object.T_world_object, *truth.T_world_object, known->second);
}

double apart_m(const TrueInstance& truth, const PublishedObject& object, const ClassSymmetries& symmetries) {
  if (!truth.T_world_object || truth.class_name != object.class_name) return std::numeric_limits<double>::infinity();
  return (truth.T_world_object->translation() - as_the_truth(object, truth, symmetries).translation()).norm();
}

std::vector<int> matches(const std::vector<TrueInstance>& truth, const std::vector<PublishedObject>& objects,
                         const ClassSymmetries& symmetries, double reach_m) {
  constexpr double kFar = 1e3;
  Eigen::MatrixXd costs(truth.size(), objects.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (std::size_t j = 0; j < objects.size(); ++j)
      costs(i, j) = std::min(kFar, apart_m(truth[i], objects[j], symmetries));
  }
  return tracks::assign(costs, reach_m);
}

}  // namespace houghstream::studies
