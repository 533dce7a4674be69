#include "detector/baseline/surface_window.hpp"

#include <cmath>
#include <cstdlib>

namespace houghstream::baseline {

namespace {

constexpr double kSteepest = 1.5;  // metres of depth per metre across

/// Returns at least the noise; NaN for NaN.
float at_least_noise(double metres) {
  constexpr float kMin = 0.02F;
  const auto limit = static_cast<float>(metres);
  return limit < kMin ? kMin : limit;
}

enum Sum : std::size_t { kCount, kX, kY, kZ, kXX, kXY, kXZ, kYY, kYZ, kZZ, kSums };
using RowSums = std::array<std::vector<float>, kSums>;

/// Adds the neighbours at one shift. Vectors are taken relative to the middle's, so that float sums lose nothing; no
/// branch, so that the loop runs on several pixels at once.
void add_shift(const SurfaceVectors& vectors, int y, const WindowShift& shift, const std::vector<float>& limit,
               RowSums& sums) {
  const auto [y_neighbour, dx, first_x, last_x] = shift;
  const auto* depth = vectors.depth.ptr<float>(y);
  const auto* depth_near = vectors.depth.ptr<float>(y_neighbour) + dx;
  std::array<const float*, 3> middle{};
  std::array<const float*, 3> near{};
  for (std::size_t i = 0; i < 3; ++i) {
    middle[i] = vectors.xyz[i].ptr<float>(y);
    near[i] = vectors.xyz[i].ptr<float>(y_neighbour) + dx;
  }
  for (int x = first_x; x < last_x; ++x) {
    const auto i = static_cast<std::size_t>(x);
    const bool same = std::fabs(depth_near[x] - depth[x]) < limit[i];
    const float a = same ? near[0][x] - middle[0][x] : 0.0F;
    const float b = same ? near[1][x] - middle[1][x] : 0.0F;
    const float c = same ? near[2][x] - middle[2][x] : 0.0F;
    sums[kCount][i] += same ? 1.0F : 0.0F;
    sums[kX][i] += a;
    sums[kY][i] += b;
    sums[kZ][i] += c;
    sums[kXX][i] += a * a;
    sums[kXY][i] += a * b;
    sums[kXZ][i] += a * c;
    sums[kYY][i] += b * b;
    sums[kYZ][i] += b * c;
    sums[kZZ][i] += c * c;
  }
}

WindowMoments moments_of(const RowSums& sums, std::size_t x) {
  WindowMoments moments;
  moments.count = static_cast<int>(sums[kCount][x]);
  if (moments.count == 0) return moments;
  const double n = moments.count;
  const Eigen::Vector3d mean = Eigen::Vector3d(sums[kX][x], sums[kY][x], sums[kZ][x]) / n;
  Eigen::Matrix3d squares;
  squares << sums[kXX][x], sums[kXY][x], sums[kXZ][x],  //
      sums[kXY][x], sums[kYY][x], sums[kYZ][x],         //
      sums[kXZ][x], sums[kYZ][x], sums[kZZ][x];
  moments.covariance = squares / n - mean * mean.transpose();
  return moments;
}

}  // namespace

int surface_window_radius(int neighbours) {
  int radius = 0;
  const auto misses = [neighbours](int r) { return std::abs((2 * r + 1) * (2 * r + 1) - neighbours); };
  while (misses(radius + 1) < misses(radius)) ++radius;
  return radius;
}

float same_surface_limit(const Camera& camera, float depth, int radius_px) {
  return at_least_noise(kSteepest * radius_px * camera.metres_per_px(depth));
}

float same_surface_limit(double radius_m) {
  return at_least_noise(kSteepest * radius_m);
}

std::vector<WindowMoments> row_moments(const SurfaceVectors& vectors, int y, int radius_px) {
  const cv::Size size = vectors.depth.size();
  const auto width = static_cast<std::size_t>(size.width);
  std::vector<float> limit(width);
  for (std::size_t x = 0; x < width; ++x) {
    limit[x] = same_surface_limit(vectors.camera, vectors.depth.ptr<float>(y)[x], radius_px);
  }
  RowSums sums;
  for (std::vector<float>& sum : sums) sum.assign(width, 0.0F);
  for_each_shift(size, y, radius_px, [&](const WindowShift& shift) { add_shift(vectors, y, shift, limit, sums); });
  std::vector<WindowMoments> moments(width);
  for (std::size_t x = 0; x < width; ++x) moments[x] = moments_of(sums, x);
  return moments;
}

}  // namespace houghstream::baseline
