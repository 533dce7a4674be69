#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/types/detection.hpp"
#include "pipeline/types/object_pose.hpp"

namespace houghstream {

/// Published results, in the order of the log.
struct PublishedResults {
  std::vector<Detections> detections;
  std::vector<ObjectPoses> poses;
};

/// Reads the results of one camera's frames in an LCM log; other channels are passed over. `frame_channels` (a
/// ChannelPattern) says which camera's. Throws InputError when the log or a message in it is damaged, when it holds no
/// detections at all, or results of several cameras, since a scene is what one camera saw.
PublishedResults read_result_log(const std::filesystem::path& log_file, const std::string& frame_channels = ".*");

}  // namespace houghstream
