#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "drivers/store/practice_record.hpp"
#include "tools/teach/mesh/quality_examples.hpp"

namespace houghstream::teach {

/// An object as its practice is counted.
struct PractisedObject {
  std::string name;
  Eigen::Vector3f vote_centre = Eigen::Vector3f::Zero();  ///< see store::StoredObject
};

/// Counts what was found of an object in practice. `examples` are its poses (label_examples()), `qualities` their
/// cross-fitted shape qualities in the same order. The curve of scores is of all detections, that of qualities of the
/// poses that hs-detect hands on, from kCandidatesFrom on. `reported_from` is the default threshold of scores.
store::PracticeRecord measure_practice(const PractisedObject& object, const quality::FoundPoses& found,
                                       const std::vector<quality::Example>& examples,
                                       const std::vector<float>& qualities, float reported_from);

}  // namespace houghstream::teach
