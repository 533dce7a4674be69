#include "tools/studies/rivals/composed_examples.hpp"

#include <map>

#include "detector/training/pictures/validation_frames.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

EvaluatedFrame to_truth(const training::ValidationFrame& composed, const std::vector<const TrainingView*>& shown) {
  EvaluatedFrame truth;
  for (const training::ValidationFrame::Object& object : composed.objects) {
    NamedObject named;
    named.class_name = shown[object.view.value()]->class_name;
    named.truth.box_visible_px = object.box_visible_px;
    named.truth.visible_fraction = object.visible_fraction;
    truth.objects.push_back(named);
  }
  return truth;
}

}  // namespace

ComposedExamples compose_examples(const std::vector<TrainingView>& views, float min_distance, float max_distance,
                                  int pictures) {
  constexpr int kShownOneIn = 4;
  constexpr std::uint64_t kSeed = 20110701;
  constexpr training::ComposedThings kThings = {4, 2, 0};
  ComposedExamples out;
  std::vector<const TrainingView*> shown;
  std::vector<const TrainingView*> rooms;
  std::map<int, int> seen;  // views by class id
  for (const TrainingView& view : views) {
    if (view.class_id == 0) {
      rooms.push_back(&view);
    } else if (seen[view.class_id]++ % kShownOneIn == kShownOneIn - 1) {
      shown.push_back(&view);
    } else {
      out.taught.push_back(view);
      out.class_names.insert(view.class_name);
    }
  }
  require(!shown.empty() && !rooms.empty(), "{} views to show in {} background views, expected some of each",
          shown.size(), rooms.size());
  training::PictureSettings settings;
  settings.min_distance = min_distance;
  settings.max_distance = max_distance;
  for (std::size_t f = 0; f < static_cast<std::size_t>(pictures); ++f) {
    Random random = Random::for_item(kSeed, f);
    const training::ValidationFrame composed =
        training::make_validation_frame(shown, rooms[f % rooms.size()]->frame, kThings, settings, random);
    out.frames.push_back(composed.frame);
    out.truth.push_back(to_truth(composed, shown));
  }
  return out;
}

}  // namespace houghstream
