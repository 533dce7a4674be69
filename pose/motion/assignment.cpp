#include "pose/motion/assignment.hpp"

#include <algorithm>
#include <limits>

namespace houghstream {
namespace {

// Every row is given a column; there are as many columns as rows, or more. Rows and columns count from 1, 0 is none.
std::vector<int> assign_all(const Eigen::MatrixXd& costs) {
  const int rows = static_cast<int>(costs.rows());
  const int columns = static_cast<int>(costs.cols());
  std::vector<double> row_price(rows + 1, 0.0);
  std::vector<double> column_price(columns + 1, 0.0);
  std::vector<int> row_of(columns + 1, 0);
  for (int row = 1; row <= rows; ++row) {
    std::vector<double> minimum(columns + 1, std::numeric_limits<double>::infinity());
    std::vector<int> before(columns + 1, 0);
    std::vector<char> done(columns + 1, 0);
    int column = 0;
    for (row_of[0] = row; row_of[column] != 0;) {
      done[column] = 1;
      double step = std::numeric_limits<double>::infinity();
      int next = 0;
      for (int j = 1; j <= columns; ++j) {
        if (done[j]) continue;
        const double cost = costs(row_of[column] - 1, j - 1) - row_price[row_of[column]] - column_price[j];
        if (cost < minimum[j]) {
          minimum[j] = cost;
          before[j] = column;
        }
        if (minimum[j] < step) {
          step = minimum[j];
          next = j;
        }
      }
      for (int j = 0; j <= columns; ++j) {
        if (done[j]) {
          row_price[row_of[j]] += step;
          column_price[j] -= step;
        } else {
          minimum[j] -= step;
        }
      }
      column = next;
    }
    for (; column != 0; column = before[column]) row_of[column] = row_of[before[column]];
  }
  std::vector<int> column_of(rows, -1);
  for (int j = 1; j <= columns; ++j) {
    if (row_of[j] != 0) column_of[row_of[j] - 1] = j - 1;
  }
  return column_of;
}

}  // namespace

std::vector<int> solve_assignment(const Eigen::MatrixXd& costs, double limit) {
  const auto rows = costs.rows();
  const auto columns = costs.cols();
  if (rows == 0) return {};
  // Each row may also stay without, at the limit: a column of its own.
  Eigen::MatrixXd all = Eigen::MatrixXd::Constant(rows, columns + rows, limit);
  all.leftCols(columns) = costs.cwiseMin(2.0 * limit + 1.0);
  std::vector<int> given = assign_all(all);
  for (int row = 0; row < rows; ++row) {
    if (given[row] >= columns || (given[row] >= 0 && !(costs(row, given[row]) < limit))) given[row] = -1;
  }
  return given;
}

}  // namespace houghstream
