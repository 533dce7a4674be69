#include "detector/baseline/reference_features.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "detector/baseline/surface_planes.hpp"
#include "detector/features/feature_families.hpp"
#include "detector/features/tile_derivatives.hpp"
#include "detector/features/tile_features.hpp"
#include "detector/features/tile_histograms.hpp"

namespace houghstream::baseline {
namespace {

constexpr int kBins = HistogramSteps::kBins;

/// Returns the orientation of a gradient in [0, 9) bins, unsigned, by a polynomial arctangent (error below 0.3
/// degrees), so that the result does not depend on the machine's mathematics library.
float orientation_bin(float dx, float dy) {
  const float ax = std::fabs(dx);
  const float ay = std::fabs(dy);
  const float big = ax > ay ? ax : ay;
  const float ratio = big > 0.0F ? (ax > ay ? ay : ax) / big : 0.0F;
  const float sq = ratio * ratio;
  float angle = ((-0.0464964749F * sq + 0.15931422F) * sq - 0.327622764F) * sq * ratio + ratio;
  if (ay > ax) angle = 1.57079637F - angle;
  if ((dx < 0.0F) != (dy < 0.0F)) angle = 3.14159274F - angle;
  const float bin = angle * (static_cast<float>(kBins) / 3.14159274F);
  return bin >= static_cast<float>(kBins) ? 0.0F : bin;
}

/// Returns the steps of each bin, see HistogramSteps.
std::vector<cv::Mat> shared_gradients(const cv::Mat& dx, const cv::Mat& dy, float gain) {
  std::vector<cv::Mat> planes(kBins);
  for (cv::Mat& plane : planes) plane = cv::Mat::zeros(dx.size(), CV_16UC1);
  const float steps = gain * HistogramSteps::kPerByte;
  for (int y = 0; y < dx.rows; ++y) {
    for (int x = 0; x < dx.cols; ++x) {
      const float gx = dx.at<float>(y, x);
      const float gy = dy.at<float>(y, x);
      const float magnitude = std::sqrt(gx * gx + gy * gy) * steps;
      const float bin = orientation_bin(gx, gy);
      const int low = static_cast<int>(bin);
      const float fraction = bin - static_cast<float>(low);
      const auto set = [&](int b, float part) {
        planes[static_cast<std::size_t>(b)].at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(part);
      };
      set(low, magnitude * (1.0F - fraction) + 0.5F);
      set(low + 1 == kBins ? 0 : low + 1, magnitude * fraction + 0.5F);
    }
  }
  return planes;
}

/// Returns the window's sum along one axis; what lies outside is like the nearest pixel inside.
cv::Mat summed(const cv::Mat& plane, cv::Point axis) {
  cv::Mat out(plane.size(), CV_16UC1);
  for (int y = 0; y < plane.rows; ++y) {
    for (int x = 0; x < plane.cols; ++x) {
      const auto value = [&](int step) {
        return plane.at<std::uint16_t>(std::clamp(y + step * axis.y, 0, plane.rows - 1),
                                       std::clamp(x + step * axis.x, 0, plane.cols - 1));
      };
      std::uint32_t sum = (value(0) * std::uint32_t{HistogramSteps::kWeights[0]}) >> 16;
      for (const int step : {1, 2}) {
        const auto pair = static_cast<std::uint32_t>(value(-step) + value(step));
        sum += (pair * HistogramSteps::kWeights[static_cast<std::size_t>(step)]) >> 16;
      }
      out.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(sum);
    }
  }
  return out;
}

cv::Mat absolute_derivative(const cv::Mat& lightness, int dx, int dy, double gain) {
  cv::Mat derivative;
  cv::Sobel(lightness, derivative, CV_16S, dx, dy, 3, 1.0, 0.0, cv::BORDER_REPLICATE);
  cv::Mat out;
  cv::convertScaleAbs(derivative, out, gain);
  return out;
}

/// Returns sums of products with the kernel along one axis, from the first one to the last, in this order.
cv::Mat filtered(const cv::Mat& image, const std::vector<float>& kernel, cv::Point axis) {
  cv::Mat out(image.size(), CV_32FC1);
  const int half = static_cast<int>(kernel.size()) / 2;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const auto product = [&](int i) {
        const int row = std::clamp(y + (i - half) * axis.y, 0, image.rows - 1);
        const int column = std::clamp(x + (i - half) * axis.x, 0, image.cols - 1);
        return image.at<float>(row, column) * kernel[static_cast<std::size_t>(i)];
      };
      float sum = product(0);
      for (int i = 1; i <= 2 * half; ++i) sum += product(i);
      out.at<float>(y, x) = sum;
    }
  }
  return out;
}

/// Multiplies by (focal / depth)^power: from per pixel to per metre on the object. NaN becomes 0 and values are
/// limited, since an occluding edge is no slope of a surface.
void make_metric(cv::Mat& derivative, const WorkingFrame& frame, int power, float limit) {
  const auto focal = static_cast<float>(frame.camera.fx);
  for (int y = 0; y < derivative.rows; ++y) {
    auto* out = derivative.ptr<float>(y);
    const auto* depth = frame.filled_depth.ptr<float>(y);
    for (int x = 0; x < derivative.cols; ++x) {
      const float per_metre = focal / depth[x];
      const float value = out[x] * (power == 1 ? per_metre : per_metre * per_metre);
      const float limited = value > limit ? limit : (value < -limit ? -limit : value);
      out[x] = value == value ? limited : 0.0F;
    }
  }
}

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

/// Returns the planes of a block before minimum and maximum, one per thing it measures.
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

std::vector<cv::Mat> gradient_histograms(const cv::Mat& dx, const cv::Mat& dy, float gain) {
  std::vector<cv::Mat> planes = shared_gradients(dx, dy, gain);
  for (cv::Mat& plane : planes) {
    const cv::Mat sums = summed(summed(plane, {0, 1}), {1, 0});
    plane = cv::Mat(sums.size(), CV_8UC1);
    constexpr int kPerByte = static_cast<int>(HistogramSteps::kPerByte);
    std::transform(sums.begin<std::uint16_t>(), sums.end<std::uint16_t>(), plane.begin<std::uint8_t>(), [](int steps) {
      return static_cast<std::uint8_t>(std::min((steps + kPerByte / 2 + HistogramSteps::kCut) / kPerByte, 255));
    });
  }
  return planes;
}

std::vector<cv::Mat> intensity_planes(const cv::Mat& colour_bgr) {
  cv::Mat lab;
  cv::cvtColor(colour_bgr, lab, cv::COLOR_BGR2Lab);
  std::vector<cv::Mat> planes;
  cv::split(lab, planes);
  const cv::Mat lightness = planes[0];
  planes.push_back(absolute_derivative(lightness, 1, 0, 0.5));
  planes.push_back(absolute_derivative(lightness, 0, 1, 0.5));
  planes.push_back(absolute_derivative(lightness, 2, 0, 0.5));
  planes.push_back(absolute_derivative(lightness, 0, 2, 0.5));
  cv::Mat dx;
  cv::Mat dy;
  cv::Sobel(lightness, dx, CV_32F, 1, 0, 3, 0.125, 0.0, cv::BORDER_REPLICATE);
  cv::Sobel(lightness, dy, CV_32F, 0, 1, 3, 0.125, 0.0, cv::BORDER_REPLICATE);
  for (cv::Mat& plane : gradient_histograms(dx, dy, kIntensityGain)) planes.push_back(std::move(plane));
  return planes;
}

DepthPlanes depth_planes(const WorkingFrame& frame, const FeatureSettings& settings) {
  DepthPlanes planes;
  const bool derivatives = (settings.families & kDepthDerivatives) != 0;
  const bool hog = (settings.families & kDepthHog) != 0;
  if (!derivatives && !hog) return planes;
  const SobelKernels kernels = sobel_kernels(settings.depth_sobel_px);
  const auto slope = [&](std::size_t order_x, std::size_t order_y, int power, float limit) {
    cv::Mat out = filtered(filtered(frame.filled_depth, kernels[order_y], {0, 1}), kernels[order_x], {1, 0});
    make_metric(out, frame, power, limit);
    return out;
  };
  const auto add_bytes = [&](const cv::Mat& metric, float limit) {
    cv::Mat bytes(metric.size(), CV_8UC1);
    std::transform(metric.begin<float>(), metric.end<float>(), bytes.begin<std::uint8_t>(),
                   [&](float value) { return static_cast<std::uint8_t>(value * (127.0F / limit) + 128.5F); });
    planes.derivatives.push_back(bytes);
  };
  const cv::Mat dx = slope(1, 0, 1, SlopeLimits::kSlope);
  const cv::Mat dy = slope(0, 1, 1, SlopeLimits::kSlope);
  if (derivatives) {
    add_bytes(dx, SlopeLimits::kSlope);
    add_bytes(dy, SlopeLimits::kSlope);
    add_bytes(slope(2, 0, 2, SlopeLimits::kCurvature), SlopeLimits::kCurvature);
    add_bytes(slope(0, 2, 2, SlopeLimits::kCurvature), SlopeLimits::kCurvature);
  }
  if (hog) planes.hog = gradient_histograms(dx, dy, kDepthGain);
  return planes;
}

FeatureImage reference_features(const WorkingFrame& frame, const FeatureSettings& settings) {
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

}  // namespace houghstream::baseline
