#include "detector/features/tile_features.hpp"

namespace houghstream {
namespace {

constexpr int kWindow = 2;  // pixels that a histogram's window reaches

}  // namespace

DepthSteps depth_steps(const WorkingFrame& frame, const FeatureSettings& settings) {
  if (settings.handling == ScaleHandling::kDepthNormalised) return {FeatureLayout::kWrapStep, StepBytes::kWrapped};
  return {FeatureLayout::kScaledStep * frame.size_ratio, StepBytes::kLimited};
}

int lab_margin(const FeatureSettings& settings) {
  return Neighbourhood{settings.min_max_px}.before() + kWindow + 1;
}

void TileFeatures::compute(const TileSources& sources, cv::Rect part) {
  part_ = part;
  image_ = {-part.x, -part.y, sources.frame.colour.cols, sources.frame.colour.rows};
  around_ = {sources.settings.min_max_px};
  rows_.reset(part.size(), sources.layout.pixel_stride());
  const int spare = sources.layout.pixel_stride() - sources.layout.planes();
  for (int y = 0; y < part.height; ++y) {
    std::fill_n(rows_.row(y, sources.layout.planes()), spare * rows_.stride(), std::uint8_t{0});
  }
  if ((sources.settings.families & (kDepthDerivatives | kDepthHog)) != 0) derive_depth_of(sources);
  const auto& blocks = sources.layout.blocks();
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const FeatureBlock& block = blocks[b];
    switch (block.family) {
      case kIntensity: add_intensity(sources, block); break;
      case kDepthValue: add_depth_value(sources, block); break;
      case kDepthDerivatives: add_derivatives(block); break;
      case kDepthHog: add_histograms(depth_.dx, depth_.dy, kDepthGain, block.first, block.count); break;
      default: add_base(sources.base[b], block);
    }
  }
}

void TileFeatures::add_extremes(const TilePlane<std::uint8_t>& plane, int first, int index, int count) {
  byte_extremes(plane, around_, {first + index, first + count + index}, rows_);
}

void TileFeatures::add_intensity(const TileSources& sources, const FeatureBlock& block) {
  const int margin = around_.before();
  for (int c = 2; c >= 0; --c) {  // lightness last: the others are made of it
    plane_.reset(part_.size(), margin + kWindow + 1);
    plane_.load(sources.lab[static_cast<std::size_t>(c)], part_.tl());
    add_extremes(plane_, block.first, c, block.count);
  }
  for (auto& bytes : lightness_.bytes) bytes.reset(part_.size(), margin);
  lightness_.dx.reset(part_.size(), margin + kWindow);
  lightness_.dy.reset(part_.size(), margin + kWindow);
  differentiate_lightness(plane_, lightness_);
  for (int i = 0; i < 4; ++i) {
    auto& bytes = lightness_.bytes[static_cast<std::size_t>(i)];
    bytes.extend(image_);
    add_extremes(bytes, block.first, 3 + i, block.count);
  }
  add_histograms(lightness_.dx, lightness_.dy, kIntensityGain, block.first + 7, block.count);
}

void TileFeatures::add_histograms(const TilePlane<float>& dx, const TilePlane<float>& dy, float gain, int first,
                                  int count) {
  for (auto& bin : bins_) bin.reset(part_.size(), dx.margin());
  bin_gradients(dx, dy, gain, bins_);
  plane_.reset(part_.size(), around_.before());
  for (int b = 0; b < HistogramSteps::kBins; ++b) {
    auto& bin = bins_[static_cast<std::size_t>(b)];
    bin.extend(image_);
    smooth_bin(bin, plane_);
    plane_.extend(image_);
    add_extremes(plane_, first, b, count);
  }
}

void TileFeatures::derive_depth_of(const TileSources& sources) {
  const int margin = around_.before() + kWindow;
  const int half = sources.settings.depth_sobel_px / 2;
  metres_.reset(part_.size(), margin + half);
  metres_.load(sources.frame.filled_depth, part_.tl());
  depth_.dx.reset(part_.size(), margin);
  depth_.dy.reset(part_.size(), margin);
  for (auto& bytes : depth_.bytes) bytes.reset(part_.size(), margin);
  differentiate_depth(metres_, sources.kernels, static_cast<float>(sources.frame.camera.fx), depth_);
}

void TileFeatures::add_derivatives(const FeatureBlock& block) {
  for (int i = 0; i < block.count; ++i) {
    auto& bytes = depth_.bytes[static_cast<std::size_t>(i)];
    bytes.extend(image_);
    add_extremes(bytes, block.first, i, block.count);
  }
}

void TileFeatures::add_depth_value(const TileSources& sources, const FeatureBlock& block) {
  metres_.reset(part_.size(), around_.before());
  metres_.load(sources.frame.filled_depth, part_.tl());
  steps_.reset(part_.size(), around_.before());
  const DepthSteps steps = depth_steps(sources.frame, sources.settings);
  quantise_depth(metres_, steps.metres, steps_);
  step_extremes(steps_, around_, steps.bytes, {block.first, block.first + 1}, rows_);
}

void TileFeatures::add_base(const std::vector<cv::Mat>& base, const FeatureBlock& block) {
  for (int i = 0; i < block.count; ++i) {
    const cv::Mat& plane = base[static_cast<std::size_t>(i)];
    plane_.reset(part_.size(), around_.before());
    plane_.load(plane, part_.tl());
    if (block.min_max) {
      add_extremes(plane_, block.first, i, block.count);
    } else {
      for (int y = 0; y < part_.height; ++y) std::copy_n(plane_.row(y), part_.width, rows_.row(y, block.first + i));
    }
  }
}

}  // namespace houghstream
