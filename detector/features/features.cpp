#include "detector/features/features.hpp"

#include <algorithm>
#include <array>
#include <climits>
#include <opencv2/imgproc.hpp>

#include "detector/baseline/surface_planes.hpp"
#include "detector/features/picture_memory.hpp"
#include "detector/features/tiles/tile_features.hpp"
#include "detector/features/tiles/tile_turn.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream {
namespace {

/// What is kept from frame to frame for its memory.
struct Scratch {
  std::vector<cv::Rect> parts;
  std::vector<cv::Range> columns;  // by row of tiles: from the first wanted one to the last
  std::array<PictureMemory, 3> lab_memory;
  std::array<cv::Mat, 3> lab;
  int sobel_px = 0;  // of the kernels
  SobelKernels kernels;
};

void list_parts(const FeatureTiles& tiles, Scratch& scratch) {
  scratch.parts.clear();
  scratch.columns.assign(static_cast<std::size_t>(tiles.rows()), cv::Range(INT_MAX, INT_MIN));
  for (int row = 0; row < tiles.rows(); ++row) {
    const std::size_t first = scratch.parts.size();
    tiles.list_parts(row, kLongestPart, scratch.parts);
    if (scratch.parts.size() == first) continue;
    const cv::Rect& last = scratch.parts.back();
    scratch.columns[static_cast<std::size_t>(row)] = {scratch.parts[first].x, last.x + last.width};
  }
}

/// Lightness and colour of one row of tiles, as far as it or the rows beside it will look at them.
void convert_row(const cv::Mat& colour, int row, int margin, Scratch& scratch) {
  cv::Range columns(INT_MAX, INT_MIN);
  const auto last = static_cast<int>(scratch.columns.size()) - 1;
  for (int r = std::max(0, row - 1); r <= std::min(last, row + 1); ++r) {
    columns.start = std::min(columns.start, scratch.columns[static_cast<std::size_t>(r)].start);
    columns.end = std::max(columns.end, scratch.columns[static_cast<std::size_t>(r)].end);
  }
  if (columns.end < columns.start) return;
  columns = {std::max(0, columns.start - margin), std::min(colour.cols, columns.end + margin)};
  const cv::Range rows(row * FeatureTiles::kSide, std::min(colour.rows, (row + 1) * FeatureTiles::kSide));
  static thread_local PictureMemory memory;  // kept from row to row
  cv::Mat lab = memory.picture(cv::Size(columns.size(), rows.size()), CV_8UC3);
  cv::cvtColor(colour(rows, columns), lab, cv::COLOR_BGR2Lab);
  std::array<cv::Mat, 3> places;
  for (std::size_t c = 0; c < places.size(); ++c) places[c] = scratch.lab[c](rows, columns);
  cv::split(lab, places.data());
}

}  // namespace

DepthSteps depth_steps(const WorkingFrame& frame, const FeatureSettings& settings) {
  if (settings.handling == ScaleHandling::kDepthNormalised) return {FeatureLayout::kWrapStep, StepBytes::kWrapped};
  return {FeatureLayout::kScaledStep * frame.size_ratio, StepBytes::kLimited};
}

void compute_features(const WorkingFrame& frame, const FeatureSettings& settings, const FeatureTiles& tiles,
                      int threads, FeatureImage& image) {
  static thread_local Scratch kept;
  Scratch& scratch = kept;  // this thread's in all threads
  list_parts(tiles, scratch);
  if ((settings.families & kIntensity) != 0) {
    for (std::size_t c = 0; c < scratch.lab.size(); ++c) {
      scratch.lab[c] = scratch.lab_memory[c].picture(frame.colour.size(), CV_8UC1);
    }
    parallel_for(threads, tiles.rows(),
                 [&](int row) { convert_row(frame.colour, row, lab_margin(settings), scratch); });
  }
  const FeatureLayout layout(settings);
  std::vector<std::vector<cv::Mat>> base;
  for (const FeatureBlock& block : layout.blocks()) base.push_back(surface_planes(block.family, frame, threads));
  if (scratch.sobel_px != settings.depth_sobel_px) scratch.kernels = sobel_kernels(settings.depth_sobel_px);
  scratch.sobel_px = settings.depth_sobel_px;
  const TileSources sources{frame, settings, layout, scratch.lab, scratch.kernels, base};
  image.reset(frame.colour.cols, frame.colour.rows, layout.pixel_stride());
  parallel_for(threads, static_cast<int>(scratch.parts.size()), [&](int i) {
    static thread_local TileFeatures features;  // kept from part to part
    const cv::Rect& part = scratch.parts[static_cast<std::size_t>(i)];
    features.compute(sources, part);
    turn_planes(features.rows(), part, image);
    image.replicate_border(part);
  });
}

FeatureImage compute_features(const WorkingFrame& frame, const FeatureSettings& settings, int threads) {
  FeatureTiles tiles;
  tiles.want_all(frame.colour.size());
  FeatureImage image;
  compute_features(frame, settings, tiles, threads, image);
  return image;
}

}  // namespace houghstream
