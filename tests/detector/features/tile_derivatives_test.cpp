#include "detector/features/tile_derivatives.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pipeline/base/no_value.hpp"
#include "pipeline/base/random.hpp"
#include "tests/every_target.hpp"

namespace houghstream {
namespace {

constexpr float kFocal = 260.0F;

template <typename T, typename Value>
TilePlane<T> plane_of(cv::Size part, int margin, const Value& value) {
  TilePlane<T> plane;
  plane.reset(part, margin);
  for (int y = -margin; y < part.height + margin; ++y) {
    for (int x = -margin; x < part.width + margin; ++x) plane.row(y)[x] = static_cast<T>(value(x, y));
  }
  return plane;
}

/// Returns pixels, margin included, that are not as expected(x, y) says; two NaNs differ.
template <typename T, typename Expected>
int wrong_pixels(const TilePlane<T>& plane, const Expected& expected) {
  int wrong = 0;
  for (int y = -plane.margin(); y < plane.height() + plane.margin(); ++y) {
    for (int x = -plane.margin(); x < plane.width() + plane.margin(); ++x)
      wrong += plane.row(y)[x] == static_cast<T>(expected(x, y)) ? 0 : 1;
  }
  return wrong;
}

/// Margins as they are in use: those of the gradients are wider.
LightnessDerivatives lightness_derivatives(const TilePlane<std::uint8_t>& lightness) {
  const cv::Size part(lightness.width(), lightness.height());
  LightnessDerivatives out;
  for (auto& bytes : out.bytes) bytes.reset(part, lightness.margin() - 3);
  out.dx.reset(part, lightness.margin() - 1);
  out.dy.reset(part, lightness.margin() - 1);
  differentiate_lightness(lightness, out);
  return out;
}

/// Returns the sum over the 3x3 pixels around one, times the weights down and across.
int weighed(const TilePlane<std::uint8_t>& plane, int x, int y, const cv::Vec3i& down, const cv::Vec3i& across) {
  int sum = 0;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) sum += down[j] * across[i] * plane.row(y + j - 1)[x + i - 1];
  }
  return sum;
}

const cv::Vec3i kSmooth(1, 2, 1);
const cv::Vec3i kSlope(-1, 0, 1);
const cv::Vec3i kBend(1, -2, 1);

/// Returns half of its size, rounded to even.
int half_of(int derivative) {
  const int size = std::abs(derivative);
  return std::min(255, size / 2 + (size % 4 == 3 ? 1 : 0));
}

TEST(TileDerivatives, OfLightnessAreThoseOfSobelAtEveryPixel) {
  Random random(1);
  for (const int width : {1, 37, kMaxPart}) {
    const auto lightness = plane_of<std::uint8_t>({width, 5}, 6, [&](int x, int y) {
      return y < 2 ? random.below(256) : 100 + random.below(1 + std::abs(x) % 9);
    });
    const auto at = [&](const cv::Vec3i& down, const cv::Vec3i& across) {
      return [&lightness, down, across](int x, int y) { return weighed(lightness, x, y, down, across); };
    };
    const auto bytes_at = [&](const cv::Vec3i& down, const cv::Vec3i& across) {
      return [&lightness, down, across](int x, int y) { return half_of(weighed(lightness, x, y, down, across)); };
    };
    simd::with_every_target([&] {
      const LightnessDerivatives found = lightness_derivatives(lightness);
      EXPECT_EQ(wrong_pixels(found.bytes[0], bytes_at(kSmooth, kSlope)), 0) << width;
      EXPECT_EQ(wrong_pixels(found.bytes[1], bytes_at(kSlope, kSmooth)), 0) << width;
      EXPECT_EQ(wrong_pixels(found.bytes[2], bytes_at(kSmooth, kBend)), 0) << width;
      EXPECT_EQ(wrong_pixels(found.bytes[3], bytes_at(kBend, kSmooth)), 0) << width;
      const auto dx = [&](int x, int y) { return static_cast<float>(at(kSmooth, kSlope)(x, y)) * 0.125F; };
      const auto dy = [&](int x, int y) { return static_cast<float>(at(kSlope, kSmooth)(x, y)) * 0.125F; };
      EXPECT_EQ(wrong_pixels(found.dx, dx), 0) << width;
      EXPECT_EQ(wrong_pixels(found.dy, dy), 0) << width;
    });
  }
}

TEST(TileDerivatives, OfAnEdgeInLightnessStandBesideIt) {
  const auto lightness = plane_of<std::uint8_t>({20, 3}, 4, [](int x, int) { return x < 10 ? 40 : 100; });
  simd::with_every_target([&] {
    const LightnessDerivatives found = lightness_derivatives(lightness);
    EXPECT_EQ(found.dx.row(1)[8], 0.0F);
    EXPECT_EQ(found.dx.row(1)[9], 30.0F);  // 60 over two pixels
    EXPECT_EQ(found.dx.row(1)[10], 30.0F);
    EXPECT_EQ(found.dy.row(1)[10], 0.0F);
    EXPECT_EQ(found.bytes[0].row(1)[10], 120);  // 4 x 60 / 2
    EXPECT_EQ(found.bytes[1].row(1)[10], 0);
    EXPECT_EQ(found.bytes[2].row(1)[10], 120);
    EXPECT_EQ(found.bytes[3].row(1)[10], 0);
  });
}

TEST(TileDerivatives, KernelsHaveUnitGainAtEverySize) {
  const SobelKernels small = sobel_kernels(3);
  EXPECT_EQ(small[0], (std::vector<float>{0.25F, 0.5F, 0.25F}));
  EXPECT_EQ(small[1], (std::vector<float>{-0.5F, 0.0F, 0.5F}));
  EXPECT_EQ(small[2], (std::vector<float>{1.0F, -2.0F, 1.0F}));
  for (const int size : {5, 7, 31}) {
    const SobelKernels kernels = sobel_kernels(size);
    for (std::size_t order = 0; order < 3; ++order) {
      ASSERT_EQ(static_cast<int>(kernels[order].size()), size);
      const double faculty[] = {1.0, 1.0, 2.0};
      for (std::size_t power = 0; power <= order; ++power) {  // weighted by 1, x and x^2
        double sum = 0.0;
        for (int i = 0; i < size; ++i) {
          sum += kernels[order][static_cast<std::size_t>(i)] * std::pow(i - size / 2, static_cast<double>(power));
        }
        EXPECT_NEAR(sum, power == order ? faculty[order] : 0.0, 1e-4) << size << " " << order << " " << power;
      }
    }
  }
}

DepthDerivatives depth_derivatives(const TilePlane<float>& depth, const SobelKernels& kernels) {
  const cv::Size part(depth.width(), depth.height());
  const int margin = depth.margin() - static_cast<int>(kernels[0].size()) / 2;
  DepthDerivatives out;
  for (auto& bytes : out.bytes) bytes.reset(part, margin);
  out.dx.reset(part, margin);
  out.dy.reset(part, margin);
  differentiate_depth(depth, kernels, kFocal, out);
  return out;
}

TEST(TileDerivatives, OfDepthAreMetresPerMetre) {
  const SobelKernels kernels = sobel_kernels(7);
  const auto slope = plane_of<float>({40, 4}, 6, [](int x, int y) { return 0.8 + 0.001 * x - 0.0005 * y; });
  const auto bowl = plane_of<float>({40, 4}, 6, [](int x, int) { return 0.8 + 0.5 * 1e-4 * (x - 20) * (x - 20); });
  simd::with_every_target([&] {
    const DepthDerivatives on_slope = depth_derivatives(slope, kernels);
    EXPECT_NEAR(on_slope.dx.row(0)[0], 0.325, 1e-3);  // 0.001 x 260 / 0.8
    EXPECT_NEAR(on_slope.dy.row(0)[0], -0.1625, 1e-3);
    EXPECT_EQ(on_slope.bytes[0].row(0)[0], 145);  // 128.5 + 127 x 0.325 / 2.5
    EXPECT_EQ(on_slope.bytes[1].row(0)[0], 120);
    EXPECT_EQ(on_slope.bytes[2].row(0)[0], 128);
    const DepthDerivatives in_bowl = depth_derivatives(bowl, kernels);
    EXPECT_EQ(in_bowl.bytes[0].row(2)[20], 128);
    EXPECT_EQ(in_bowl.bytes[2].row(2)[20], 150);  // 1e-4 x (260 / 0.8)^2 = 10.6 of 60 per metre
    EXPECT_EQ(in_bowl.bytes[3].row(2)[20], 128);
  });
}

TEST(TileDerivatives, CliffsAreLimitedAndUnknownDepthIsLevel) {
  const auto cliff = plane_of<float>({20, 3}, 4, [](int x, int) { return x < 10 ? 0.5 : 1.5; });
  const auto drop = plane_of<float>({20, 3}, 4, [](int x, int) { return x < 10 ? 1.5 : 0.5; });
  const auto hole = plane_of<float>({20, 3}, 4, [](int x, int y) { return x == 10 && y == 1 ? kNoValue : 0.7F; });
  const SobelKernels kernels = sobel_kernels(3);
  simd::with_every_target([&] {
    const DepthDerivatives up = depth_derivatives(cliff, kernels);
    EXPECT_EQ(up.dx.row(1)[9], 2.5F);
    EXPECT_EQ(up.bytes[0].row(1)[9], 255);
    EXPECT_EQ(up.bytes[2].row(1)[9], 255);
    const DepthDerivatives down = depth_derivatives(drop, kernels);
    EXPECT_EQ(down.dx.row(1)[10], -2.5F);
    EXPECT_EQ(down.bytes[0].row(1)[10], 1);
    const DepthDerivatives beside = depth_derivatives(hole, kernels);
    EXPECT_EQ(wrong_pixels(beside.dx, [](int, int) { return 0.0F; }), 0);
    EXPECT_EQ(wrong_pixels(beside.dy, [](int, int) { return 0.0F; }), 0);
    for (const auto& bytes : beside.bytes) EXPECT_EQ(wrong_pixels(bytes, [](int, int) { return 128; }), 0);
  });
}

/// Returns the value filtered down, then across, from the first product to the last.
float filtered_at(const TilePlane<float>& depth, int x, int y, const std::vector<float>& across,
                  const std::vector<float>& down) {
  const auto size = static_cast<int>(down.size());
  const auto column = [&](int i) {
    float sum = depth.row(y - size / 2)[i] * down[0];
    for (int j = 1; j < size; ++j) sum += depth.row(y + j - size / 2)[i] * down[static_cast<std::size_t>(j)];
    return sum;
  };
  float sum = column(x - size / 2) * across[0];
  for (int i = 1; i < size; ++i) sum += column(x + i - size / 2) * across[static_cast<std::size_t>(i)];
  return sum;
}

TEST(TileDerivatives, OfDepthAreTheSameBitForBitOnEveryInstructionSet) {
  Random random(2);
  for (const int size : {3, 7}) {
    const SobelKernels kernels = sobel_kernels(size);
    const auto depth = plane_of<float>({61, 4}, 2 + size / 2, [&](int, int y) {
      return random.uniform() < 0.003 ? static_cast<double>(kNoValue) : random.uniform(0.70, 0.70 + 0.01 * (y + 9));
    });
    const auto metric = [&](std::size_t order_x, std::size_t order_y) {
      return [&, order_x, order_y](int x, int y) {
        const float value = filtered_at(depth, x, y, kernels[order_x], kernels[order_y]);
        const float per_metre = kFocal / depth.row(y)[x];
        const bool bend = order_x + order_y == 2;
        const float limit = bend ? SlopeLimits::kCurvature : SlopeLimits::kSlope;
        const float scaled = value * (bend ? per_metre * per_metre : per_metre);
        return std::isnan(scaled) ? 0.0F : std::min(std::max(scaled, -limit), limit);
      };
    };
    const auto bend_bytes = [&](std::size_t order_x, std::size_t order_y) {
      return [steps = metric(order_x, order_y)](int x, int y) {
        return static_cast<int>(steps(x, y) * (127.0F / SlopeLimits::kCurvature) + 128.5F);
      };
    };
    simd::with_every_target([&] {
      const DepthDerivatives found = depth_derivatives(depth, kernels);
      EXPECT_EQ(wrong_pixels(found.dx, metric(1, 0)), 0) << size;
      EXPECT_EQ(wrong_pixels(found.dy, metric(0, 1)), 0) << size;
      EXPECT_EQ(wrong_pixels(found.bytes[2], bend_bytes(2, 0)), 0) << size;
      EXPECT_EQ(wrong_pixels(found.bytes[3], bend_bytes(0, 2)), 0) << size;
    });
  }
}

TEST(TileDerivatives, StepsOfDepthAreRoundedLimitedAndNoneWhereUnknown) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const std::vector<float> metres = {0.4F, 0.4019F, 0.4021F, 0.0F, 300.0F, 5000.0F, -1.0F, kNoValue, kInfinite};
  const std::vector<int> steps = {100, 100, 101, 0, 65535, 0, 0, 0, 0};
  const auto place = [&](int x, int y) { return static_cast<std::size_t>(x + 3 * y + 10) % metres.size(); };
  const auto depth = plane_of<float>({35, 3}, 2, [&](int x, int y) { return metres[place(x, y)]; });
  simd::with_every_target([&] {
    TilePlane<std::uint16_t> counted;
    counted.reset({35, 3}, 2);
    quantise_depth(depth, 0.004F, counted);
    EXPECT_EQ(wrong_pixels(counted, [&](int x, int y) { return steps[place(x, y)]; }), 0);
  });
}

}  // namespace
}  // namespace houghstream
