#include "tools/evaluate/evaluated_frame.hpp"

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

/// Gives each result to the frame of its utime.
template <typename Result>
void place(std::vector<EvaluatedFrame>& frames, const std::vector<Result>& results,
           std::optional<Result> EvaluatedFrame::*slot, const std::string& source) {
  std::map<std::int64_t, EvaluatedFrame*> by_utime;
  for (EvaluatedFrame& frame : frames) by_utime[frame.utime] = &frame;
  for (const Result& result : results) {
    const auto found = by_utime.find(result.utime);
    require(found != by_utime.end(), "{}: result of utime {}, which is no frame of the scene", source, result.utime);
    std::optional<Result>& place = found->second->*slot;
    require(!place.has_value(), "{}: two results of utime {}, expected one per frame", source, result.utime);
    place = result;
  }
}

}  // namespace

std::vector<EvaluatedFrame> read_truth(const BopScene& scene, const std::map<int, std::string>& names) {
  std::vector<EvaluatedFrame> frames;
  for (std::size_t i = 0; i < scene.images().size(); ++i) {
    EvaluatedFrame frame;
    frame.utime = dataset_utime(i);
    frame.image = i;
    for (const TrueObject& object : scene.images()[i].objects) {
      const auto name = names.find(object.object_id);
      const std::string text = name != names.end() ? name->second : fmt::format("object_{}", object.object_id);
      frame.objects.push_back({text, object});
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

void add_detections(std::vector<EvaluatedFrame>& frames, const std::vector<Detections>& results,
                    const std::string& source) {
  place(frames, results, &EvaluatedFrame::detections, source);
}

void add_poses(std::vector<EvaluatedFrame>& frames, const std::vector<ObjectPoses>& results,
               const std::string& source) {
  place(frames, results, &EvaluatedFrame::poses, source);
  for (const EvaluatedFrame& frame : frames) {
    if (!frame.poses || !frame.detections) continue;
    const int count = static_cast<int>(frame.detections->detections.size());
    for (const ObjectPose& pose : frame.poses->poses) {
      require(pose.detection_index >= 0 && pose.detection_index < count,
              "{}: pose of detection {} at utime {}, which has {} detections", source, pose.detection_index,
              frame.utime, count);
    }
  }
}

std::vector<EvaluatedFrame> every_nth(std::vector<EvaluatedFrame> frames, int every) {
  std::vector<EvaluatedFrame> chosen;
  for (std::size_t i = 0; i < frames.size(); i += static_cast<std::size_t>(every))
    chosen.push_back(std::move(frames[i]));
  return chosen;
}

std::vector<EvaluatedFrame> processed_frames(const std::vector<EvaluatedFrame>& frames) {
  std::vector<EvaluatedFrame> kept;
  for (const EvaluatedFrame& frame : frames) {
    if (frame.detections) kept.push_back(frame);
  }
  return kept;
}

}  // namespace houghstream
