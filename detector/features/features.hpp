#pragma once

#include <array>
#include <map>
#include <opencv2/core.hpp>
#include <vector>

#include "detector/features/feature_families.hpp"
#include "detector/features/feature_image.hpp"
#include "detector/features/feature_settings.hpp"
#include "detector/features/feature_tiles.hpp"
#include "detector/features/image_buffer.hpp"
#include "detector/features/tile_features.hpp"
#include "detector/features/working_frame.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream {

/// Planes of surface families (is_surface_family) before minimum and maximum that were computed before: CV_8UC1 of the
/// frame's size. The product has none.
using ExtraPlanes = std::map<FeatureFamily, std::vector<cv::Mat>>;

/// Input of the computation of planes.
struct FeatureInput {
  const WorkingFrame& frame;
  const FeatureSettings& settings;
  const FeatureTiles& tiles;           ///< wanted tiles of the frame's size
  const ExtraPlanes* extra = nullptr;  ///< planes of each surface family in the settings
};

/// Workspace of compute_features(), reused from image to image.
struct FeatureWorkspace {
  struct Worker {
    ImageBuffer lab_row;  ///< a row of tiles
    TileFeatures part;
  };
  std::vector<cv::Rect> parts;
  std::vector<cv::Range> columns;  ///< columns from the first wanted tile to the last, by row of tiles
  std::array<ImageBuffer, 3> lab_buffers;
  std::array<cv::Mat, 3> lab;
  int sobel_px = 0;  ///< size of the kernels
  SobelKernels kernels;
  PerWorker<Worker> workers;
};

/// Computes all planes of a working frame in the order of FeatureLayout(settings) (paper, Section 3), in the wanted
/// tiles and in the border beside them. Where depth is missing beyond repair the depth planes are neutral: no slope, no
/// curvature, empty histograms. The rest of `image`, which keeps its memory, is undefined: left over from earlier
/// frames. Throws InputError for a surface family that FeatureInput::extra lacks.
void compute_features(const FeatureInput& input, int threads, FeatureWorkspace& workspace, FeatureImage& image);

/// Computes the features in all tiles.
FeatureImage compute_features(const WorkingFrame& frame, const FeatureSettings& settings, int threads,
                              const ExtraPlanes* extra = nullptr);

}  // namespace houghstream
