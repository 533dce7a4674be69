#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "detector/baseline/surface_planes.hpp"
#include "detector/features/features.hpp"

namespace houghstream {
namespace {

/// Metres to whole steps; 0 where unknown.
cv::Mat counted_steps(const cv::Mat& depth, float step) {
  cv::Mat out(depth.size(), CV_16UC1);
  for (int y = 0; y < depth.rows; ++y) {
    const auto* in = depth.ptr<float>(y);
    auto* row = out.ptr<std::uint16_t>(y);
    for (int x = 0; x < depth.cols; ++x) {
      const float steps = in[x] / step + 0.5F;
      const bool known = steps >= 0.0F && steps < 1e6F;  // false for NaN
      row[x] = static_cast<std::uint16_t>(known ? std::min(static_cast<int>(steps), 65535) : 0);
    }
  }
  return out;
}

cv::Mat as_bytes(const cv::Mat& steps, StepBytes bytes) {
  cv::Mat out(steps.size(), CV_8UC1);
  std::transform(steps.begin<std::uint16_t>(), steps.end<std::uint16_t>(), out.begin<std::uint8_t>(), [&](int value) {
    return static_cast<std::uint8_t>(bytes == StepBytes::kWrapped ? value & 255 : std::min(value, 255));
  });
  return out;
}

/// The planes of a block before minimum and maximum, one per thing it measures.
std::vector<cv::Mat> base_planes(const FeatureBlock& block, const WorkingFrame& frame,
                                 const FeatureSettings& settings) {
  switch (block.family) {
    case kIntensity: return intensity_planes(frame.colour);
    case kDepthValue: return {counted_steps(frame.filled_depth, depth_steps(frame, settings).metres)};
    case kDepthDerivatives: return depth_planes(frame, settings).derivatives;
    case kDepthHog: return depth_planes(frame, settings).hog;
    default: return surface_planes(block.family, frame, 1);
  }
}

void copy_plane(const cv::Mat& plane, int index, FeatureImage& image) {
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) image.at(x, y)[index] = plane.at<std::uint8_t>(y, x);
  }
}

}  // namespace

FeatureImage compute_features_readably(const WorkingFrame& frame, const FeatureSettings& settings) {
  const FeatureLayout layout(settings);
  const cv::Mat around = cv::getStructuringElement(cv::MORPH_RECT, cv::Size(settings.min_max_px, settings.min_max_px));
  const StepBytes step_bytes = depth_steps(frame, settings).bytes;
  FeatureImage image(frame.colour.cols, frame.colour.rows, layout.pixel_stride());
  for (const FeatureBlock& block : layout.blocks()) {
    const std::vector<cv::Mat> base = base_planes(block, frame, settings);
    for (int i = 0; i < block.count; ++i) {
      cv::Mat largest = base[static_cast<std::size_t>(i)];
      if (block.min_max) {
        cv::Mat smallest;
        cv::erode(largest, smallest, around);
        cv::dilate(largest.clone(), largest, around);
        if (block.family == kDepthValue) {
          largest = as_bytes(largest, step_bytes);
          smallest = as_bytes(smallest, step_bytes);
        }
        copy_plane(smallest, block.first + block.count + i, image);
      }
      copy_plane(largest, block.first + i, image);
    }
  }
  image.replicate_border();
  return image;
}

}  // namespace houghstream
