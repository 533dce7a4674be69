#include "detector/evidence/likeness.hpp"

#include <gtest/gtest.h>

#include "pipeline/random.hpp"

namespace houghstream {
namespace {

/// Correlation of 100 random colours with gain * colour + offset.
float after_light(double gain, double offset) {
  Random random(5);
  Likeness likeness;
  for (int i = 0; i < 100; ++i) {
    std::array<std::uint8_t, 3> a{};
    cv::Vec3b b;
    for (std::size_t c = 0; c < 3; ++c) {
      a[c] = static_cast<std::uint8_t>(random.between(40, 160));
      b[static_cast<int>(c)] = static_cast<std::uint8_t>(gain * a[c] + offset);
    }
    likeness.add(a, b);
  }
  return likeness.correlation();
}

TEST(Likeness, IsBlindToGainAndOffset) {
  EXPECT_GT(after_light(1.0, 0.0), 0.98F);
  EXPECT_GT(after_light(0.5, 60.0), 0.95F);
  EXPECT_LT(after_light(-1.0, 200.0), -0.98F);
}

TEST(Likeness, ColoursThatHaveNothingInCommonAreNotAlike) {
  Random random(6);
  Likeness likeness;
  for (int i = 0; i < 400; ++i) {
    const auto value = [&] { return static_cast<std::uint8_t>(random.below(256)); };
    likeness.add({value(), value(), value()}, {value(), value(), value()});
  }
  EXPECT_NEAR(likeness.correlation(), 0.0F, 0.1F);
}

TEST(Likeness, PlainSurfacesAndFewPairsSayNothing) {
  Likeness plain;
  for (int i = 0; i < 100; ++i) plain.add({100, 128, 128}, {90, 128, 128});
  EXPECT_EQ(plain.correlation(), 0.0F);
  Likeness few;
  for (std::uint8_t i = 0; i < 5; ++i) few.add({i, i, i}, {i, i, i});
  EXPECT_EQ(few.correlation(), 0.0F);
}

}  // namespace
}  // namespace houghstream
