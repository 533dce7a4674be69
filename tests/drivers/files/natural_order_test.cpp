#include "drivers/files/natural_order.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(NaturalOrder, NumbersCompareAsNumbers) {
  EXPECT_TRUE(natural_less("desk_1_9", "desk_1_28"));
  EXPECT_FALSE(natural_less("desk_1_28", "desk_1_9"));
  EXPECT_TRUE(natural_less("a", "b"));
  EXPECT_TRUE(natural_less("a", "a1"));
  EXPECT_TRUE(natural_less("00009", "00010"));
  EXPECT_FALSE(natural_less("a1", "a1"));
  EXPECT_NE(natural_less("a01", "a1"), natural_less("a1", "a01")) << "a strict order, equal only when equal";
}

}  // namespace
}  // namespace houghstream
