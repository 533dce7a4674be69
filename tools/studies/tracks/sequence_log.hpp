#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/studies/tracks/sequence_file.hpp"

namespace houghstream::studies {

/// Writes a sequence as the cameras and whoever knows their places would have sent it: each frame on its camera's
/// channel, and before it the transform <CAMERA>_TO_WORLD. `wrong_m` is added to the places of cameras by channel, to
/// see whether it is noticed.
void write_sequence_log(const SequenceFile& sequence, const std::filesystem::path& log,
                        const std::map<std::string, Eigen::Vector3d>& wrong_m);

/// A log of frames with the results of other logs behind each frame (same name): first those of the first log. Throws
/// InputError where a log cannot be read or written.
void join_logs(const std::filesystem::path& frames, const std::vector<std::filesystem::path>& results,
               const std::filesystem::path& out);

}  // namespace houghstream::studies
