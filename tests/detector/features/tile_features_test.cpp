#include "detector/features/tile_features.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "detector/baseline/reference_features.hpp"
#include "pipeline/base/random.hpp"
#include "tests/every_target.hpp"

namespace houghstream {
namespace {

/// An image with everything that its tiles are made of; base planes are noise.
struct Image {
  WorkingFrame frame;
  FeatureSettings settings;
  FeatureLayout layout;
  std::array<cv::Mat, 3> lab;
  SobelKernels kernels;
  std::vector<std::vector<cv::Mat>> base;
  TileSources sources() const { return {frame, settings, layout, lab, kernels, base}; }
};

std::uint8_t byte(Random& random) {
  return static_cast<std::uint8_t>(random.below(256));
}

Image noise(cv::Size size, std::uint32_t families, Random& random) {
  Image image;
  WorkingFrame& frame = image.frame;
  frame.camera = {size.width, size.height, 260.0, 260.0, (size.width - 1) / 2.0, (size.height - 1) / 2.0};
  frame.colour.create(size, CV_8UC3);
  frame.filled_depth.create(size, CV_32FC1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      frame.colour.at<cv::Vec3b>(y, x) = {byte(random), byte(random), byte(random)};
      frame.filled_depth.at<float>(y, x) = static_cast<float>(random.uniform(0.7, 0.72));
    }
  }
  image.settings.families = families;
  image.layout = FeatureLayout(image.settings);
  cv::Mat lab;
  cv::cvtColor(frame.colour, lab, cv::COLOR_BGR2Lab);
  cv::split(lab, image.lab.data());
  image.kernels = sobel_kernels(image.settings.depth_sobel_px);
  for (const FeatureBlock& block : image.layout.blocks()) {
    image.base.emplace_back();
    if (!is_surface_family(block.family)) continue;
    for (int i = 0; i < block.count; ++i) {
      cv::Mat_<std::uint8_t> plane(size);
      for (std::uint8_t& value : plane) value = byte(random);
      image.base.back().push_back(plane);
    }
  }
  return image;
}

/// Returns values in the first planes of a part that are not as expected(x, y, plane) says.
template <typename Expected>
int wrong_values(const TileRows& rows, cv::Size part, int planes, const Expected& expected) {
  int wrong = 0;
  for (int y = 0; y < part.height; ++y) {
    for (int p = 0; p < planes; ++p) {
      for (int x = 0; x < part.width; ++x) wrong += rows.row(y, p)[x] == expected(x, y, p) ? 0 : 1;
    }
  }
  return wrong;
}

int wrong_values(const TileRows& rows, const TileRows& expected, cv::Size part, int planes) {
  return wrong_values(rows, part, planes, [&](int x, int y, int p) { return expected.row(y, p)[x]; });
}

TEST(TileFeatures, AnyPartHasTheReferenceValuesAndSpareOnesAreNone) {
  Random random(1);
  const Image image = noise({150, 90}, 15, random);
  const FeatureImage reference = baseline::reference_features(image.frame, image.settings);
  const int planes = image.layout.planes();
  ASSERT_LT(planes, image.layout.pixel_stride());
  simd::with_every_target([&] {
    TileFeatures features;  // the next part finds the memory of the last one, which was larger
    for (const cv::Rect& part : {cv::Rect(0, 0, 128, 32), cv::Rect(128, 64, 22, 26), cv::Rect(50, 40, 1, 3)}) {
      features.compute(image.sources(), part);
      const auto expected = [&](int x, int y, int p) {
        return p < planes ? reference.at(part.x + x, part.y + y)[p] : std::uint8_t{0};
      };
      EXPECT_EQ(wrong_values(features.rows(), part.size(), image.layout.pixel_stride(), expected), 0) << part;
    }
  });
}

TEST(TileFeatures, LookAtLightnessAndColourAsFarAsTheirMarginSays) {
  Random random(2);
  for (const int side : {1, 5}) {
    Image image = noise({80, 60}, kIntensity, random);
    image.settings.min_max_px = side;
    ASSERT_EQ(lab_margin(image.settings), 3 + side / 2);  // Sobel 1, window 2
    const cv::Rect part(30, 25, 20, 10);
    const int planes = image.layout.planes();
    TileFeatures expected;
    expected.compute(image.sources(), part);
    const auto wrong_beyond = [&](int margin) {
      Image changed = image;
      const cv::Rect seen(part.x - margin, part.y - margin, part.width + 2 * margin, part.height + 2 * margin);
      for (std::size_t c = 0; c < 3; ++c) {
        const cv::Mat inverted = 255 - image.lab[c];
        image.lab[c](seen).copyTo(inverted(seen));
        changed.lab[c] = inverted;
      }
      TileFeatures found;
      found.compute(changed.sources(), part);
      return wrong_values(found.rows(), expected.rows(), part.size(), planes);
    };
    EXPECT_EQ(wrong_beyond(lab_margin(image.settings)), 0) << side;
    EXPECT_GT(wrong_beyond(lab_margin(image.settings) - 1), 0) << side;
  }
}

TEST(TileFeatures, PlanesComputedBeforehandAreCopiedOrHaveTheirExtremes) {
  Random random(3);
  const Image image = noise({60, 50}, kHonv | kCurvature, random);
  const cv::Rect part(32, 32, 28, 18);  // at the corner
  const FeatureBlock& copied = image.layout.block(kHonv);
  const FeatureBlock& spread = image.layout.block(kCurvature);
  ASSERT_FALSE(copied.min_max);
  ASSERT_TRUE(spread.min_max);
  TileFeatures features;
  features.compute(image.sources(), part);
  const auto wrong = [&](const cv::Mat& plane, int index) {
    int count = 0;
    for (int y = 0; y < part.height; ++y) {
      for (int x = 0; x < part.width; ++x)
        count += features.rows().row(y, index)[x] == plane.at<std::uint8_t>(part.y + y, part.x + x) ? 0 : 1;
    }
    return count;
  };
  for (int i = 0; i < copied.count; ++i) {
    EXPECT_EQ(wrong(image.base[0][static_cast<std::size_t>(i)], copied.first + i), 0) << i;
  }
  const cv::Mat around = cv::Mat::ones(5, 5, CV_8UC1);
  for (int i = 0; i < spread.count; ++i) {
    cv::Mat largest;
    cv::Mat smallest;
    cv::dilate(image.base[1][static_cast<std::size_t>(i)], largest, around);
    cv::erode(image.base[1][static_cast<std::size_t>(i)], smallest, around);
    EXPECT_EQ(wrong(largest, spread.first + i), 0) << i;
    EXPECT_EQ(wrong(smallest, spread.first + spread.count + i), 0) << i;
  }
}

}  // namespace
}  // namespace houghstream
