#include "detector/seen_patches.hpp"

#include <vector>

#include "detector/features/features.hpp"
#include "detector/features/working_frame.hpp"

namespace houghstream {

void classify_patches(const Forest& forest, const RgbdFrame& frame, const DetectionSettings& settings,
                      StageClock& clock, SeenPatches& seen) {
  const auto levels = feature_levels(forest.features);
  std::vector<WorkingFrame> working;
  for (const FeatureLevel& level : levels) {  // Section 5.1.1
    working.push_back(make_working_frame(frame, level, forest.features));
  }
  clock.mark("detect.resize");
  std::vector<FeatureImage> features;
  for (const WorkingFrame& view : working) {  // Section 3
    features.push_back(compute_features(view, forest.features, settings.threads));
  }
  clock.mark("detect.features");
  seen.grid.clear();
  seen.hough_camera = working[0].camera;
  seen.colour = working[0].colour;
  for (std::size_t l = 0; l < levels.size(); ++l) {  // Section 5.1.3
    add_patches(working[l], levels[l], static_cast<std::uint8_t>(l), forest.patch,
                {settings.stride, settings.patch_spacing}, seen.grid);
  }
  classify(forest, features, seen.grid, settings, seen.beliefs);  // Section 5.1.2
  clock.mark("detect.forest");
}

}  // namespace houghstream
