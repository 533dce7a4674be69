#pragma once

#include <string>

#include "detector/forest/forest.hpp"

namespace houghstream::training {

/// The forest without an object: its votes, views and class are gone, and each leaf's probabilities are what they are
/// when each of the other objects weighs the same and the background as much as all of them, at most as much as before
/// (TrainingSettings::max_background_weight). Trees keep their tests, objects their ids and score. Throws InputError
/// for a name that the forest does not know, and for its only object.
Forest remove_object(const Forest& forest, const std::string& name);

}  // namespace houghstream::training
