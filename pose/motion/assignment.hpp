#pragma once

#include <Eigen/Core>
#include <vector>

namespace houghstream {

/// Returns the column assigned to each row, so that the sum of costs is minimal; -1 for a row without one. Pairs with
/// costs from `limit` on are not assigned; both stay without a partner. It uses shortest augmenting paths (Jonker and
/// Volgenant 1987), and returns always the same one of equal sums.
std::vector<int> solve_assignment(const Eigen::MatrixXd& costs, double limit);

}  // namespace houghstream
