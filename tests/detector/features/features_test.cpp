#include "detector/features/features.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "tests/detector/toy_data.hpp"

namespace houghstream {
namespace {

WorkingFrame toy_frame() {
  RgbdFrame frame = toy::background(5);
  toy::put_tile(0, 160, 120, 0.7, frame);
  return make_working_frame(frame, 0.5F, {});
}

WorkingFrame flat_frame(float depth) {
  WorkingFrame frame;
  frame.camera = {40, 30, 131.25, 131.25, 19.5, 14.5};
  frame.colour = cv::Mat(30, 40, CV_8UC3, cv::Scalar(90, 90, 90));
  frame.filled_depth = cv::Mat(30, 40, CV_32FC1, cv::Scalar(depth));
  return frame;
}

TEST(Features, MinimaLieBelowMaximaAndDiffer) {
  FeatureSettings settings;
  settings.families = kIntensity | kDepthDerivatives | kDepthHog;  // depth itself wraps
  const FeatureImage image = compute_features(toy_frame(), settings, 1);
  const FeatureLayout layout(settings);
  for (const FeatureBlock& block : layout.blocks()) {
    ASSERT_TRUE(block.min_max);
    int upside_down = 0;
    int different = 0;
    for (int i = 0; i < image.height() * image.width(); ++i) {
      const std::uint8_t* pixel = image.at(i % image.width(), i / image.width()) + block.first;
      for (int p = 0; p < block.count; ++p) {
        upside_down += pixel[p] < pixel[p + block.count] ? 1 : 0;
        different += pixel[p] > pixel[p + block.count] ? 1 : 0;
      }
    }
    EXPECT_EQ(upside_down, 0) << family_names(block.family);
    EXPECT_GT(different, image.width() * image.height()) << family_names(block.family);
  }
}

TEST(Features, MinimumAndMaximumReachTwoPixels) {
  WorkingFrame frame = flat_frame(0.4F);
  frame.filled_depth.at<float>(10, 10) = 0.6F;
  const FeatureImage image = compute_features(frame, {}, 1);
  const int largest = FeatureLayout().block(kDepthValue).first;
  EXPECT_EQ(image.at(12, 12)[largest], 150);
  EXPECT_EQ(image.at(13, 12)[largest], 100);
  EXPECT_EQ(image.at(10, 10)[largest + 1], 100);
}

TEST(Features, DepthWrapsSoThatDifferencesStayExactAtAnyDistance) {
  for (const float near : {0.4F, 0.9F, 2.3F}) {
    WorkingFrame frame = flat_frame(near);
    frame.filled_depth.colRange(20, 40).setTo(near + 0.2F);
    const FeatureImage image = compute_features(frame, {}, 1);
    const int first = FeatureLayout().block(kDepthValue).first;
    for (const int plane : {first, first + 1}) {
      ASSERT_EQ(FeatureLayout().kind(plane), PlaneKind::kWrappedDepth);
      const int difference = image.at(30, 15)[plane] - image.at(10, 15)[plane];
      EXPECT_EQ(static_cast<std::int8_t>(difference & 255), 50) << near << " m, plane " << plane;
    }
  }
}

TEST(Features, WithoutDepthTheDepthPlanesAreNeutral) {
  const FeatureImage image = compute_features(flat_frame(std::numeric_limits<float>::quiet_NaN()), {}, 1);
  const FeatureLayout layout;
  for (const FeatureFamily family : {kDepthValue, kDepthDerivatives, kDepthHog}) {
    const FeatureBlock& block = layout.block(family);
    const int expected = family == kDepthDerivatives ? 128 : 0;
    for (int p = block.first; p < block.first + block.planes(); ++p) EXPECT_EQ(image.at(20, 15)[p], expected) << p;
  }
}

TEST(Features, TheBorderIsReplicated) {
  const FeatureImage image = compute_features(toy_frame(), {}, 1);
  const int w = image.width() - 1;
  const int h = image.height() - 1;
  const auto planes = static_cast<std::size_t>(FeatureLayout().planes());
  EXPECT_EQ(std::memcmp(image.at(-24, -24), image.at(0, 0), planes), 0);
  EXPECT_EQ(std::memcmp(image.at(w + 24, h + 24), image.at(w, h), planes), 0);
}

TEST(Features, AnyNumberOfThreadsGivesTheSameImage) {
  const WorkingFrame frame = toy_frame();
  const FeatureImage serial = compute_features(frame, {}, 1);
  const FeatureImage parallel = compute_features(frame, {}, 3);
  const int pad = FeatureImage::kPad;
  const std::size_t bytes = static_cast<std::size_t>(serial.row_stride()) * (serial.height() + 2 * pad);
  EXPECT_EQ(std::memcmp(serial.at(-pad, -pad), parallel.at(-pad, -pad), bytes), 0);
}

}  // namespace
}  // namespace houghstream
