#pragma once

#include "detector/forest/forest.hpp"
#include "detector/training/augmentation/training_set.hpp"
#include "detector/training/training_settings.hpp"

namespace houghstream::training {

/// Sets each class's nominal_vote_mass: the vote mass (see Hypothesis) of a wholly visible object, as trees see it that
/// did not learn from the image. A score of 1 then means "as well seen as an average training view",
/// for every class and at every distance. `forest` must be that of the set and the settings.
void estimate_nominal_vote_mass(const TrainingSet& set, const TrainingSettings& settings, float vote_sigma,
                                Forest& forest);

/// Rescales the expected masses of the objects that both forests know, where others were added or removed: what their
/// votes bring together has changed as their probabilities in the leaves have, mean over the patches that the leaves
/// were made of.
void rescale_nominal_vote_mass(const Forest& before, Forest& after);

}  // namespace houghstream::training
