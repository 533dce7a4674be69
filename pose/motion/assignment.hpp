#pragma once

#include <Eigen/Core>
#include <vector>

namespace houghstream {

/// Which column each row is given, so that the sum of costs is least; -1 for a row without one. Costs from `limit` on
/// are not given at all, rather both stay without. By shortest augmenting paths (Jonker and Volgenant 1987); of equal
/// sums, always the same one.
std::vector<int> solve_assignment(const Eigen::MatrixXd& costs, double limit);

}  // namespace houghstream
