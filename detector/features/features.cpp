#include "detector/features/features.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "detector/features/surface_curvature.hpp"
#include "detector/features/surface_histograms.hpp"
#include "detector/features/surface_honv.hpp"
#include "pipeline/parallel.hpp"

namespace houghstream {
namespace {

/// Metres to bytes: modulo 256 or limited to 255; 0 where unknown.
cv::Mat quantised_depth(const cv::Mat& depth, float step, bool wraps) {
  cv::Mat out(depth.size(), CV_8UC1);
  for (int y = 0; y < depth.rows; ++y) {
    const auto* in = depth.ptr<float>(y);
    auto* row = out.ptr<std::uint8_t>(y);
    for (int x = 0; x < depth.cols; ++x) {
      const float steps = in[x] / step + 0.5F;
      const bool known = steps >= 0.0F && steps < 1e6F;  // false for NaN and for what the filters left infinite
      const std::uint32_t whole = known ? static_cast<std::uint32_t>(steps) : 0U;
      row[x] = static_cast<std::uint8_t>(wraps ? whole & 255U : std::min(whole, 255U));
    }
  }
  return out;
}

/// Largest and smallest depth around each pixel, as bytes.
void depth_value_planes(const WorkingFrame& frame, const FeatureSettings& settings, cv::Mat* planes) {
  const cv::Mat kernel = cv::getStructuringElement(cv::MORPH_RECT, cv::Size(settings.min_max_px, settings.min_max_px));
  cv::Mat depth = frame.filled_depth.clone();
  cv::patchNaNs(depth, 0.0);  // filters order NaN unpredictably
  cv::Mat largest;
  cv::Mat smallest;
  cv::dilate(depth, largest, kernel);
  cv::erode(depth, smallest, kernel);
  const bool wraps = settings.handling == ScaleHandling::kDepthNormalised;
  const float step = wraps ? FeatureLayout::kWrapStep : FeatureLayout::kScaledStep * frame.size_ratio;
  planes[0] = quantised_depth(largest, step, wraps);
  planes[1] = quantised_depth(smallest, step, wraps);
}

/// The planes of a block before minimum and maximum, one per thing it measures.
std::vector<cv::Mat> base_planes(const FeatureBlock& block, const WorkingFrame& frame, const DepthPlanes& depth,
                                 const std::vector<cv::Mat>& intensity, int threads) {
  PointHistogramSettings histograms;
  histograms.step_px = 4;  // of every pixel they would take minutes a frame
  switch (block.family) {
    case kIntensity: return intensity;
    case kDepthDerivatives: return depth.derivatives;
    case kDepthHog: return depth.hog;
    case kHonv: return honv_planes(frame, threads);
    case kCurvature: return curvature_planes(frame, threads);
    case kPointHistogram: return pfh_planes(frame, histograms, threads);
    case kFastHistogram: return fpfh_planes(frame, histograms, threads);
    case kDepthValue: break;  // its minimum and maximum are taken of metres, not of bytes
  }
  return {};
}

/// All planes into one image, pixel by pixel, so that every cache line is written once.
void interleave(const std::vector<cv::Mat>& planes, int threads, FeatureImage& image) {
  constexpr int kRows = 16;
  parallel_for(threads, (image.height() + kRows - 1) / kRows, [&](int band) {
    std::vector<const std::uint8_t*> rows(planes.size());
    for (int y = band * kRows; y < std::min(image.height(), (band + 1) * kRows); ++y) {
      for (std::size_t p = 0; p < planes.size(); ++p) rows[p] = planes[p].ptr<std::uint8_t>(y);
      std::uint8_t* out = image.at(0, y);
      for (int x = 0; x < image.width(); ++x, out += image.pixel_stride()) {
        for (std::size_t p = 0; p < planes.size(); ++p) out[p] = rows[p][x];
      }
    }
  });
}

/// Fills the block's places in `planes`.
void place_block(const FeatureBlock& block, const std::vector<cv::Mat>& base, int kernel_px, int threads,
                 cv::Mat* planes) {
  const cv::Mat kernel = cv::getStructuringElement(cv::MORPH_RECT, cv::Size(kernel_px, kernel_px));
  parallel_for(threads, static_cast<int>(base.size()), [&](int i) {
    if (block.min_max) {
      cv::dilate(base[static_cast<std::size_t>(i)], planes[i], kernel);
      cv::erode(base[static_cast<std::size_t>(i)], planes[i + block.count], kernel);
    } else {
      planes[i] = base[static_cast<std::size_t>(i)];
    }
  });
}

}  // namespace

FeatureImage compute_features(const WorkingFrame& frame, const FeatureSettings& settings, int threads) {
  std::vector<cv::Mat> intensity;
  DepthPlanes depth;
  parallel_for(threads, 2, [&](int part) {
    if (part == 0 && (settings.families & kIntensity) != 0) intensity = intensity_planes(frame.colour);
    if (part == 1) depth = depth_planes(frame, settings);
  });
  const FeatureLayout layout(settings);
  std::vector<cv::Mat> planes(static_cast<std::size_t>(layout.planes()));
  for (const FeatureBlock& block : layout.blocks()) {
    cv::Mat* out = planes.data() + block.first;
    if (block.family == kDepthValue) {
      depth_value_planes(frame, settings, out);
    } else {
      place_block(block, base_planes(block, frame, depth, intensity, threads), settings.min_max_px, threads, out);
    }
  }
  FeatureImage image(frame.colour.cols, frame.colour.rows, layout.pixel_stride());
  interleave(planes, threads, image);
  image.replicate_border();
  return image;
}

}  // namespace houghstream
