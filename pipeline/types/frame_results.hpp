#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "pipeline/types/detection.hpp"
#include "pipeline/types/object_pose.hpp"

namespace houghstream {

/// Name of the stage that follows objects from frame to frame: poses with its time belong to no detections.
inline constexpr const char* kFollowingStage = "pose.following";

/// Detections of one detector in a frame, and the poses that were computed from them.
struct FrameResult {
  Detections detections;
  std::optional<ObjectPoses> poses;
};

/// Returns whether the poses belong to these detections: they are of the same frame, name their classes and positions,
/// and exist where there are detections. The messages do not name their detector.
bool is_result_of(const ObjectPoses& poses, const Detections& detections);

/// Returns whether these are poses of objects that hs-pose follows from frame to frame, which belong to no detections.
bool has_followed_poses(const ObjectPoses& poses);

/// Results that were published for one frame. Several detectors may process a camera's frames, each with a forest of
/// different objects: each result is kept separately, with its poses. Results and poses may arrive in any order.
class FrameResults {
 public:
  /// Maximum number of results of one frame, and of unmatched poses, that are kept: there are never so many detectors,
  /// and each new one is compared with all.
  static constexpr std::size_t kMax = 64;

  /// Adds a result. One that finds exactly the same objects as an earlier one replaces it, since it comes from a log
  /// that is played again. Throws InputError for one too many.
  void add(Detections detections);
  void add(ObjectPoses poses);

  const std::vector<FrameResult>& results() const { return results_; }
  /// Returns whether each result has its poses.
  bool has_all_poses() const;
  /// The poses of the objects that are followed, where hs-pose follows any.
  const std::optional<ObjectPoses>& followed() const { return followed_; }
  /// Returns other poses, which belong to no result that has come so far.
  const std::vector<ObjectPoses>& unmatched() const { return unmatched_; }

  /// Returns all results as one, strongest detections first, and the poses that have come with indices to match. A
  /// stage of several results is listed for each of them, but the common first stages, which are the frame's own, once.
  /// Returns nothing where there are no detections, and no poses where none of the results has any.
  std::optional<FrameResult> merge() const;

 private:
  bool place(ObjectPoses& poses);

  std::vector<FrameResult> results_;
  std::optional<ObjectPoses> followed_;
  std::vector<ObjectPoses> unmatched_;
};

}  // namespace houghstream
