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

/// Between the pixels of one surface the depth is interpolated, between two surfaces it is that of the nearest pixel.
cv::Mat enlarge_depth(const cv::Mat& depth, cv::Size size) {
  cv::Mat nearest;
  cv::Mat smooth;
  cv::resize(depth, nearest, size, 0, 0, cv::INTER_NEAREST);
  cv::resize(depth, smooth, size, 0, 0, cv::INTER_LINEAR);
  for (int y = 0; y < size.height; ++y) {
    const auto* from = nearest.ptr<float>(y);
    auto* to = smooth.ptr<float>(y);
    for (int x = 0; x < size.width; ++x) {
      if (!(std::abs(to[x] - from[x]) < 0.01F * from[x])) to[x] = from[x];  // also where either is NaN
    }
  }
  return smooth;
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

std::vector<FeatureLevel> feature_levels(const FeatureSettings& settings) {
  constexpr float kAnywhere = std::numeric_limits<float>::infinity();
  std::vector<FeatureLevel> levels;
  if (settings.handling == ScaleHandling::kScaleSpace) {
    for (const float ratio : settings.scales) {
      if (ratio > 0.0F) levels.push_back({settings.image_scale * ratio, ratio, 0.0F, kAnywhere});
    }
    return levels;
  }
  levels.push_back({settings.image_scale, 1.0F, 0.0F, std::min(settings.far_distance, settings.max_distance)});
  if (settings.far_distance < settings.max_distance) {
    levels.push_back({2.0F * settings.image_scale, 1.0F, settings.far_distance, settings.max_distance});
  }
  return levels;
}

WorkingFrame make_working_frame(const RgbdFrame& frame, float scale, const FeatureSettings& settings) {
  WorkingFrame out;
  out.camera = frame.camera.scaled(scale);
  const cv::Size size(out.camera.width, out.camera.height);
  if (size == frame.colour.size()) {
    out.colour = frame.colour;
    out.filled_depth = frame.depth.clone();
  } else {
    cv::resize(frame.colour, out.colour, size, 0, 0, scale < 1.0F ? cv::INTER_AREA : cv::INTER_LINEAR);
    out.filled_depth = scale < 1.0F ? shrink_depth(frame.depth, size) : enlarge_depth(frame.depth, size);
  }
  fill_holes(out.filled_depth, settings.fill_distance_px);
  return out;
}

WorkingFrame make_working_frame(const RgbdFrame& frame, const FeatureLevel& level, const FeatureSettings& settings) {
  WorkingFrame out = make_working_frame(frame, level.scale, settings);
  out.size_ratio = level.size_ratio;
  return out;
}

}  // namespace houghstream
