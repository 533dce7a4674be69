#include "detector/features/features.hpp"

#include <algorithm>
#include <climits>
#include <opencv2/imgproc.hpp>

#include "detector/features/tile_interleave.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

void list_parts(const FeatureTiles& tiles, FeatureWorkspace& workspace) {
  workspace.parts.clear();
  workspace.columns.assign(static_cast<std::size_t>(tiles.rows()), cv::Range(INT_MAX, INT_MIN));
  for (int row = 0; row < tiles.rows(); ++row) {
    const std::size_t first = workspace.parts.size();
    tiles.list_parts(row, kMaxPart, workspace.parts);
    if (workspace.parts.size() == first) continue;
    const cv::Rect& last = workspace.parts.back();
    workspace.columns[static_cast<std::size_t>(row)] = {workspace.parts[first].x, last.x + last.width};
  }
}

/// Lightness and colour of one row of tiles, as far as it or the rows beside it will look at them.
void convert_row(const cv::Mat& colour, int row, int margin, FeatureWorkspace& workspace, ImageBuffer& lab_row) {
  cv::Range columns(INT_MAX, INT_MIN);
  const auto last = static_cast<int>(workspace.columns.size()) - 1;
  for (int r = std::max(0, row - 1); r <= std::min(last, row + 1); ++r) {
    columns.start = std::min(columns.start, workspace.columns[static_cast<std::size_t>(r)].start);
    columns.end = std::max(columns.end, workspace.columns[static_cast<std::size_t>(r)].end);
  }
  if (columns.end < columns.start) return;
  columns = {std::max(0, columns.start - margin), std::min(colour.cols, columns.end + margin)};
  const cv::Range rows(row * FeatureTiles::kSide, std::min(colour.rows, (row + 1) * FeatureTiles::kSide));
  cv::Mat lab = lab_row.image(cv::Size(columns.size(), rows.size()), CV_8UC3);
  cv::cvtColor(colour(rows, columns), lab, cv::COLOR_BGR2Lab);
  std::array<cv::Mat, 3> places;
  for (std::size_t c = 0; c < places.size(); ++c) places[c] = workspace.lab[c](rows, columns);
  cv::split(lab, places.data());
}

/// Returns the planes of each block that tiles do not compute, before minimum and maximum.
std::vector<std::vector<cv::Mat>> surface_blocks(const FeatureLayout& layout, const ExtraPlanes* extra) {
  std::vector<std::vector<cv::Mat>> planes(layout.blocks().size());
  for (std::size_t b = 0; b < planes.size(); ++b) {
    const FeatureFamily family = layout.blocks()[b].family;
    if (!is_surface_family(family)) continue;
    require(extra != nullptr && extra->count(family) > 0, "features '{}': not in this program, expected one with {}",
            family_names(family), kStudyPrograms);
    planes[b] = extra->at(family);
  }
  return planes;
}

}  // namespace

void compute_features(const FeatureInput& input, int threads, FeatureWorkspace& workspace, FeatureImage& image) {
  const cv::Mat& colour = input.frame.colour;
  const FeatureSettings& settings = input.settings;
  workspace.workers.resize(threads);
  list_parts(input.tiles, workspace);
  if ((settings.families & kIntensity) != 0) {
    for (std::size_t c = 0; c < workspace.lab.size(); ++c) {
      workspace.lab[c] = workspace.lab_buffers[c].image(colour.size(), CV_8UC1);
    }
    parallel_for_workers(threads, input.tiles.rows(), [&](int worker, int row) {
      convert_row(colour, row, lab_margin(settings), workspace, workspace.workers[worker].lab_row);
    });
  }
  const FeatureLayout layout(settings);
  const std::vector<std::vector<cv::Mat>> base = surface_blocks(layout, input.extra);
  if (workspace.sobel_px != settings.depth_sobel_px) workspace.kernels = sobel_kernels(settings.depth_sobel_px);
  workspace.sobel_px = settings.depth_sobel_px;
  const TileSources sources{input.frame, settings, layout, workspace.lab, workspace.kernels, base};
  image.reset(colour.cols, colour.rows, layout.pixel_stride());
  parallel_for_workers(threads, static_cast<int>(workspace.parts.size()), [&](int worker, int i) {
    TileFeatures& features = workspace.workers[worker].part;
    const cv::Rect& part = workspace.parts[static_cast<std::size_t>(i)];
    features.compute(sources, part);
    interleave_planes(features.rows(), part, image);
    image.replicate_border(part);
  });
}

FeatureImage compute_features(const WorkingFrame& frame, const FeatureSettings& settings, int threads,
                              const ExtraPlanes* extra) {
  FeatureTiles tiles;
  tiles.want_all(frame.colour.size());
  FeatureWorkspace workspace;
  FeatureImage image;
  compute_features({frame, settings, tiles, extra}, threads, workspace, image);
  return image;
}

}  // namespace houghstream
