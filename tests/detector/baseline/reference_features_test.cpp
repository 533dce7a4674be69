#include "detector/baseline/reference_features.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <limits>

#include "detector/baseline/surface_planes.hpp"
#include "detector/features/features.hpp"
#include "pipeline/base/random.hpp"

namespace houghstream::baseline {
namespace {

constexpr int kPad = FeatureImage::kPad;

/// Returns noise of every contrast, with edges and holes in the depth.
WorkingFrame rough_frame(int width, int height, Random& random) {
  WorkingFrame frame;
  frame.camera = {width, height, 260.0, 260.0, (width - 1) / 2.0, (height - 1) / 2.0};
  frame.colour.create(height, width, CV_8UC3);
  frame.filled_depth.create(height, width, CV_32FC1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int contrast = 1 + (x * 255) / width;
      for (int c = 0; c < 3; ++c) {
        frame.colour.at<cv::Vec3b>(y, x)[c] = static_cast<std::uint8_t>(random.below(contrast + 1));
      }
      const auto noise = static_cast<float>(random.uniform(-1.0, 1.0) * 0.02 * y / height);
      const bool hole = random.uniform() < 0.002;
      const float surface = x / 37 % 2 == 0 ? 0.6F + 0.002F * static_cast<float>(x) : 1.9F;
      frame.filled_depth.at<float>(y, x) = hole ? std::numeric_limits<float>::quiet_NaN() : surface + noise;
    }
  }
  return frame;
}

/// Returns values that differ in a part, with the border where `pad` is kPad.
int differences(const FeatureImage& a, const FeatureImage& b, cv::Rect part, int pad, int planes) {
  int count = 0;
  for (int y = part.y - pad; y < part.y + part.height + pad; ++y) {
    for (int x = part.x - pad; x < part.x + part.width + pad; ++x) {
      for (int p = 0; p < planes; ++p) count += a.at(x, y)[p] != b.at(x, y)[p] ? 1 : 0;
    }
  }
  return count;
}

void use(std::int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().DeInit();  // the next call selects the target again
}

/// Compares with every instruction set of the processor.
void expect_the_same(const WorkingFrame& frame, const FeatureSettings& settings) {
  const FeatureImage expected = reference_features(frame, settings);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    use(target);
    const ExtraPlanes extra = extra_planes(frame, settings, 2);
    const FeatureImage found = compute_features(frame, settings, 2, &extra);
    const cv::Rect whole(0, 0, expected.width(), expected.height());
    EXPECT_EQ(differences(found, expected, whole, kPad, FeatureLayout(settings).planes()), 0)
        << hwy::TargetName(target) << " " << frame.colour.size() << " kernels " << settings.min_max_px << " and "
        << settings.depth_sobel_px;
  }
  use(0);
}

TEST(ReferenceFeatures, TilesHaveTheSameValuesAtEverySize) {
  Random random(41);
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(7, 40), cv::Size(32, 5), cv::Size(161, 99), cv::Size(131, 64)}) {
    expect_the_same(rough_frame(size.width, size.height, random), {});
  }
}

TEST(ReferenceFeatures, AndWithEveryKernel) {
  Random random(42);
  const WorkingFrame frame = rough_frame(70, 50, random);
  for (const int side : {1, 2, 4, 31}) {
    FeatureSettings settings;
    settings.min_max_px = side;
    settings.depth_sobel_px = side < 31 ? 3 + 2 * side : 31;
    expect_the_same(frame, settings);
  }
}

TEST(ReferenceFeatures, AndOfScaleSpacesAndSurfaces) {
  Random random(43);
  WorkingFrame frame = rough_frame(45, 40, random);
  frame.size_ratio = 0.66F;
  FeatureSettings settings;
  settings.handling = ScaleHandling::kScaleSpace;
  expect_the_same(frame, settings);
  settings.families = kIntensity | kHonv | kCurvature;
  expect_the_same(frame, settings);
}

TEST(ReferenceFeatures, WantedTilesDoNotDependOnTheOthers) {
  Random random(44);
  const WorkingFrame frame = rough_frame(200, 150, random);
  const FeatureImage expected = reference_features(frame, {});
  FeatureTiles tiles;
  tiles.clear({200, 150});
  tiles.add_patch(70, 40, 3);
  tiles.add_patch(199, 149, 24);
  FeatureWorkspace workspace;
  FeatureImage found;
  FeatureTiles all;
  all.want_all({210, 150});
  const WorkingFrame other = rough_frame(210, 150, random);
  compute_features({other, {}, all}, 1, workspace, found);  // another image, left in the memory
  compute_features({frame, {}, tiles}, 2, workspace, found);
  const int planes = FeatureLayout().planes();
  std::vector<cv::Rect> parts;
  for (int row = 0; row < tiles.rows(); ++row) tiles.list_parts(row, 128, parts);
  ASSERT_EQ(parts.size(), 3U);
  for (const cv::Rect& part : parts) EXPECT_EQ(differences(found, expected, part, 0, planes), 0) << part;
  EXPECT_EQ(differences(found, expected, {200, 150, kPad, kPad}, 0, planes), 0);  // the corner of the border
  EXPECT_GT(differences(found, expected, {0, 0, 32, 32}, 0, planes), 0);
}

}  // namespace
}  // namespace houghstream::baseline
