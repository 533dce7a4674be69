#include "detector/features.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace houghstream {
namespace {

void store(const cv::Mat& plane, int channel, FeatureImage& image) {
  for (int y = 0; y < plane.rows; ++y) {
    const auto* in = plane.ptr<std::uint8_t>(y);
    std::uint8_t* out = image.at(0, y) + channel;
    for (int x = 0; x < plane.cols; ++x) out[static_cast<std::ptrdiff_t>(x) * FeatureImage::kChannels] = in[x];
  }
}

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

/// Maximum to `channel`, minimum to `channel` + `count`.
void store_min_max(const cv::Mat& plane, int channel, int count, const cv::Mat& kernel, FeatureImage& image) {
  cv::Mat largest;
  cv::Mat smallest;
  cv::dilate(plane, largest, kernel);
  cv::erode(plane, smallest, kernel);
  const bool is_depth = plane.type() == CV_32FC1;
  store(is_depth ? wrapped(largest) : largest, channel, image);
  store(is_depth ? wrapped(smallest) : smallest, channel + count, image);
}

}  // namespace

FeatureImage compute_features(const WorkingFrame& frame, const FeatureSettings& settings) {
  FeatureImage image(frame.colour.cols, frame.colour.rows);
  const cv::Mat kernel = cv::getStructuringElement(cv::MORPH_RECT, cv::Size(settings.min_max_px, settings.min_max_px));
  int channel = 0;
  for (const cv::Mat& plane : intensity_planes(frame.colour)) {
    store_min_max(plane, channel++, FeatureLayout::kIntensity, kernel, image);
  }
  channel = FeatureLayout::kDepthMax;
  for (cv::Mat& plane : depth_planes(frame, settings)) {
    if (plane.type() == CV_32FC1) cv::patchNaNs(plane = plane.clone(), 0.0);  // filters order NaN unpredictably
    store_min_max(plane, channel++, FeatureLayout::kDepth, kernel, image);
  }
  image.replicate_border();
  return image;
}

}  // namespace houghstream
