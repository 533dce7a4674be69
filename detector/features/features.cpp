#include "detector/features/features.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "pipeline/parallel.hpp"

namespace houghstream {
namespace {

/// Depth to the wrapping byte planes described in FeatureLayout.
cv::Mat wrapped(const cv::Mat& depth) {
  cv::Mat out(depth.size(), CV_8UC1);
  for (int y = 0; y < depth.rows; ++y) {
    const auto* in = depth.ptr<float>(y);
    auto* row = out.ptr<std::uint8_t>(y);
    for (int x = 0; x < depth.cols; ++x) {
      const float steps = in[x] / FeatureLayout::kDepthStep + 0.5F;
      const bool known = steps >= 0.0F && steps < 1e6F;  // false for NaN and for what the filters left infinite
      row[x] = known ? static_cast<std::uint8_t>(static_cast<std::uint32_t>(steps) & 255U) : std::uint8_t{0};
    }
  }
  return out;
}

/// Planes in the order of FeatureLayout: maxima, then minima, of `base` planes to `planes` from `channel` on.
void min_max_planes(const std::vector<cv::Mat>& base, std::size_t channel, int kernel_px, int threads,
                    std::vector<cv::Mat>& planes) {
  const cv::Mat kernel = cv::getStructuringElement(cv::MORPH_RECT, cv::Size(kernel_px, kernel_px));
  parallel_for(threads, static_cast<int>(base.size()), [&](int i) {
    const auto b = static_cast<std::size_t>(i);
    const bool is_depth = base[b].type() == CV_32FC1;
    cv::Mat largest;
    cv::Mat smallest;
    cv::dilate(base[b], largest, kernel);
    cv::erode(base[b], smallest, kernel);
    planes[channel + b] = is_depth ? wrapped(largest) : largest;
    planes[channel + b + base.size()] = is_depth ? wrapped(smallest) : smallest;
  });
}

/// All planes into one image, pixel by pixel, so that every cache line is written once.
void interleave(const std::vector<cv::Mat>& planes, int threads, FeatureImage& image) {
  constexpr int kRows = 16;
  parallel_for(threads, (image.height() + kRows - 1) / kRows, [&](int band) {
    std::vector<const std::uint8_t*> rows(planes.size());
    for (int y = band * kRows; y < std::min(image.height(), (band + 1) * kRows); ++y) {
      for (std::size_t p = 0; p < planes.size(); ++p) rows[p] = planes[p].ptr<std::uint8_t>(y);
      std::uint8_t* out = image.at(0, y);
      for (int x = 0; x < image.width(); ++x, out += FeatureImage::kChannels) {
        for (std::size_t p = 0; p < planes.size(); ++p) out[p] = rows[p][x];
      }
    }
  });
}

}  // namespace

FeatureImage compute_features(const WorkingFrame& frame, const FeatureSettings& settings, int threads) {
  std::vector<cv::Mat> intensity;
  std::vector<cv::Mat> depth;
  parallel_for(threads, 2, [&](int part) {
    if (part == 0) {
      intensity = intensity_planes(frame.colour);
    } else {
      depth = depth_planes(frame, settings);
    }
  });
  depth[0] = depth[0].clone();
  cv::patchNaNs(depth[0], 0.0);  // filters order NaN unpredictably
  std::vector<cv::Mat> planes(FeatureLayout::kPlanes);
  min_max_planes(intensity, 0, settings.min_max_px, threads, planes);
  min_max_planes(depth, FeatureLayout::kDepthMax, settings.min_max_px, threads, planes);
  FeatureImage image(frame.colour.cols, frame.colour.rows);
  interleave(planes, threads, image);
  image.replicate_border();
  return image;
}

}  // namespace houghstream
