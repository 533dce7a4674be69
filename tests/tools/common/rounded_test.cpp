#include "tools/common/rounded.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace houghstream {
namespace {

TEST(Rounded, KeepsSoManyDecimals) {
  EXPECT_EQ(rounded(1.23456, 3), 1.235);
  EXPECT_EQ(rounded(-1.23456, 2), -1.23);
  EXPECT_EQ(rounded(0.00004, 4), 0.0);
  EXPECT_EQ(rounded(17.5, 0), 18.0);
}

TEST(Rounded, WhatIsNoNumberStays) {
  EXPECT_TRUE(std::isnan(rounded(std::nan(""), 3)));
  EXPECT_EQ(rounded(std::numeric_limits<double>::infinity(), 3), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace houghstream
