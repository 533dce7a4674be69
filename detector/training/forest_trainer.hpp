#pragma once

#include <functional>
#include <string>
#include <vector>

#include "detector/forest/forest.hpp"
#include "detector/training/augmentation/scales.hpp"
#include "detector/training/profiles.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream::training {

/// Teaches the objects in `views` (backgrounds are those of class_id 0). Same views, settings and seed: same forest,
/// bit for bit, for any number of threads. `progress` is called with one line per finished step, from any thread
/// but never from two at once. The views' images are let go as soon as nothing needs them. Throws InputError where
/// `scales` cannot teach by the profile's features.
using Progress = std::function<void(const std::string&)>;
Forest train_forest(std::vector<TrainingView> views, const Profile& profile, const Progress& progress,
                    const Scales& scales = depth_normalised_scales());

/// Teaches the objects in `views` to a forest that keeps what it knows: patches of the new objects follow the old trees
/// and leaves that they reach go on growing; nothing of the old objects' training is needed. `profile` must be that
/// of the forest, with its features, patches and number of trees. Classes are numbered after those that are there.
/// Throws InputError for an object that the forest knows already.
Forest add_objects(const Forest& old, std::vector<TrainingView> views, const Profile& profile, const Progress& progress,
                   const Scales& scales = depth_normalised_scales());

/// Returns the profile by which a forest was trained, as add_objects wants it; seed and threads are the profile's.
Profile profile_of(const Forest& forest);
/// Returns the profile of a forest, with what the forest does not hold taken from `named`, the profile of its name.
Profile profile_of(const Forest& forest, Profile named);

}  // namespace houghstream::training
