#include "detector/baseline/surface_honv.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "detector/baseline/surface_normals.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream::baseline {

namespace {

constexpr float kPi = 3.14159274F;
constexpr int kFull = 255;  // vote of one normal; a window of them must fit 16 bits
constexpr auto kPlanes = static_cast<std::size_t>(HonvLayout::kPlanes);
using Votes = std::array<float, kPlanes>;

/// Returns the weights of a unit normal for each azimuth bin, which sum to 1.
std::array<float, HonvLayout::kAzimuths> azimuth_shares(const cv::Vec3f& normal, float zenith_bin) {
  const float angle = std::atan2(normal[1], normal[0]) / (2.0F * kPi);
  const float bin = (angle < 0.0F ? angle + 1.0F : angle) * static_cast<float>(HonvLayout::kAzimuths);
  const int low = static_cast<int>(bin);
  const float fraction = bin - static_cast<float>(low);
  const float known = std::clamp(zenith_bin + 1.0F, 0.5F, 1.0F) * 2.0F - 1.0F;  // 0 on the axis, 1 from 15 degrees on
  std::array<float, HonvLayout::kAzimuths> shares{};
  shares.fill((1.0F - known) / static_cast<float>(HonvLayout::kAzimuths));
  shares[static_cast<std::size_t>(low % HonvLayout::kAzimuths)] += known * (1.0F - fraction);
  shares[static_cast<std::size_t>((low + 1) % HonvLayout::kAzimuths)] += known * fraction;
  return shares;
}

Votes votes_of(const cv::Vec3f& normal) {
  const float across = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1]);
  const float zenith = std::atan2(across, -normal[2]);
  // The zenith counts in bins from the middle of the first: -0.5 on the axis.
  const float bin = zenith / (0.5F * kPi) * static_cast<float>(HonvLayout::kZeniths) - 0.5F;
  const auto azimuths = azimuth_shares(normal, bin);
  const float limited = std::clamp(bin, 0.0F, static_cast<float>(HonvLayout::kZeniths - 1));
  const int low = std::min(static_cast<int>(limited), HonvLayout::kZeniths - 2);
  const float fraction = limited - static_cast<float>(low);
  Votes votes{};
  for (int a = 0; a < HonvLayout::kAzimuths; ++a) {
    const float azimuth = azimuths[static_cast<std::size_t>(a)];
    votes[static_cast<std::size_t>(HonvLayout::plane(a, low))] = azimuth * (1.0F - fraction);
    votes[static_cast<std::size_t>(HonvLayout::plane(a, low + 1))] = azimuth * fraction;
  }
  return votes;
}

/// Returns the votes of every normal, CV_16UC1 per bin; 0 where there is none. Integers: their sums are exact.
std::vector<cv::Mat> vote_planes(const cv::Mat& normals, int threads) {
  std::vector<cv::Mat> planes(kPlanes);
  for (cv::Mat& plane : planes) plane = cv::Mat::zeros(normals.size(), CV_16UC1);
  parallel_for(threads, normals.rows, [&](int y) {
    for (int x = 0; x < normals.cols; ++x) {
      const cv::Vec3f& normal = normals.at<cv::Vec3f>(y, x);
      if (std::isnan(normal[2])) continue;
      const Votes votes = votes_of(normal);
      for (std::size_t b = 0; b < kPlanes; ++b) {
        planes[b].at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(std::floor(votes[b] * kFull + 0.5F));
      }
    }
  });
  return planes;
}

using RowVotes = std::array<std::vector<std::uint16_t>, kPlanes + 1>;  // the last one counts the normals

/// Sums the votes around the pixels of row y, from normals of the same surface only.
RowVotes sum_votes(const std::vector<cv::Mat>& votes, const SurfaceVectors& normals, int y, int radius_px) {
  const cv::Size size = normals.depth.size();
  const auto width = static_cast<std::size_t>(size.width);
  const auto* depth = normals.depth.ptr<float>(y);
  std::vector<float> limit(width);
  for (int x = 0; x < size.width; ++x) {
    limit[static_cast<std::size_t>(x)] = same_surface_limit(normals.camera, depth[x], radius_px);
  }
  RowVotes sums;
  for (std::vector<std::uint16_t>& sum : sums) sum.assign(width, 0);
  std::vector<std::uint16_t> mask(width);
  for_each_shift(size, y, radius_px, [&](const WindowShift& shift) {
    const auto [y_neighbour, dx, first_x, last_x] = shift;
    const auto* depth_near = normals.depth.ptr<float>(y_neighbour) + dx;
    for (int x = first_x; x < last_x; ++x) {
      const auto i = static_cast<std::size_t>(x);
      const bool same = std::fabs(depth_near[x] - depth[x]) < limit[i];
      mask[i] = same ? 0xFFFF : 0;
      sums[kPlanes][i] = static_cast<std::uint16_t>(sums[kPlanes][i] + (same ? 1 : 0));
    }
    for (std::size_t b = 0; b < kPlanes; ++b) {
      const auto* near = votes[b].ptr<std::uint16_t>(y_neighbour) + dx;
      auto* sum = sums[b].data();
      for (int x = first_x; x < last_x; ++x) sum[x] = static_cast<std::uint16_t>(sum[x] + (near[x] & mask[x]));
    }
  });
  return sums;
}

}  // namespace

std::vector<cv::Mat> honv_planes(const WorkingFrame& frame, int threads) {
  const cv::Mat normals = surface_normals(frame, HonvLayout::kNeighbours, threads);
  const SurfaceVectors vectors = normal_vectors(frame, normals);
  const std::vector<cv::Mat> votes = vote_planes(normals, threads);
  const int radius = surface_window_radius(HonvLayout::kNeighbours);
  std::vector<cv::Mat> planes(kPlanes);
  for (cv::Mat& plane : planes) plane = cv::Mat::zeros(normals.size(), CV_8UC1);
  parallel_for(threads, normals.rows, [&](int y) {
    const RowVotes sums = sum_votes(votes, vectors, y, radius);
    for (std::size_t b = 0; b < kPlanes; ++b) {
      auto* out = planes[b].ptr<std::uint8_t>(y);
      for (int x = 0; x < normals.cols; ++x) {
        const auto i = static_cast<std::size_t>(x);
        const int count = sums[kPlanes][i];
        if (count > 0) out[x] = cv::saturate_cast<std::uint8_t>((sums[b][i] + count / 2) / count);
      }
    }
  });
  return planes;
}

}  // namespace houghstream::baseline
