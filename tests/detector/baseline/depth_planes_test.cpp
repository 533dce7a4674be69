#include <gtest/gtest.h>

#include <limits>

#include "detector/baseline/reference_features.hpp"
#include "detector/features/feature_families.hpp"

namespace houghstream::baseline {
namespace {

enum Plane : std::size_t { kDx, kDy, kDxx, kDyy, kHog };
constexpr int kNeutral = 128;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// Returns the surface z = distance + f(x, y), x and y in metres beside the middle pixel at that distance.
template <typename Surface>
WorkingFrame see(double distance, const Surface& surface) {
  WorkingFrame frame;
  frame.camera = {41, 41, 260.0, 260.0, 20.0, 20.0};
  frame.colour = cv::Mat(41, 41, CV_8UC3, cv::Scalar(90, 90, 90));
  frame.filled_depth.create(41, 41, CV_32FC1);
  const double px = frame.camera.metres_per_px(distance);
  for (int y = 0; y < 41; ++y) {
    for (int x = 0; x < 41; ++x) {
      frame.filled_depth.at<float>(y, x) = static_cast<float>(distance + surface((x - 20) * px, (y - 20) * px));
    }
  }
  return frame;
}

std::vector<int> at_centre(const WorkingFrame& frame) {
  const DepthPlanes planes = depth_planes(frame, {});
  EXPECT_EQ(planes.derivatives.size(), static_cast<std::size_t>(FeatureLayout().block(kDepthDerivatives).count));
  EXPECT_EQ(planes.hog.size(), static_cast<std::size_t>(FeatureLayout().block(kDepthHog).count));
  std::vector<int> values;
  for (const auto* family : {&planes.derivatives, &planes.hog}) {
    for (const cv::Mat& plane : *family) values.push_back(plane.at<std::uint8_t>(20, 20));
  }
  return values;
}

TEST(DepthFeatures, ATiltedPlaneHasItsSlopeAtEveryDistance) {
  for (const double distance : {0.5, 0.8, 1.6, 2.4}) {
    const std::vector<int> across = at_centre(see(distance, [](double x, double) { return 0.5 * x; }));
    EXPECT_NEAR(across[kDx], kNeutral + 0.5 / 2.5 * 127, 1) << distance;
    EXPECT_NEAR(across[kDy], kNeutral, 1);
    EXPECT_NEAR(across[kHog], 0.5 * 160, 2) << distance;
    const std::vector<int> down = at_centre(see(distance, [](double, double y) { return -1.0 * y; }));
    EXPECT_NEAR(down[kDx], kNeutral, 1);
    EXPECT_NEAR(down[kDy], kNeutral - 1.0 / 2.5 * 127, 1) << distance;
  }
}

TEST(DepthFeatures, ABentSurfaceHasItsCurvatureAtEveryDistance) {
  for (const double distance : {0.8, 1.6}) {
    const std::vector<int> bent = at_centre(see(distance, [](double x, double) { return 0.5 * 20.0 * x * x; }));
    EXPECT_NEAR(bent[kDxx], kNeutral + 20.0 / 60.0 * 127, 2) << distance;
    EXPECT_NEAR(bent[kDyy], kNeutral, 2);
  }
}

TEST(DepthFeatures, AnOccludingEdgeIsLimited) {
  const std::vector<int> edge = at_centre(see(0.8, [](double x, double) { return x > 0 ? 1.0 : 0.0; }));
  EXPECT_EQ(edge[kDx], kNeutral + 127);
  const std::vector<int> other_way = at_centre(see(0.8, [](double x, double) { return x < 0 ? 1.0 : 0.0; }));
  EXPECT_EQ(other_way[kDx], kNeutral - 127);
}

TEST(DepthFeatures, MissingDepthIsNeutral) {
  WorkingFrame frame = see(0.8, [](double x, double) { return 2.0 * x; });
  frame.filled_depth.at<float>(20, 21) = kNone;  // beside the pixel: its derivatives are unknown too
  std::vector<int> expected(13, 0);
  for (const std::size_t p : {kDx, kDy, kDxx, kDyy}) expected[p] = kNeutral;
  std::vector<int> found = at_centre(frame);
  EXPECT_EQ(std::vector<int>(found.begin(), found.begin() + kHog),
            std::vector<int>(expected.begin(), expected.begin() + kHog));
  frame.filled_depth.setTo(kNone);
  EXPECT_EQ(at_centre(frame), expected);
}

}  // namespace
}  // namespace houghstream::baseline
