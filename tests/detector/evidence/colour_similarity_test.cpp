#include "detector/evidence/colour_similarity.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/base/random.hpp"

namespace houghstream {
namespace {

/// Returns the correlation of 100 random colours with gain * colour + offset.
float after_light(double gain, double offset) {
  Random random(5);
  ColourSimilarity similarity;
  for (int i = 0; i < 100; ++i) {
    std::array<std::uint8_t, 3> a{};
    cv::Vec3b b;
    for (std::size_t c = 0; c < 3; ++c) {
      a[c] = static_cast<std::uint8_t>(random.between(40, 160));
      b[static_cast<int>(c)] = static_cast<std::uint8_t>(gain * a[c] + offset);
    }
    similarity.add(a, b);
  }
  return similarity.correlation();
}

TEST(ColourSimilarity, IsBlindToGainAndOffset) {
  EXPECT_GT(after_light(1.0, 0.0), 0.98F);
  EXPECT_GT(after_light(0.5, 60.0), 0.95F);
  EXPECT_LT(after_light(-1.0, 200.0), -0.98F);
}

TEST(ColourSimilarity, ColoursThatHaveNothingInCommonAreNotAlike) {
  Random random(6);
  ColourSimilarity similarity;
  for (int i = 0; i < 400; ++i) {
    const auto value = [&] { return static_cast<std::uint8_t>(random.below(256)); };
    similarity.add({value(), value(), value()}, {value(), value(), value()});
  }
  EXPECT_NEAR(similarity.correlation(), 0.0F, 0.1F);
}

TEST(ColourSimilarity, ManyPairsAtOnceAreThatManyPairs) {
  Random random(7);
  ColourSimilarity one_by_one;
  ColourPairs pairs;
  pairs.count = 401;
  for (std::size_t i = 0; i < pairs.count; ++i) {
    std::array<std::uint8_t, 3> expected{};
    cv::Vec3b observed;
    for (std::size_t c = 0; c < 3; ++c) {
      expected[c] = static_cast<std::uint8_t>(random.below(256));
      observed[static_cast<int>(c)] = static_cast<std::uint8_t>((expected[c] + random.below(128)) / 2);
      pairs.expected[c][i] = expected[c];
      pairs.observed[c][i] = observed[static_cast<int>(c)];
    }
    one_by_one.add(expected, observed);
  }
  ColourSimilarity at_once;
  at_once.add(pairs);
  EXPECT_EQ(at_once.correlation(), one_by_one.correlation());
  EXPECT_EQ(at_once.hue_mismatch(), one_by_one.hue_mismatch());
  EXPECT_EQ(at_once.log_contrast_ratio(), one_by_one.log_contrast_ratio());
  EXPECT_GT(at_once.correlation(), 0.5F);
}

TEST(ColourSimilarity, PlainSurfacesAndFewPairsSayNothing) {
  ColourSimilarity plain;
  for (int i = 0; i < 100; ++i) plain.add({100, 128, 128}, {90, 128, 128});
  EXPECT_EQ(plain.correlation(), 0.0F);
  ColourSimilarity few;
  for (std::uint8_t i = 0; i < 5; ++i) few.add({i, i, i}, {i, i, i});
  EXPECT_EQ(few.correlation(), 0.0F);
}

/// Returns two plain surfaces, as a* and b* about neutral.
ColourSimilarity of_plain(cv::Point expected, cv::Point observed) {
  ColourSimilarity similarity;
  for (int i = 0; i < 100; ++i) {
    similarity.add({120, static_cast<std::uint8_t>(128 + expected.x), static_cast<std::uint8_t>(128 + expected.y)},
                   {120, static_cast<std::uint8_t>(128 + observed.x), static_cast<std::uint8_t>(128 + observed.y)});
  }
  return similarity;
}

float between_plain(cv::Point expected, cv::Point observed) {
  return of_plain(expected, observed).mean_chroma_distance();
}

float hue_mismatch(cv::Point expected, cv::Point observed) {
  return of_plain(expected, observed).hue_mismatch();
}

/// Compares a uniform colour, expected with L* 120, with an observation of another brightness.
float chroma_deficit(cv::Point expected, int observed_brightness, cv::Point observed) {
  ColourSimilarity similarity;
  for (int i = 0; i < 100; ++i) {
    similarity.add({120, static_cast<std::uint8_t>(128 + expected.x), static_cast<std::uint8_t>(128 + expected.y)},
                   {static_cast<std::uint8_t>(observed_brightness), static_cast<std::uint8_t>(128 + observed.x),
                    static_cast<std::uint8_t>(128 + observed.y)});
  }
  return similarity.chroma_deficit();
}

TEST(Paleness, IsWhatBrightnessDoesNotExplain) {
  EXPECT_NEAR(chroma_deficit({40, 30}, 60, {20, 15}), 0.0F, 1e-3F) << "half the light";
  EXPECT_NEAR(chroma_deficit({40, 30}, 120, {20, 15}), std::log(2620.0F / 1370.0F), 1e-3F) << "half the colour";
  EXPECT_GT(chroma_deficit({40, 30}, 40, {1, 1}), 1.5F) << "black instead of red";
  EXPECT_NEAR(chroma_deficit({0, 0}, 200, {10, 0}), 0.0F, 1e-3F) << "no colour remembered";
  EXPECT_LT(chroma_deficit({20, 0}, 120, {40, 0}), -0.2F) << "stronger";
}

TEST(ForeignColour, IsTheDistanceInTensThatNoStrengthExplains) {
  EXPECT_NEAR(between_plain({0, 0}, {30, 0}), 3.0F, 1e-3F);
  EXPECT_NEAR(between_plain({20, 0}, {20, 10}), 1.0F, 1e-3F);
  EXPECT_NEAR(between_plain({20, 0}, {-20, 0}), 3.0F, 1e-3F) << "no paler than half";
}

TEST(ForeignColour, HazeAndStrongColoursAreStillTheSameColour) {
  EXPECT_NEAR(between_plain({10, 20}, {5, 10}), 0.0F, 0.05F);
  EXPECT_NEAR(between_plain({10, 20}, {25, 50}), 0.0F, 0.05F);
}

TEST(ForeignColour, SaysLittleWhereTheColoursSeenVary) {
  Random random(8);
  ColourSimilarity similarity;
  for (int i = 0; i < 400; ++i) {
    const auto value = [&] { return static_cast<std::uint8_t>(random.between(68, 188)); };
    similarity.add({120, 148, 128}, {120, value(), static_cast<std::uint8_t>(value() + 20)});
  }
  EXPECT_LT(similarity.mean_chroma_distance(), 0.6F);
}

TEST(ForeignColour, FewPairsSayNothing) {
  ColourSimilarity few;
  for (int i = 0; i < 5; ++i) few.add({120, 128, 128}, {120, 190, 128});
  EXPECT_EQ(few.mean_chroma_distance(), 0.0F);
}

TEST(HueConflict, GrowsWithTheAngleAndTheStrengthOfBothColours) {
  EXPECT_NEAR(hue_mismatch({20, 0}, {0, 10}), 200.0 / std::sqrt(520.0 * 220.0), 1e-5);
  EXPECT_NEAR(hue_mismatch({25, 0}, {6, 8}), 100.0 / std::sqrt(745.0 * 220.0), 1e-5);
  EXPECT_NEAR(hue_mismatch({20, 0}, {0, 5}), 100.0 / std::sqrt(520.0 * 145.0), 1e-5);
  EXPECT_GT(hue_mismatch({30, 20}, {30, -25}), 0.6F) << "red and purple";
  EXPECT_GT(hue_mismatch({40, 0}, {-40, 0}), 1.8F) << "red and green";
}

TEST(HueConflict, IsKnownInHazeToo) {
  const float clear = hue_mismatch({20, 0}, {0, 20});
  EXPECT_GT(hue_mismatch({9, 0}, {0, 20}), 0.7F * clear) << "taught in haze";
  EXPECT_GT(hue_mismatch({20, 0}, {0, 9}), 0.7F * clear) << "seen in haze";
}

TEST(HueConflict, OtherStrengthAndGreySurfacesAreNoneAndACastIsLittle) {
  EXPECT_NEAR(hue_mismatch({10, 20}, {5, 10}), 0.0F, 1e-3F);
  EXPECT_NEAR(hue_mismatch({10, 20}, {25, 50}), 0.0F, 1e-3F);
  EXPECT_EQ(hue_mismatch({0, 0}, {30, 20}), 0.0F);
  EXPECT_LT(hue_mismatch({15, 0}, {15, 8}), 0.1F);
}

TEST(HueConflict, RedPrintOnWhiteMeansAnotherThingThanPurplePrintOnWhite) {
  const auto printed = [](std::uint8_t a, std::uint8_t b) {
    ColourSimilarity similarity;
    for (int i = 0; i < 100; ++i) {
      const bool print = i % 2 == 0;
      similarity.add(print ? std::array<std::uint8_t, 3>{80, 170, 150} : std::array<std::uint8_t, 3>{200, 128, 128},
                     print ? cv::Vec3b(80, a, b) : cv::Vec3b(200, 128, 128));
    }
    return similarity;
  };
  EXPECT_GT(printed(150, 100).correlation(), 0.8F) << "lightness is alike";
  EXPECT_GT(printed(150, 100).hue_mismatch(), 0.6F);
  EXPECT_EQ(printed(170, 150).hue_mismatch(), 0.0F);
}

TEST(HueConflict, FewPairsSayNothing) {
  ColourSimilarity few;
  for (int i = 0; i < 5; ++i) few.add({120, 158, 128}, {120, 128, 158});
  EXPECT_EQ(few.hue_mismatch(), 0.0F);
}

}  // namespace
}  // namespace houghstream
