#include "detector/forest/seen_patches.hpp"

#include <vector>

#include "detector/features/features.hpp"
#include "detector/features/working_frame.hpp"
#include "pipeline/base/parallel.hpp"

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
  static thread_local std::vector<WorkingFrame> kept;  // from frame to frame, as are the features
  std::vector<WorkingFrame>& working = kept;           // this thread's, for the others too
  working.resize(levels.size());
  seen.colour.release();  // it is the last frame's, whose memory the next one takes
  parallel_for(settings.threads, static_cast<int>(levels.size()), [&](int l) {  // Section 5.1.1
    const auto index = static_cast<std::size_t>(l);
    make_working_frame(frame, levels[index].scale, forest.features, working[index]);
  });
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
