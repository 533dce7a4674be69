#include "detector/features/working_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pipeline/base/no_value.hpp"

namespace houghstream {
namespace {

RgbdFrame flat_frame(int width, int height, float depth) {
  RgbdFrame frame;
  frame.camera = {width, height, 200.0, 200.0, (width - 1) / 2.0, (height - 1) / 2.0};
  frame.colour = cv::Mat(height, width, CV_8UC3, cv::Scalar(10, 20, 30));
  frame.depth = cv::Mat(height, width, CV_32FC1, cv::Scalar(depth));
  return frame;
}

TEST(WorkingFrame, TheNearestSurfaceOfABlockCountsAndNeverAMixture) {
  RgbdFrame frame = flat_frame(8, 8, 2.0F);
  frame.depth.at<float>(2, 2) = 1.0F;    // one of four pixels
  frame.depth.at<float>(2, 5) = 1.0F;    // three of four, one far
  frame.depth.at<float>(3, 4) = 1.002F;  // the same surface: averaged with the first
  frame.depth.at<float>(3, 5) = kNoValue;
  const WorkingFrame working = make_working_frame(frame, 0.5F, {});
  EXPECT_FLOAT_EQ(working.filled_depth.at<float>(1, 1), 1.0F);
  EXPECT_FLOAT_EQ(working.filled_depth.at<float>(1, 2), 1.001F);
  EXPECT_FLOAT_EQ(working.filled_depth.at<float>(0, 0), 2.0F);
}

TEST(WorkingImages, MemoryIsUsedAgainButNeverThatOfTheFrameItself) {
  FeatureSettings whole;
  whole.image_scale = 1.0F;
  whole.far_distance = whole.max_distance;
  FeatureSettings half = whole;
  half.image_scale = 0.5F;
  RgbdFrame small = flat_frame(8, 8, 2.0F);
  small.camera.fx = 525.0;  // the usual lens: sizes are as the settings say
  WorkingImages images;
  make_working_images(small, whole, 1, images);
  ASSERT_EQ(images.frames.size(), 1U);
  EXPECT_EQ(images.frames[0].colour.data, small.colour.data);
  RgbdFrame large = flat_frame(16, 16, 1.0F);
  large.camera.fx = 525.0;
  large.colour.setTo(cv::Scalar(90, 90, 90));
  make_working_images(large, half, 1, images);
  EXPECT_EQ(small.colour.at<cv::Vec3b>(3, 3), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(images.frames[0].colour.at<cv::Vec3b>(3, 3), cv::Vec3b(90, 90, 90));
  const auto* colour = images.frames[0].colour.data;
  const auto* depth = images.frames[0].filled_depth.data;
  const auto* lab = images.lab[0].data;
  make_working_images(large, half, 1, images);
  EXPECT_EQ(images.frames[0].colour.data, colour);
  EXPECT_EQ(images.frames[0].filled_depth.data, depth);
  EXPECT_EQ(images.lab[0].data, lab);
}

TEST(WorkingImages, AreBroughtIntoTheToneAndTheFrameStays) {
  FeatureSettings settings;
  settings.tone = {100.0F, 130.0F, 50.0F};
  const RgbdFrame frame = flat_frame(64, 48, 1.0F);  // grey of 21.9
  for (const float scale : {0.5F, 1.0F}) {           // resized, and lent by the frame
    settings.image_scale = scale;
    WorkingImages images;
    make_working_images(frame, settings, 2, images);
    ASSERT_EQ(images.frames.size(), 2U);
    for (const WorkingFrame& working : images.frames) {
      const auto colour = working.colour.at<cv::Vec3b>(10, 10);
      EXPECT_NEAR(colour[0], 88, 1) << scale;
      EXPECT_NEAR(colour[2], 108, 1) << scale;
    }
    EXPECT_EQ(frame.colour.at<cv::Vec3b>(10, 10), cv::Vec3b(10, 20, 30));
    const auto* memory = images.toned.data;
    make_working_images(frame, settings, 2, images);
    EXPECT_EQ(images.toned.data, memory);
  }
}

TEST(WorkingImages, ShowAsMuchOfASurfaceInAPixelWhateverTheLens) {
  const Camera usual{640, 480, 525.0, 525.0, 319.5, 239.5};
  EXPECT_EQ(focal_octave_scale(usual), 1.0F);
  EXPECT_EQ(focal_octave_scale({640, 480, 615.0, 615.0, 319.5, 239.5}), 1.0F);
  EXPECT_EQ(focal_octave_scale({640, 480, 1066.8, 1067.5, 319.5, 239.5}), 0.5F);
  EXPECT_EQ(focal_octave_scale({320, 240, 262.5, 262.5, 159.5, 119.5}), 2.0F);
  EXPECT_EQ(focal_octave_scale({160, 120, 60.0, 60.0, 79.5, 59.5}), 2.0F) << "there is nothing more to see in it";
  FeatureSettings settings;
  const Camera tele = usual.scaled(2.0);
  ASSERT_EQ(feature_levels(settings, tele).size(), feature_levels(settings).size());
  EXPECT_EQ(feature_levels(settings, tele)[0].scale, 0.5F * feature_levels(settings)[0].scale);
}

TEST(WorkingImages, AreThoseOfEachLevelForAnyNumberOfThreads) {
  RgbdFrame frame = flat_frame(64, 48, 1.0F);
  frame.depth.colRange(20, 30).setTo(kNoValue);
  frame.colour.colRange(0, 13).setTo(cv::Scalar(200, 90, 10));
  const std::vector<FeatureLevel> levels = feature_levels({}, frame.camera);
  for (const int threads : {1, 3}) {
    WorkingImages images;
    make_working_images(frame, {}, threads, images);
    ASSERT_EQ(images.frames.size(), levels.size());
    for (std::size_t l = 0; l < levels.size(); ++l) {
      const WorkingFrame expected = make_working_frame(frame, levels[l].scale, {});
      EXPECT_EQ(images.frames[l].camera, expected.camera);
      EXPECT_EQ(cv::norm(images.frames[l].colour, expected.colour, cv::NORM_INF), 0.0);
      EXPECT_EQ(cv::norm(images.frames[l].filled_depth, expected.filled_depth, cv::NORM_INF), 0.0);
    }
    cv::Mat blurred;
    LabLevels lab;
    make_smoothed_lab(images.frames[0].colour, blurred, lab);
    for (std::size_t l = 0; l < lab.size(); ++l) EXPECT_EQ(cv::norm(images.lab[l], lab[l], cv::NORM_INF), 0.0);
  }
}

TEST(WorkingFrame, ASinglePixelOfDepthIsEnoughForABlock) {
  RgbdFrame frame = flat_frame(8, 8, kNoValue);
  frame.depth.at<float>(5, 5) = 0.9F;
  FeatureSettings settings;
  settings.fill_distance_px = 0.0F;
  settings.fill_distance = 0.0F;
  const WorkingFrame working = make_working_frame(frame, 0.5F, settings);
  EXPECT_FLOAT_EQ(working.filled_depth.at<float>(2, 2), 0.9F);
  EXPECT_TRUE(std::isnan(working.filled_depth.at<float>(2, 1)));
}

TEST(WorkingFrame, HolesBorrowTheNearestDepthUpToTheLimit) {
  RgbdFrame frame = flat_frame(60, 10, kNoValue);
  frame.depth.colRange(0, 5).setTo(1.0F);
  frame.depth.colRange(55, 60).setTo(2.0F);
  FeatureSettings settings;
  settings.fill_distance_px = 10.0F;
  settings.fill_distance = 0.0F;
  const cv::Mat depth = make_working_frame(frame, 1.0F, settings).filled_depth;
  EXPECT_FLOAT_EQ(depth.at<float>(5, 5), 1.0F);
  EXPECT_FLOAT_EQ(depth.at<float>(5, 14), 1.0F);
  EXPECT_TRUE(std::isnan(depth.at<float>(5, 16)));
  EXPECT_TRUE(std::isnan(depth.at<float>(5, 43)));
  EXPECT_FLOAT_EQ(depth.at<float>(5, 45), 2.0F);
}

TEST(WorkingFrame, NearSurfacesLendOverAsManyMetresWithDepthNormalisation) {
  RgbdFrame frame = flat_frame(60, 10, kNoValue);
  frame.depth.colRange(0, 5).setTo(0.4F);
  FeatureSettings settings;
  settings.fill_distance_px = 10.0F;
  settings.fill_distance = 0.05F;  // 25 pixels at 0.4 m
  const cv::Mat depth = make_working_frame(frame, 1.0F, settings).filled_depth;
  EXPECT_FLOAT_EQ(depth.at<float>(5, 4 + 25), 0.4F);
  EXPECT_TRUE(std::isnan(depth.at<float>(5, 4 + 26)));
}

TEST(WorkingFrame, TheFrameItselfIsNotTouchedInFullSize) {
  RgbdFrame frame = flat_frame(10, 10, 1.0F);
  frame.depth.at<float>(4, 4) = kNoValue;
  EXPECT_FLOAT_EQ(make_working_frame(frame, 1.0F, {}).filled_depth.at<float>(4, 4), 1.0F);
  EXPECT_TRUE(std::isnan(frame.depth.at<float>(4, 4)));
}

TEST(WorkingFrame, WithoutAnyDepthNothingIsInvented) {
  const cv::Mat depth = make_working_frame(flat_frame(20, 10, kNoValue), 0.5F, {}).filled_depth;
  EXPECT_EQ(cv::countNonZero(depth == depth), 0);
}

TEST(WorkingFrame, TheCameraSeesThePointWhereTheResizedImageShowsIt) {
  const WorkingFrame working = make_working_frame(flat_frame(80, 60, 1.0F), 0.5F, {});
  EXPECT_EQ(working.colour.size(), cv::Size(40, 30));
  EXPECT_EQ(working.filled_depth.size(), cv::Size(40, 30));
  EXPECT_EQ(working.camera, (Camera{40, 30, 100.0, 100.0, 19.5, 14.5}));
}

TEST(WorkingFrame, LevelsShareTheDistancesWithoutGapOrOverlap) {
  const auto levels = feature_levels({});
  EXPECT_FLOAT_EQ(levels[1].scale, 2.0F * levels[0].scale);
  for (const float depth : {0.3F, 1.2F, 1.2001F, 2.8F}) EXPECT_NE(levels[0].contains(depth), levels[1].contains(depth));
  for (const float depth : {0.0F, 2.9F, kNoValue}) {
    EXPECT_FALSE(levels[0].contains(depth) || levels[1].contains(depth)) << depth;
  }
}

}  // namespace
}  // namespace houghstream
