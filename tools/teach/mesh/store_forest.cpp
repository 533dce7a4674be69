#include "tools/teach/mesh/store_forest.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "detector/training/forest_trainer.hpp"

namespace houghstream::teach {
namespace {

int max_views(const std::vector<TrainingView>& views) {
  std::map<int, int> counts;
  for (const TrainingView& view : views) counts[view.class_id] += view.class_id > 0 ? 1 : 0;
  int most = 1;
  for (const auto& [class_id, count] : counts) most = std::max(most, count);
  return most;
}

}  // namespace

Forest train_store_forest(std::vector<TrainingView> views, const std::optional<Forest>& old,
                          const TeachOptions& options, const std::function<void(const std::string&)>& report) {
  constexpr double kToneShare = 0.7;  // see TrainingSettings
  constexpr int kPatches = 26000;     // of an object: what trees are grown of, and how long that takes
  constexpr int kMinPatches = 100;
  constexpr int kMaxPatches = 250;
  constexpr int kViewsPerPicture = 2;  // a remembered view costs a tenth of one that trees learn from
  // Many attitudes want many patches and small leaves; that fewer of them choose a test pays for it.
  constexpr int kNodeSamples = 700;
  constexpr int kTestsPerNode = 1000;
  constexpr int kMinOfLeaf = 10;
  Profile profile = options.profile;
  if (old) {
    profile = training::profile_of(*old);
    const int trees = profile.training.trees;
    const Scoring scoring = profile.training.scoring;
    profile.training = options.profile.training;
    profile.training.trees = trees;
    profile.training.scoring = scoring;
  }
  profile.training.validation_frames = 0;    // practice tells more
  profile.training.composites_per_view = 1;  // another view tells more than another room
  profile.training.tone_jitter_fraction = kToneShare;
  if (!old) profile.features.tone = kCalibrationBrightness;
  profile.training.views_per_picture = kViewsPerPicture;
  const int pictures = std::max(max_views(views) / kViewsPerPicture, 1);
  profile.training.patches_per_view = std::clamp(kPatches / pictures, kMinPatches, kMaxPatches);
  profile.training.node_samples = kNodeSamples;
  profile.training.tests_per_node = kTestsPerNode;
  profile.training.min_samples = kMinOfLeaf;
  profile.training.seed = options.seed;
  profile.training.threads = options.threads;
  return old ? training::add_objects(*old, std::move(views), profile, report)
             : training::train_forest(std::move(views), profile, report);
}

}  // namespace houghstream::teach
