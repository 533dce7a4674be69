#include "pose/following/colour_statistics.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

const cv::Vec3b kRed(20, 30, 200);
const cv::Vec3b kBlue(200, 60, 20);
const cv::Vec3b kGreen(20, 200, 20);

TEST(ColourStatistics, TellsLearntColoursApartAndKnowsNothingOfOthers) {
  ColourStatistics colours;
  EXPECT_TRUE(colours.empty());
  EXPECT_FLOAT_EQ(colours.foreground(kRed), 0.5F);
  colours.learn(std::vector<cv::Vec3b>(300, kRed), std::vector<cv::Vec3b>(500, kBlue), 0.2);
  EXPECT_FALSE(colours.empty());
  EXPECT_GT(colours.foreground(kRed), 0.99F);
  EXPECT_LT(colours.foreground(kBlue), 0.01F);
  EXPECT_FLOAT_EQ(colours.foreground(kGreen), 0.5F);
}

TEST(ColourStatistics, FollowsColoursThatChange) {
  ColourStatistics colours;
  colours.learn(std::vector<cv::Vec3b>(300, kRed), std::vector<cv::Vec3b>(500, kBlue), 0.2);
  for (int i = 0; i < 20; ++i)
    colours.learn(std::vector<cv::Vec3b>(300, kBlue), std::vector<cv::Vec3b>(500, kRed), 0.2);
  EXPECT_LT(colours.foreground(kRed), 0.05F);
  EXPECT_GT(colours.foreground(kBlue), 0.95F);
}

TEST(ColourStatistics, WithoutPixelsItStaysWhatItWas) {
  ColourStatistics colours;
  colours.learn({}, {}, 0.2);
  EXPECT_TRUE(colours.empty());
  colours.learn(std::vector<cv::Vec3b>(300, kRed), std::vector<cv::Vec3b>(500, kBlue), 0.2);
  const float before = colours.foreground(kRed);
  colours.learn({}, {}, 0.2);
  EXPECT_EQ(colours.foreground(kRed), before);
}

}  // namespace
}  // namespace houghstream
