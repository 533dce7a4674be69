#pragma once

#include <filesystem>
#include <vector>

#include "pipeline/types/detection.hpp"
#include "pipeline/types/object_pose.hpp"

namespace houghstream {

/// What was published, in the order of the log.
struct PublishedResults {
  std::vector<Detections> detections;
  std::vector<ObjectPoses> poses;
};

/// Reads all results of an LCM log; other channels are passed over. Throws InputError when the log or a message in it
/// is damaged, or when it holds no detections at all.
PublishedResults read_result_log(const std::filesystem::path& log_file);

}  // namespace houghstream
