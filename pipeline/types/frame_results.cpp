#include "pipeline/types/frame_results.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

bool same_detection(const Detection& a, const Detection& b) {
  return a.class_id == b.class_id && a.class_name == b.class_name && a.score == b.score && a.reported == b.reported &&
         a.box_px == b.box_px && a.vote_weight == b.vote_weight && a.vote_count == b.vote_count;
}

bool same_find(const Detections& a, const Detections& b) {
  return !a.detections.empty() &&
         std::equal(a.detections.begin(), a.detections.end(), b.detections.begin(), b.detections.end(), same_detection);
}

bool same_scores(const ObjectPoses& poses, const Detections& detections) {
  return poses.poses.size() == detections.detections.size() &&
         std::all_of(poses.poses.begin(), poses.poses.end(), [&](const ObjectPose& pose) {
           return pose.detection_score == detections.detections[static_cast<std::size_t>(pose.detection_index)].score;
         });
}

/// Returns whether the result is of an hs-pose without models of these objects: on another host one may have them.
bool without_models(const ObjectPoses& poses) {
  return std::all_of(poses.poses.begin(), poses.poses.end(),
                     [](const ObjectPose& pose) { return pose.status == PoseStatus::kNoModel; });
}

/// Appends stages to those of earlier results, without the ones that all begin with.
void add_stages(std::vector<StageTime>& all, const std::vector<StageTime>& more, std::size_t common) {
  all.insert(all.end(), more.begin() + static_cast<std::ptrdiff_t>(std::min(common, more.size())), more.end());
}

std::size_t common_stages(const std::vector<StageTime>& a, const std::vector<StageTime>& b) {
  const auto same = [](const StageTime& x, const StageTime& y) {
    return x.stage == y.stage && x.duration_us == y.duration_us;
  };
  return static_cast<std::size_t>(std::mismatch(a.begin(), a.end(), b.begin(), b.end(), same).first - a.begin());
}

/// Sorts the detections, strongest first, and gives the poses the places where theirs are now.
void sort_by_score(FrameResult& all) {
  std::vector<Detection>& detections = all.detections.detections;
  std::vector<int> order(detections.size());
  std::iota(order.begin(), order.end(), 0);
  const auto at = [](int index) { return static_cast<std::size_t>(index); };
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return detections[at(a)].score > detections[at(b)].score; });
  std::vector<Detection> sorted;
  std::vector<int> place_of(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    place_of[at(order[i])] = static_cast<int>(i);
    sorted.push_back(std::move(detections[at(order[i])]));
  }
  detections = std::move(sorted);
  if (!all.poses) return;
  std::vector<ObjectPose>& poses = all.poses->poses;
  for (ObjectPose& pose : poses) pose.detection_index = place_of[at(pose.detection_index)];
  std::stable_sort(poses.begin(), poses.end(),
                   [](const ObjectPose& a, const ObjectPose& b) { return a.detection_index < b.detection_index; });
}

}  // namespace

bool is_result_of(const ObjectPoses& poses, const Detections& detections) {
  if (poses.frame != detections.frame || poses.poses.size() > detections.detections.size()) return false;
  if (poses.poses.empty() != detections.detections.empty()) return false;
  return std::all_of(poses.poses.begin(), poses.poses.end(), [&](const ObjectPose& pose) {
    const auto index = static_cast<std::size_t>(pose.detection_index);
    return pose.detection_index >= 0 && index < detections.detections.size() &&
           pose.class_name == detections.detections[index].class_name;
  });
}

bool has_followed_poses(const ObjectPoses& poses) {
  const auto is_following = [](const StageTime& stage) { return stage.stage == kFollowingStage; };
  if (poses.poses.empty()) return std::any_of(poses.stages.begin(), poses.stages.end(), is_following);
  return poses.poses.front().detection_index < 0;
}

void FrameResults::add(Detections detections) {
  const auto same = std::find_if(results_.begin(), results_.end(),
                                 [&](const FrameResult& known) { return same_find(known.detections, detections); });
  if (same != results_.end()) {
    same->detections = std::move(detections);
  } else {
    require(results_.size() < kMax, "frame {}: more than {} detections_t, expected one of each detector",
            to_string(detections.frame), kMax);
    results_.push_back({std::move(detections), std::nullopt});
  }
  unmatched_.erase(
      std::remove_if(unmatched_.begin(), unmatched_.end(), [&](ObjectPoses& poses) { return place(poses); }),
      unmatched_.end());
}

void FrameResults::add(ObjectPoses poses) {
  if (has_followed_poses(poses)) {
    followed_ = std::move(poses);
    return;
  }
  if (place(poses)) return;
  require(unmatched_.size() < kMax, "frame {}: more than {} object_poses_t of no detections", to_string(poses.frame),
          kMax);
  unmatched_.push_back(std::move(poses));
}

// Where several results match, one without poses takes precedence over one with poses, and one of equal scores over
// others.
bool FrameResults::place(ObjectPoses& poses) {
  FrameResult* best = nullptr;
  int best_rank = -1;
  for (FrameResult& result : results_) {
    if (!is_result_of(poses, result.detections)) continue;
    const int rank = (same_scores(poses, result.detections) ? 2 : 0) + (result.poses ? 0 : 1);
    if (rank > best_rank) best = &result;
    best_rank = std::max(best_rank, rank);
  }
  if (best == nullptr) return false;
  if (!best->poses || !without_models(poses)) best->poses = std::move(poses);
  return true;
}

bool FrameResults::has_all_poses() const {
  return std::all_of(results_.begin(), results_.end(),
                     [](const FrameResult& result) { return result.poses.has_value(); });
}

std::optional<FrameResult> FrameResults::merge() const {
  if (results_.empty()) return std::nullopt;
  if (results_.size() == 1) return results_.front();
  FrameResult all = results_.front();
  std::size_t common = all.detections.stages.size();
  for (const FrameResult& result : results_) {
    common = std::min(common, common_stages(results_.front().detections.stages, result.detections.stages));
  }
  for (std::size_t i = 1; i < results_.size(); ++i) {
    const int before = static_cast<int>(all.detections.detections.size());
    const Detections& more = results_[i].detections;
    all.detections.detections.insert(all.detections.detections.end(), more.detections.begin(), more.detections.end());
    add_stages(all.detections.stages, more.stages, common);
    if (!results_[i].poses) continue;
    const bool is_first = !all.poses.has_value();
    if (is_first) all.poses = ObjectPoses{more.frame, {}, {}};
    add_stages(all.poses->stages, results_[i].poses->stages, is_first ? 0 : common);
    for (ObjectPose pose : results_[i].poses->poses) {
      pose.detection_index += before;
      all.poses->poses.push_back(std::move(pose));
    }
  }
  sort_by_score(all);
  return all;
}

}  // namespace houghstream
