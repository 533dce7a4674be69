#pragma once

#include <map>
#include <optional>
#include <string>

#include "detector/detector_settings.hpp"
#include "detector/forest/forest.hpp"
#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "tools/evaluate/result_log.hpp"

namespace houghstream {

/// Detects in every Nth frame of the scene, and estimates poses where there are models (by class name), without LCM.
PublishedResults run_in_process(const BopScene& scene, Forest forest, const DetectionSettings& settings, int every,
                                const std::map<std::string, Mesh>& models);

}  // namespace houghstream
