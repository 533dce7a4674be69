#include "detector/evidence/cell_comparison.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "pipeline/base/no_value.hpp"
#include "pipeline/base/random.hpp"
#include "tests/every_target.hpp"

namespace houghstream {
namespace {

constexpr float kShift_m = 0.004F;
constexpr float kTolerance_m = 0.012F;

/// A template, a frame, and where the one lies in the other: some of its cells beside the image.
struct Case {
  TemplateGrid grid;
  CellLayout layout;
  cv::Mat depth = cv::Mat(40, 50, CV_32FC1);
};

std::unique_ptr<Case> random_case(std::uint64_t seed) {
  Random random(seed);
  auto made = std::make_unique<Case>();
  for (int row = 0; row < TemplateGrid::kSide; ++row) {
    for (int column = 0; column < TemplateGrid::kSide; ++column) {
      const int kind = random.below(5);
      const bool is_in_box = TemplateGrid::is_in_box(row) && TemplateGrid::is_in_box(column);
      if (is_in_box && kind > 0) {
        made->grid.mm[TemplateGrid::depth_index(row, column)] =
            kind == 1 ? TemplateGrid::kNoDepth : static_cast<std::int16_t>(random.between(-40, 40));
      } else if (row < TemplateGrid::kRimRows && kind < 3) {
        made->grid.beside[static_cast<std::size_t>(row * TemplateGrid::kSide + column)] =
            static_cast<std::int16_t>(random.between(-40, 40));
      }
    }
  }
  const int left = random.between(-12, 40);
  const int top = random.between(-12, 30);
  for (std::size_t i = 0; i < kTemplateSide; ++i) {
    made->layout.column_px[i] = left + static_cast<int>(i) * 3 / 2;
    made->layout.row_px[i] = top + static_cast<int>(i);
    made->layout.column_depth[i] = static_cast<float>(random.uniform(-0.01, 0.01));
    made->layout.row_depth[i] = static_cast<float>(random.uniform(0.99, 1.01));
  }
  for (int y = 0; y < made->depth.rows; ++y) {
    for (int x = 0; x < made->depth.cols; ++x)
      made->depth.at<float>(y, x) = random.uniform() < 0.2 ? kNoValue : static_cast<float>(random.uniform(0.95, 1.05));
  }
  return made;
}

/// Compares one cell after another, as the definition says.
struct Reference {
  explicit Reference(const Case& made) {
    for (std::size_t row = 0; row < kTemplateSide; ++row) {
      for (std::size_t column = 0; column < kTemplateSide; ++column) add(made, row, column);
    }
  }

  void add(const Case& made, std::size_t row, std::size_t column) {
    const cv::Point at(made.layout.column_px[column], made.layout.row_px[row]);
    if (!cv::Rect(cv::Point(), made.depth.size()).contains(at)) return;
    const float beyond = made.depth.at<float>(at) - (made.layout.row_depth[row] + made.layout.column_depth[column]);
    const auto over = [&](std::int16_t mm) {
      return mm > TemplateGrid::kNoDepth ? beyond - made.layout.metres_per_mm * static_cast<float>(mm) : kNoValue;
    };
    const std::int16_t mm = made.grid.depth_mm(static_cast<int>(row), static_cast<int>(column));
    if (mm != TemplateGrid::kNoObject) {
      cells.emplace_back(row, column);
      depth_difference.push_back(over(mm));
    }
    if (row >= TemplateGrid::kRimRows) return;
    const std::int16_t beside = made.grid.beside[row * kTemplateSide + column];
    if (beside != TemplateGrid::kNoObject) rim_difference.push_back(over(beside));
  }

  std::vector<std::pair<std::size_t, std::size_t>> cells;  // rows and columns
  std::vector<float> depth_difference;
  std::vector<float> rim_difference;
};

void expect_equal(const std::vector<float>& expected, const float* values, std::size_t count) {
  ASSERT_EQ(expected.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    if (std::isnan(expected[i])) {
      EXPECT_TRUE(std::isnan(values[i])) << i;
    } else {
      EXPECT_EQ(expected[i], values[i]) << i;
    }
  }
}

/// Calls check(case, depths) for 50 cases, with every instruction set that the processor has.
template <typename Check>
void for_each_case(const Check& check) {
  simd::with_every_target([&] {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
      SCOPED_TRACE(seed);
      const std::unique_ptr<Case> made = random_case(seed);
      CellDepths depths;
      compare_depths(made->grid, made->layout, made->depth, 1, depths);
      check(*made, depths);
    }
  });
}

TEST(CellComparison, IsThatOfOneCellAfterAnother) {
  for_each_case([](const Case& made, const CellDepths& depths) {
    const Reference expected(made);
    expect_equal(expected.depth_difference, depths.depth_difference.data(), depths.object_cells);
    expect_equal(expected.rim_difference, depths.rim_difference.data(), depths.rim_cells);
    for (std::size_t i = 0; i < depths.object_cells; ++i) {
      const TemplateCell cell = depths.cells[i];
      ASSERT_EQ(std::pair(std::size_t{cell.row}, std::size_t{cell.column}), expected.cells[i]);
      ASSERT_EQ(cell.colour_index, TemplateGrid::colour_index(cell.row, cell.column));
    }
  });
}

TEST(CellComparison, OfSomeRowsIsThatOfTheseRows) {
  constexpr std::size_t kStep = 3;
  simd::with_every_target([&] {
    const std::unique_ptr<Case> made = random_case(1);
    CellDepths all;
    CellDepths some;
    compare_depths(made->grid, made->layout, made->depth, 1, all);
    compare_depths(made->grid, made->layout, made->depth, kStep, some);
    std::vector<std::uint16_t> expected;
    for (std::size_t i = 0; i < all.object_cells; ++i) {
      if (all.cells[i].row % kStep == kStep / 2) expected.push_back(all.cells[i].colour_index);
    }
    ASSERT_EQ(some.object_cells, expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(some.cells[i].colour_index, expected[i]);
    EXPECT_LT(some.rim_cells, all.rim_cells);
  });
}

TEST(CellComparison, TheCommonShiftIsTheMedianWithinReach) {
  for_each_case([](const Case& /*made*/, const CellDepths& depths) {
    std::vector<float> near;
    std::copy_if(depths.depth_difference.begin(),
                 depths.depth_difference.begin() + static_cast<std::ptrdiff_t>(depths.object_cells),
                 std::back_inserter(near), [](float e) { return std::abs(e) < 0.03F; });
    std::sort(near.begin(), near.end());
    EXPECT_EQ(median_depth_shift(depths), near.empty() ? 0.0F : near[near.size() / 2]);
  });
}

TEST(CellComparison, TalliesEachCellOnce) {
  for_each_case([](const Case& /*made*/, const CellDepths& depths) {
    CellTally tally;
    tally_cells(depths, kShift_m, kTolerance_m, tally);
    CellTally expected;
    for (std::size_t i = 0; i < depths.object_cells; ++i) {
      const float e = depths.depth_difference[i] - kShift_m;
      const TemplateCell cell = depths.cells[i];
      expected.no_depth += std::isnan(e) ? 1 : 0;
      expected.occluded += e < -kTolerance_m ? 1 : 0;
      expected.free_space_violations += e > kTolerance_m ? 1 : 0;
      const bool is_visible = std::abs(e) <= kTolerance_m;
      expected.visible += is_visible ? 1 : 0;
      if (is_visible) expected.depth_residual += std::abs(e) / kTolerance_m;
      if (!is_visible && !std::isnan(e)) continue;
      ASSERT_LT(expected.unoccluded, tally.unoccluded);
      EXPECT_EQ(tally.unoccluded_cells[expected.unoccluded++].colour_index, cell.colour_index);
      expected.rows |= 1U << cell.row;
      expected.columns |= 1U << cell.column;
    }
    EXPECT_EQ(tally.cells, depths.object_cells);
    EXPECT_EQ(tally.no_depth, expected.no_depth);
    EXPECT_EQ(tally.occluded, expected.occluded);
    EXPECT_EQ(tally.free_space_violations, expected.free_space_violations);
    EXPECT_EQ(tally.visible, expected.visible);
    EXPECT_EQ(tally.depth_residual, expected.depth_residual) << "the sum is that of one after another";
    EXPECT_EQ(tally.unoccluded, expected.unoccluded);
    EXPECT_EQ(tally.rows, expected.rows);
    EXPECT_EQ(tally.columns, expected.columns);
  });
}

TEST(CellComparison, ATemplateBesideTheImageHasNoCells) {
  const std::unique_ptr<Case> made = random_case(1);
  made->layout.row_px.fill(-1);
  CellDepths depths;
  compare_depths(made->grid, made->layout, made->depth, 1, depths);
  EXPECT_EQ(depths.object_cells, 0U);
  EXPECT_EQ(median_depth_shift(depths), 0.0F);
  CellTally tally;
  tally_cells(depths, 0.0F, kTolerance_m, tally);
  EXPECT_EQ(tally.unoccluded, 0U);
  EXPECT_EQ(tally.fraction(tally.visible), 0.0F);
}

}  // namespace
}  // namespace houghstream
