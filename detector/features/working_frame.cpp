#include "detector/features/working_frame.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "detector/features/image_buffer.hpp"
#include "pipeline/base/no_value.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream {
namespace {

/// Returns the mean of those depths of the block that belong to its nearest surface.
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
  return count > 0 && std::isfinite(nearest) ? sum / static_cast<float>(count) : kNoValue;
}

/// Averages a block of 2x2 pixels without branches: NaN fails every comparison.
float nearest_of_four(float a, float b, float c, float d) {
  float nearest = std::numeric_limits<float>::infinity();
  for (const float depth : {a, b, c, d}) nearest = depth < nearest ? depth : nearest;
  const float limit = nearest * 1.02F;
  float sum = 0.0F;
  float count = 0.0F;
  for (const float depth : {a, b, c, d}) {
    sum += depth <= limit ? depth : 0.0F;
    count += depth <= limit ? 1.0F : 0.0F;
  }
  return nearest < std::numeric_limits<float>::infinity() ? sum / count : kNoValue;
}

void halve_depth(const cv::Mat& depth, cv::Mat& out) {
  for (int y = 0; y < out.rows; ++y) {
    const auto* upper = depth.ptr<float>(2 * y);
    const auto* lower = depth.ptr<float>(2 * y + 1);
    auto* row = out.ptr<float>(y);
    for (int x = 0; x < out.cols; ++x) {
      row[x] = nearest_of_four(upper[2 * x], upper[2 * x + 1], lower[2 * x], lower[2 * x + 1]);
    }
  }
}

void shrink_depth(const cv::Mat& depth, cv::Size size, cv::Mat& out) {
  out.create(size, CV_32FC1);
  if (size * 2 == depth.size()) {
    halve_depth(depth, out);
    return;
  }
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
}

/// Enlarges depth: it is interpolated between the pixels of one surface, and that of the nearest pixel between two
/// surfaces.
void enlarge_depth(const cv::Mat& depth, cv::Size size, cv::Mat& out) {
  cv::resize(depth, out, size, 0, 0, cv::INTER_LINEAR);
  for (int y = 0; y < size.height; ++y) {
    const auto* from = depth.ptr<float>(y * depth.rows / size.height);
    auto* to = out.ptr<float>(y);
    for (int x = 0; x < size.width; ++x) {
      const float nearest = from[x * depth.cols / size.width];
      if (!(std::abs(to[x] - nearest) < 0.01F * nearest)) to[x] = nearest;  // also where either is NaN
    }
  }
}

HoleReach hole_reach(const FeatureSettings& settings, const Camera& camera) {
  return {settings.fill_distance_px, settings.fill_distance * static_cast<float>(camera.fx)};
}

/// Resizes a frame into `out`, whose memory is reused where it is not shared.
void resize_into(const RgbdFrame& frame, float scale, const FeatureSettings& settings, HoleWorkspace& holes,
                 WorkingFrame& out) {
  forget_shared(out.colour);
  forget_shared(out.filled_depth);
  out.camera = frame.camera.scaled(scale);
  out.size_ratio = 1.0F;
  const cv::Size size(out.camera.width, out.camera.height);
  if (size == frame.colour.size()) {
    out.colour = frame.colour;
    frame.depth.copyTo(out.filled_depth);
  } else {
    cv::resize(frame.colour, out.colour, size, 0, 0, scale < 1.0F ? cv::INTER_AREA : cv::INTER_LINEAR);
    if (scale < 1.0F) {
      shrink_depth(frame.depth, size, out.filled_depth);
    } else {
      enlarge_depth(frame.depth, size, out.filled_depth);
    }
  }
  fill_holes(out.filled_depth, hole_reach(settings, out.camera), holes);
}

/// Applies an affine brightness to the colours. Where `colour` shares the frame's own pixels, these stay unchanged and
/// the result is written to `memory`.
void apply_tone(const AffineBrightness& tone, const RgbdFrame& frame, cv::Mat& memory, cv::Mat& colour) {
  if (!tone.changes()) return;
  if (colour.data != frame.colour.data) return apply_affine_brightness(tone, colour, colour);
  apply_affine_brightness(tone, frame.colour, memory);
  colour = memory;
}

}  // namespace

std::vector<FeatureLevel> feature_levels(const FeatureSettings& settings) {
  std::vector<FeatureLevel> levels;
  levels.push_back({settings.image_scale, 1.0F, 0.0F, std::min(settings.far_distance, settings.max_distance)});
  if (settings.far_distance < settings.max_distance) {
    levels.push_back({2.0F * settings.image_scale, 1.0F, settings.far_distance, settings.max_distance});
  }
  return levels;
}

float focal_octave_scale(const Camera& camera) {
  constexpr double kMaxOctaves = 3.0;
  const double octaves = std::round(std::log2(static_cast<double>(kReferenceFocal_px) / camera.fx));
  return static_cast<float>(std::exp2(std::clamp(octaves, -kMaxOctaves, 1.0)));
}

std::vector<FeatureLevel> feature_levels(const FeatureSettings& settings, const Camera& camera) {
  std::vector<FeatureLevel> levels = feature_levels(settings);
  for (FeatureLevel& level : levels) level.scale *= focal_octave_scale(camera);
  return levels;
}

WorkingFrame make_working_frame(const RgbdFrame& frame, float scale, const FeatureSettings& settings) {
  WorkingFrame out;
  HoleWorkspace holes;
  resize_into(frame, scale, settings, holes, out);
  return out;
}

WorkingFrame make_working_frame(const RgbdFrame& frame, const FeatureLevel& level, const FeatureSettings& settings) {
  WorkingFrame out = make_working_frame(frame, level.scale, settings);
  out.size_ratio = level.size_ratio;
  return out;
}

void make_smoothed_lab(const cv::Mat& colour, cv::Mat& blurred, LabLevels& lab) {
  for (cv::Mat& level : lab) forget_shared(level);
  cv::blur(colour, blurred, cv::Size(3, 3));
  cv::cvtColor(blurred, lab[0], cv::COLOR_BGR2Lab);
  for (std::size_t level = 1; level < lab.size(); ++level) {
    const cv::Mat& finer = lab[level - 1];
    const cv::Size half((finer.cols + 1) / 2, (finer.rows + 1) / 2);
    cv::resize(finer, lab[level], half, 0, 0, cv::INTER_AREA);
  }
}

void make_working_images(const RgbdFrame& frame, const FeatureSettings& settings, int threads, WorkingImages& images) {
  images.levels = feature_levels(settings, frame.camera);
  images.frames.resize(images.levels.size());
  images.holes.resize(images.levels.size());
  const AffineBrightness tone = fit_affine_brightness(frame.colour, settings.tone);
  parallel_for(threads, static_cast<int>(images.levels.size()), [&](int l) {
    const auto level = static_cast<std::size_t>(l);
    resize_into(frame, images.levels[level].scale, settings, images.holes[level], images.frames[level]);
    apply_tone(tone, frame, images.toned, images.frames[level].colour);
    if (level != 0) return;
    make_smoothed_lab(images.frames[0].colour, images.blurred, images.lab);
  });
}

}  // namespace houghstream
