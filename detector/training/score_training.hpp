#pragma once

#include "detector/forest/forest.hpp"
#include "detector/profiles.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream::training {

/// Learns the weights of the score (evidence/score_model.hpp) of each class in `objects`, whose views are the last of
/// the forest's, beginning from those of all of them together: objects are put into rooms that the trees have not seen,
/// the forest looks for them, and what it finds is compared with what is there. Same result for any number of threads.
void train_score_model(const std::vector<const TrainingView*>& objects, const std::vector<const TrainingView*>& rooms,
                       const Profile& profile, Forest& forest);

}  // namespace houghstream::training
