#pragma once

#include <map>
#include <string>

#include "drivers/store/object_store.hpp"

namespace houghstream::store {

/// The value that a threshold is for: detections' scores or poses' qualities.
enum class PracticeMeasure { kScore, kQuality };

/// Returns for each object, by name, the least score or quality from which on its detections or poses had this
/// precision in its practice, as choose_threshold() chooses it. A line of the log names each object that does not reach
/// it, with the best that there is, which is taken; an object of which practice has nothing is named and left out.
/// Throws InputError for a precision outside 0 to kMaxPrecision, and, naming the command that learns it, where objects
/// have no record of practice.
std::map<std::string, float> thresholds_for_precision(const ObjectStore& store, PracticeMeasure measure,
                                                      double precision);

}  // namespace houghstream::store
