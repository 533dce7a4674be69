#include "detector/features/working_frame.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace houghstream {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// Mean of those depths of the block that belong to its nearest surface.
float nearest_surface(const cv::Mat& depth, int x0, int x1, int y0, int y1) {
  float nearest = std::numeric_limits<float>::infinity();
  for (int y = y0; y < y1; ++y) {
    const auto* row = depth.ptr<float>(y);
    for (int x = x0; x < x1; ++x) nearest = row[x] < nearest ? row[x] : nearest;
  }
  const float limit = nearest * 1.02F;
  float sum = 0.0F;
  int count = 0;
  for (int y = y0; y < y1; ++y) {
    const auto* row = depth.ptr<float>(y);
    for (int x = x0; x < x1; ++x) {
      if (row[x] <= limit) {
        sum += row[x];
        ++count;
      }
    }
  }
  return count > 0 && std::isfinite(nearest) ? sum / static_cast<float>(count) : kNone;
}

cv::Mat shrink_depth(const cv::Mat& depth, cv::Size size) {
  cv::Mat out(size, CV_32FC1);
  std::vector<int> columns(static_cast<std::size_t>(size.width) + 1);
  for (int x = 0; x <= size.width; ++x) columns[static_cast<std::size_t>(x)] = x * depth.cols / size.width;
  for (int y = 0; y < size.height; ++y) {
    const int y0 = y * depth.rows / size.height;
    const int y1 = std::max(y0 + 1, (y + 1) * depth.rows / size.height);
    auto* row = out.ptr<float>(y);
    for (int x = 0; x < size.width; ++x) {
      const int x0 = columns[static_cast<std::size_t>(x)];
      row[x] = nearest_surface(depth, x0, std::max(x0 + 1, columns[static_cast<std::size_t>(x) + 1]), y0, y1);
    }
  }
  return out;
}

void fill_holes(cv::Mat& depth, float max_distance_px) {
  cv::Mat missing(depth.size(), CV_8UC1);
  int holes = 0;
  for (int y = 0; y < depth.rows; ++y) {
    const auto* row = depth.ptr<float>(y);
    auto* out = missing.ptr<std::uint8_t>(y);
    for (int x = 0; x < depth.cols; ++x) {
      out[x] = std::isnan(row[x]) ? 1 : 0;
      holes += out[x];
    }
  }
  if (holes == 0 || holes == depth.rows * depth.cols) return;
  cv::Mat distance;
  cv::Mat labels;
  cv::distanceTransform(missing, distance, labels, cv::DIST_L2, cv::DIST_MASK_5, cv::DIST_LABEL_PIXEL);
  std::vector<float> depth_of_label(static_cast<std::size_t>(depth.rows * depth.cols - holes) + 1, kNone);
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      if (missing.at<std::uint8_t>(y, x) == 0) {
        depth_of_label[static_cast<std::size_t>(labels.at<int>(y, x))] = depth.at<float>(y, x);
      }
    }
  }
  for (int y = 0; y < depth.rows; ++y) {
    auto* row = depth.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) {
      if (std::isnan(row[x]) && distance.at<float>(y, x) <= max_distance_px) {
        row[x] = depth_of_label[static_cast<std::size_t>(labels.at<int>(y, x))];
      }
    }
  }
}

}  // namespace

std::array<FeatureLevel, 2> feature_levels(const FeatureSettings& settings) {
  return {{{settings.image_scale, 0.0F, settings.far_distance},
           {2.0F * settings.image_scale, settings.far_distance, settings.max_distance}}};
}

WorkingFrame make_working_frame(const RgbdFrame& frame, float scale, const FeatureSettings& settings) {
  WorkingFrame out;
  out.camera = frame.camera.scaled(scale);
  const cv::Size size(out.camera.width, out.camera.height);
  if (size == frame.colour.size()) {
    out.colour = frame.colour;
    out.filled_depth = frame.depth.clone();
  } else {
    cv::resize(frame.colour, out.colour, size, 0, 0, cv::INTER_AREA);
    out.filled_depth = shrink_depth(frame.depth, size);
  }
  fill_holes(out.filled_depth, settings.fill_distance_px);
  return out;
}

}  // namespace houghstream
