#pragma once

#include <filesystem>
#include <vector>

#include "tools/evaluate/metrics/evaluated_frame.hpp"

namespace houghstream {

/// Target of BOP: a number of instances of an object in an image.
struct BopTarget {
  int scene_id = 0;
  int image_id = 0;
  int object_id = 0;
  int count = 0;
};

/// Reads test_targets_bop19.json: [{"scene_id", "im_id", "obj_id", "inst_count"}, ...]. Throws InputError where it does
/// not hold that, asks for the same twice, or for nothing.
std::vector<BopTarget> read_bop_targets(const std::filesystem::path& file);

/// Returns a scene's frames that have targets, with the target objects marked: where an image holds more instances than
/// are asked for, the most visible ones are targets. Throws InputError naming `source`, the targets' file, where there
/// are none for the scene, for an image that the scene lacks, and where it asks for more than the truth has there.
std::vector<EvaluatedFrame> targeted_frames(std::vector<EvaluatedFrame> frames, const std::vector<BopTarget>& targets,
                                            const std::filesystem::path& source);

}  // namespace houghstream
