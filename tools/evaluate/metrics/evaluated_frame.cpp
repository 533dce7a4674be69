#include "tools/evaluate/metrics/evaluated_frame.hpp"

#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/types/frame_results.hpp"

namespace houghstream {
namespace {

/// Refuses detectors of the same object, which would count each thing twice.
void check_classes(const FrameResults& results, const std::string& where) {
  std::set<std::string> earlier;
  for (const FrameResult& result : results.results()) {
    std::set<std::string> class_names;
    for (const Detection& detection : result.detections.detections) class_names.insert(detection.class_name);
    for (const std::string& name : class_names) {
      require(earlier.insert(name).second,
              "{}: two results hold '{}', expected detectors of different objects, or one run", where, name);
    }
  }
}

void check_poses(const FrameResults& results, const std::string& where) {
  if (results.results().empty() || results.unmatched().empty()) return;
  const ObjectPoses& poses = results.unmatched().front();
  fail("{}: poses of {} objects, '{}' among them, answer none of the frame's {} results", where, poses.poses.size(),
       poses.poses.empty() ? "" : poses.poses.front().class_name, results.results().size());
}

/// Returns published results by the frames' times; all are of one camera.
std::map<std::int64_t, FrameResults> by_utime(const PublishedResults& published) {
  std::map<std::int64_t, FrameResults> results;
  for (const Detections& detections : published.detections) results[detections.frame.utime].add(detections);
  for (const ObjectPoses& poses : published.poses) results[poses.frame.utime].add(poses);
  return results;
}

}  // namespace

std::string scene_name(const BopScene& scene) {
  return std::filesystem::absolute(scene.folder() / "").lexically_normal().parent_path().filename().string();
}

int scene_number(const std::string& scene_name) {
  int number = 0;
  const char* end = scene_name.data() + scene_name.size();
  const auto result = std::from_chars(scene_name.data(), end, number);
  return result.ec == std::errc() && result.ptr == end && number >= 0 ? number : 0;
}

std::vector<EvaluatedFrame> read_ground_truth(const BopScene& scene, const std::map<int, std::string>& names) {
  std::vector<EvaluatedFrame> frames;
  for (std::size_t i = 0; i < scene.images().size(); ++i) {
    EvaluatedFrame frame;
    frame.scene = scene_name(scene);
    frame.image_id = scene.images()[i].image_id;
    frame.utime = dataset_utime(i);
    frame.image = i;
    for (const GroundTruthObject& object : scene.images()[i].objects) {
      const auto name = names.find(object.object_id);
      const std::string text = name != names.end() ? name->second : fmt::format("object_{}", object.object_id);
      frame.objects.push_back({text, object, {}});
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

void stamp_at_rate(double rate_hz, std::vector<EvaluatedFrame>& frames) {
  if (rate_hz == kDatasetRateHz) return;  // such frames are stamped at this rate
  for (std::size_t i = 0; i < frames.size(); ++i)
    frames[i].utime = dataset_utime(0) + std::llround(static_cast<double>(i) * 1e6 / rate_hz);
}

void add_results(std::vector<EvaluatedFrame>& frames, const PublishedResults& published, const std::string& source) {
  std::map<std::int64_t, EvaluatedFrame*> frame_at;
  for (EvaluatedFrame& frame : frames) frame_at[frame.utime] = &frame;
  for (const auto& [utime, results] : by_utime(published)) {
    const auto frame = frame_at.find(utime);
    require(frame != frame_at.end(), "{}: result of utime {}, which is no frame of the scene", source, utime);
    const std::string where = fmt::format("{}: utime {}", source, utime);
    check_classes(results, where);
    check_poses(results, where);
    frame->second->followed = results.followed();
    if (std::optional<FrameResult> all = results.merge()) {
      frame->second->detections = std::move(all->detections);
      frame->second->poses = std::move(all->poses);
    } else if (!results.unmatched().empty()) {
      frame->second->poses = results.unmatched().front();
    } else if (results.followed()) {
      frame->second->poses = results.followed();  // no detector ran
    }
  }
}

std::vector<EvaluatedFrame> every_nth(std::vector<EvaluatedFrame> frames, int every) {
  std::vector<EvaluatedFrame> selected;
  for (std::size_t i = 0; i < frames.size(); i += static_cast<std::size_t>(every))
    selected.push_back(std::move(frames[i]));
  return selected;
}

std::vector<EvaluatedFrame> with_unfiltered_poses(std::vector<EvaluatedFrame> frames) {
  for (EvaluatedFrame& frame : frames) {
    if (frame.unfiltered_poses) frame.poses = frame.unfiltered_poses;
  }
  return frames;
}

std::vector<EvaluatedFrame> processed_frames(const std::vector<EvaluatedFrame>& frames) {
  std::vector<EvaluatedFrame> kept;
  for (const EvaluatedFrame& frame : frames) {
    if (frame.detections) kept.push_back(frame);
  }
  return kept;
}

}  // namespace houghstream
