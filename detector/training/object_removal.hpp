#pragma once

#include <string>

#include "detector/forest/forest.hpp"

namespace houghstream::training {

/// Returns the forest without an object: its
Forest remove_object(const Forest& forest, const std::string& name);

}  // namespace houghstream::training
