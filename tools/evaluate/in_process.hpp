#pragma once

#include <map>
#include <string>

#include "detector/detector.hpp"
#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "tools/evaluate/result_log.hpp"

namespace houghstream {

/// Detects in every Nth frame of the scene, and estimates poses where there are models (by class name), without LCM.
PublishedResults run_in_process(const BopScene& scene, const Detector& detector, int every,
                                const std::map<std::string, Mesh>& models);

}  // namespace houghstream
