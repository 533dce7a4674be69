#include "detector/seen_patches.hpp"

#include <vector>

#include "detector/features/features.hpp"
#include "detector/features/working_frame.hpp"

namespace houghstream {
namespace {

/// Features as far as the grid's patches from `first` on look.
void see_features(const Forest& forest, const WorkingFrame& frame, const PatchGrid& grid, std::size_t first,
                  const DetectionSettings& settings, FeatureImage& features) {
  if (settings.readable) {
    features = compute_features_readably(frame, forest.features);
    return;
  }
  static thread_local FeatureTiles tiles;  // kept from frame to frame
  tiles.clear(frame.colour.size());
  for (std::size_t p = first; p < grid.size(); ++p) {
    tiles.add_patch(grid.x[p], grid.y[p], farthest_offset(forest.patch, grid.scale[p]));
  }
  compute_features(frame, forest.features, tiles, settings.threads, features);
}

}  // namespace

void classify_patches(const Forest& forest, const RgbdFrame& frame, const DetectionSettings& settings,
                      StageClock& clock, SeenPatches& seen) {
  const auto levels = feature_levels(forest.features);
  static thread_local std::vector<WorkingFrame> working;  // kept from frame to frame, as are the features
  working.resize(levels.size());
  seen.colour.release();                             // it is the last frame's, whose memory the next one takes
  for (std::size_t l = 0; l < levels.size(); ++l) {  // Section 5.1.1
    make_working_frame(frame, levels[l].scale, forest.features, working[l]);
  }
  clock.mark("detect.resize");
  seen.grid.clear();
  seen.hough_camera = working[0].camera;
  seen.colour = working[0].colour;
  static thread_local std::vector<FeatureImage> features;
  features.resize(levels.size());
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const std::size_t first = seen.grid.size();  // Section 5.1.3
    add_patches(working[l], levels[l], static_cast<std::uint8_t>(l), forest.patch,
                {settings.stride, settings.patch_spacing}, seen.grid);
    see_features(forest, working[l], seen.grid, first, settings, features[l]);  // Section 3
  }
  clock.mark("detect.features");
  classify(forest, features, seen.grid, settings, seen.beliefs);  // Section 5.1.2
  clock.mark("detect.forest");
}

}  // namespace houghstream
