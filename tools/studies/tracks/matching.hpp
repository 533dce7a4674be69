#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipeline/geometry/symmetry.hpp"
#include "tools/studies/tracks/track_metrics.hpp"

namespace houghstream::studies {

/// Symmetries by class name; of others none.
using ClassSymmetries = std::map<std::string, Symmetries>;

/// The published pose of a true object that is there: of those that look the same, the one nearest to the true one.
Eigen::Isometry3d as_the_truth(const PublishedObject& object, const TrueInstance& truth,
                               const ClassSymmetries& symmetries);

/// Metres from a true object to a published one of its class, but for symmetry; infinite where the classes differ, or
/// the true one is not there.
double apart_m(const TrueInstance& truth, const PublishedObject& object, const ClassSymmetries& symmetries);

/// For each true object the published one that it is given, or -1: of its class, nearer than `reach_m`, and so that the
/// sum of distances is least.
std::vector<int> matches(const std::vector<TrueInstance>& truth, const std::vector<PublishedObject>& objects,
                         const ClassSymmetries& symmetries, double reach_m);

}  // namespace houghstream::studies
