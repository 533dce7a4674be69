#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/object_pose.hpp"
#include "tools/evaluate/metrics/result_log.hpp"

namespace houghstream {

/// A ground-truth object with the name by which results are compared: ids differ between a scene and a forest.
struct NamedObject {
  std::string class_name;
  GroundTruthObject truth;
  /// Target flag of the object, where a list of targets is given (bop_targets.hpp); otherwise its visible fraction
  /// decides.
  std::optional<bool> is_target = std::nullopt;
};

/// One frame of a scene: the truth beside what was published for it.
struct EvaluatedFrame {
  std::string scene;  ///< the name of its folder
  std::int64_t utime = 0;
  std::size_t image = 0;  ///< position in the scene's images
  int image_id = 0;       ///< BOP's image id, in the scene
  std::vector<NamedObject> objects;
  std::optional<Detections> detections;  ///< detections of all detectors; nothing where the frame was skipped or lost
  std::optional<ObjectPoses> poses;      ///< likewise
  std::optional<ObjectPoses> followed;   ///< poses of followed objects; nothing unless hs-pose --follow published them
  /// All poses, with those that were not published because of low quality or of detections of low score; nothing unless
  /// they were estimated in this process.
  std::optional<ObjectPoses> unfiltered_poses;
};

/// Returns the name of the scene's folder, by which scenes are told apart.
std::string scene_name(const BopScene& scene);

/// Returns BOP's scene_id: the number that the folder is named by, 0 for another name.
int scene_number(const std::string& scene_name);

/// Reads the ground truth of a scene, frame by frame, with the utimes of its frames. Objects without a name are
/// "object_N".
std::vector<EvaluatedFrame> read_ground_truth(const BopScene& scene, const std::map<int, std::string>& names);

/// Gives the frames of a scene, all of them in their order, the utimes that hs-capture --rate stamps them with.
void stamp_at_rate(double rate_hz, std::vector<EvaluatedFrame>& frames);

/// Puts the results of one camera beside the truth of the same time, those of several detectors of one frame joined.
/// Throws InputError naming `source` for a result of an unknown frame, two results of one frame that share a class but
/// not what they found, and poses of no result of their frame.
void add_results(std::vector<EvaluatedFrame>& frames, const PublishedResults& published, const std::string& source);

/// Frames 0, N, 2N ...
std::vector<EvaluatedFrame> every_nth(std::vector<EvaluatedFrame> frames, int every);

/// Returns the frames as if no pose had been withheld, where that is known.
std::vector<EvaluatedFrame> with_unfiltered_poses(std::vector<EvaluatedFrame> frames);

/// Returns only the frames that have detections.
std::vector<EvaluatedFrame> processed_frames(const std::vector<EvaluatedFrame>& frames);

}  // namespace houghstream
