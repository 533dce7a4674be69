#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include "detector/evidence/score.hpp"
#include "detector/forest/forest.hpp"
#include "detector/training/augmentation/scales.hpp"
#include "detector/training/augmentation/validation_frames.hpp"
#include "detector/training/profiles.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream::training {

/// Source of the frames that scores learn from: returns frame `index`, from 0 to count - 1, with its ground truth.
/// Called from several threads.
struct ValidationSource {
  int count = 0;
  std::function<ValidationFrame(int index)> frame;
};

/// Rooms into which views are put that trees have not seen there, see TrainingSettings::validation_frames. The views
/// and the settings must outlive it.
ValidationSource composed_frames(const std::vector<const TrainingView*>& objects,
                                 const std::vector<const TrainingView*>& backgrounds, const TrainingSettings& settings);

/// Half as many after those: things stand in them too that have an object's colours and another shape, or its shape in
/// another's colours, as rooms in which people live are full of. Composed ones else hold hardly anything that ends
/// where its outline is, but the objects, and scores that are learnt there are too high.
ValidationSource compose_hard_negative_frames(const std::vector<const TrainingView*>& objects,
                                              const std::vector<const TrainingView*>& backgrounds,
                                              const TrainingSettings& settings);

/// Labelled hypotheses of a frame, by class id.
using ScoreExamples = std::map<int, std::vector<ScoreExample>>;

/// Returns the examples of each frame, in order. View 0 of a ValidationFrame is the forest's view `first_view`. The
/// result is the same for any number of threads.
std::vector<ScoreExamples> find_score_examples(const ValidationSource& source, std::uint32_t first_view,
                                               const Profile& profile, const Forest& forest,
                                               const Scales& scales = depth_normalised_scales());

/// Learns the weights of the score (forest/score_model.hpp) of each class in `class_ids`, beginning from those of all
/// of them together.
void fit_scores(const std::vector<ScoreExamples>& by_frame, const std::set<int>& class_ids, Forest& forest);

/// Scales and shifts the log odds of each class in `class_ids`, so that a score is right about as often as it says
/// among these examples, beginning from what does so for all of them together (Platt 1999). Which detection of an
/// object scores higher than which stays.
void scale_log_odds(const std::vector<ScoreExamples>& by_frame, const std::set<int>& class_ids, Forest& forest);

}  // namespace houghstream::training
