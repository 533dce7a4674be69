#include "pose/motion/assignment.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace houghstream {
namespace {

TEST(Assignment, TheSumIsLeastAndWhatCostsTooMuchIsNotGiven) {
  Eigen::MatrixXd costs(2, 3);
  costs << 1.0, 0.9, 9.0,  //
      5.0, 1.0, 9.0;
  EXPECT_EQ(solve_assignment(costs, 4.0), (std::vector<int>{0, 1}));  // one by one, the first would take column 1
  EXPECT_EQ(solve_assignment(costs, 0.95), (std::vector<int>{1, -1}));
  EXPECT_EQ(solve_assignment(Eigen::MatrixXd(2, 0), 1.0), (std::vector<int>{-1, -1}));
  EXPECT_TRUE(solve_assignment(Eigen::MatrixXd(0, 2), 1.0).empty());
}

}  // namespace
}  // namespace houghstream
