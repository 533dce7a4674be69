#include "tools/evaluate/metrics/search_times.hpp"

#include <fmt/format.h>

#include <string>

#include "pipeline/base/files.hpp"

namespace houghstream {
namespace {

/// Returns the sum of stages; empty where no stage has the prefix.
std::string milliseconds(const std::vector<StageTime>& stages, const std::string& prefix) {
  std::int64_t sum_us = 0;
  bool any = false;
  for (const StageTime& stage : stages) {
    if (stage.stage.rfind(prefix, 0) != 0) continue;
    sum_us += stage.duration_us;
    any = true;
  }
  return any ? fmt::format("{:.3f}", 1e-3 * static_cast<double>(sum_us)) : std::string();
}

}  // namespace

void write_search_times(const std::vector<EvaluatedFrame>& frames, const std::filesystem::path& file) {
  std::string out = "scene,image_id,detect_ms,pose_ms,detections,poses\n";
  for (const EvaluatedFrame& frame : frames) {
    if (!frame.detections) continue;
    std::size_t poses = 0;
    if (frame.poses) {
      for (const ObjectPose& pose : frame.poses->poses) poses += pose.T_camera_object ? 1 : 0;
    }
    const std::vector<StageTime>& stages = frame.poses ? frame.poses->stages : frame.detections->stages;
    out += fmt::format("{},{},{},{},{},{}\n", frame.scene, frame.image_id, milliseconds(stages, "detect."),
                       milliseconds(stages, "pose."), frame.detections->detections.size(), poses);
  }
  write_file_atomically(file, out);
}

}  // namespace houghstream
