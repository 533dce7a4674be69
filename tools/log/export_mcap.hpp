#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/camera.hpp"
#include "tools/log/good_events.hpp"

namespace houghstream::log_tools {

/// Inputs that the log itself does not hold.
struct McapExtras {
  std::map<std::string, Mesh> models;  ///< meshes by class name, metres
  std::optional<Camera> camera;        ///< intrinsics of frames that come without
};

/// Writes frames of all cameras, detections, poses, objects and cameras' places of a log to a file of MCAP, as the
/// messages of Foxglove that FoxgloveMessages describes. A message's log time is that of the last event of the log that
/// it was made of, its publish time that of its frame. What cannot be understood is left out and counted in `losses`.
/// Returns the number of frames. Throws InputError where the log holds nothing of these, or the file cannot be written.
std::int64_t export_mcap(const std::filesystem::path& log_file, const McapExtras& extras,
                         const std::filesystem::path& out_file, LossReport& losses);

}  // namespace houghstream::log_tools
