#include "detector/features/features.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "toy_data.hpp"

namespace houghstream {
namespace {

WorkingFrame toy_frame() {
  RgbdFrame frame = toy::room(5);
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
  const FeatureImage image = compute_features(toy_frame(), {}, 1);
  int upside_down = 0;
  int different = 0;
  const auto compare = [&](const std::uint8_t* pixel, int first, int count, int skip) {
    for (int p = first + skip; p < first + count; ++p) {
      upside_down += pixel[p] < pixel[p + count] ? 1 : 0;
      different += pixel[p] > pixel[p + count] ? 1 : 0;
    }
  };
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      compare(image.at(x, y), 0, FeatureLayout::kIntensity, 0);
      compare(image.at(x, y), FeatureLayout::kDepthMax, FeatureLayout::kDepth, 1);  // depth itself wraps
    }
  }
  EXPECT_EQ(upside_down, 0);
  EXPECT_GT(different, image.width() * image.height());
}

TEST(Features, MinimumAndMaximumReachTwoPixels) {
  WorkingFrame frame = flat_frame(0.4F);
  frame.filled_depth.at<float>(10, 10) = 0.6F;
  const FeatureImage image = compute_features(frame, {}, 1);
  EXPECT_EQ(image.at(12, 12)[FeatureLayout::kDepthMax], 150);
  EXPECT_EQ(image.at(13, 12)[FeatureLayout::kDepthMax], 100);
  EXPECT_EQ(image.at(10, 10)[FeatureLayout::kDepthMin], 100);
}

TEST(Features, DepthWrapsSoThatDifferencesStayExactAtAnyDistance) {
  for (const float near : {0.4F, 0.9F, 2.3F}) {
    WorkingFrame frame = flat_frame(near);
    frame.filled_depth.colRange(20, 40).setTo(near + 0.2F);
    const FeatureImage image = compute_features(frame, {}, 1);
    for (const int plane : {FeatureLayout::kDepthMax, FeatureLayout::kDepthMin}) {
      ASSERT_TRUE(FeatureLayout::wraps(plane));
      const int difference = image.at(30, 15)[plane] - image.at(10, 15)[plane];
      EXPECT_EQ(static_cast<std::int8_t>(difference & 255), 50) << near << " m, plane " << plane;
    }
  }
}

TEST(Features, WithoutDepthTheDepthPlanesAreNeutral) {
  const FeatureImage image = compute_features(flat_frame(std::numeric_limits<float>::quiet_NaN()), {}, 1);
  for (const int first : {FeatureLayout::kDepthMax, FeatureLayout::kDepthMin}) {
    for (int p = 0; p < FeatureLayout::kDepth; ++p) {
      const int expected = p >= 1 && p <= 4 ? 128 : 0;
      EXPECT_EQ(image.at(20, 15)[first + p], expected) << first + p;
    }
  }
}

TEST(Features, TheBorderIsReplicated) {
  const FeatureImage image = compute_features(toy_frame(), {}, 1);
  const int w = image.width() - 1;
  const int h = image.height() - 1;
  EXPECT_EQ(std::memcmp(image.at(-24, -24), image.at(0, 0), FeatureLayout::kPlanes), 0);
  EXPECT_EQ(std::memcmp(image.at(w + 24, h + 24), image.at(w, h), FeatureLayout::kPlanes), 0);
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
