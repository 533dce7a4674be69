#include "detector/score_training.hpp"

#include <algorithm>

#include "detector/candidates.hpp"
#include "detector/validation_frames.hpp"
#include "pipeline/parallel.hpp"

namespace houghstream {
namespace {

/// What counts as found in the paper's protocol (Section 4).
constexpr float kMinIou = 0.5F;
constexpr double kMinVisible = 0.1;

/// Strongest first; one that overlaps a stronger one of its class would not be reported, so it is no example.
std::vector<ScoreExample> judge(const std::vector<Candidate>& candidates, const ValidationFrame& truth) {
  std::vector<ScoreExample> examples;
  std::vector<const Detection*> kept;
  for (const Candidate& candidate : candidates) {
    const Detection& found = candidate.detection;
    const auto repeats = [&](const Detection* other) {
      return other->class_id == found.class_id && box_iou(other->box_px, found.box_px) > kMinIou;
    };
    if (std::any_of(kept.begin(), kept.end(), repeats)) continue;
    kept.push_back(&found);
    bool is_object = false;
    bool is_hidden = false;
    for (const ValidationFrame::Object& object : truth.objects) {
      if (object.class_id != found.class_id) continue;
      const bool meets = box_iou(found.box_px, cv::Rect2f(object.box_visible_px)) >= kMinIou;
      is_object = is_object || (meets && object.visible_fraction >= kMinVisible);
      is_hidden = is_hidden || (meets && object.visible_fraction < kMinVisible);
    }
    if (is_object || !is_hidden) examples.push_back({score_terms(candidate.evidence), is_object});
  }
  return examples;
}

}  // namespace

void train_score_model(const std::vector<const TrainingView*>& objects, const std::vector<const TrainingView*>& rooms,
                       const TrainingSettings& settings, Forest& forest) {
  DetectionSettings detection;
  detection.threads = 1;
  std::vector<std::vector<ScoreExample>> by_frame(static_cast<std::size_t>(settings.validation_frames));
  parallel_for(settings.threads, settings.validation_frames, [&](int f) {
    Random random = Random::for_item(settings.seed ^ 0x73636F7265ULL, static_cast<std::uint64_t>(f));
    const TrainingView& room = *rooms[static_cast<std::size_t>(f) % rooms.size()];
    const ValidationFrame validation = make_validation_frame(objects, room.frame, settings, random);
    StageClock clock;
    by_frame[static_cast<std::size_t>(f)] =
        judge(find_candidates(forest, validation.frame, detection, clock), validation);
  });
  std::vector<ScoreExample> examples;
  for (const auto& part : by_frame) examples.insert(examples.end(), part.begin(), part.end());
  forest.score_model = fit_score_model(examples);
}

}  // namespace houghstream
