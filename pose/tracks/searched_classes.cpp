#include "pose/tracks/searched_classes.hpp"

#include <algorithm>
#include <iterator>

#include "pipeline/types/frame_id.hpp"

namespace houghstream::tracks {
namespace {

std::set<std::string> reported_classes(const ObjectPoses& poses) {
  std::set<std::string> names;
  for (const ObjectPose& pose : poses.poses) {
    if (pose.status != PoseStatus::kNoModel) names.insert(pose.class_name);
  }
  return names;
}

bool have_common(const std::set<std::string>& a, const std::set<std::string>& b) {
  return std::any_of(a.begin(), a.end(), [&](const std::string& name) { return b.count(name) > 0; });
}

}  // namespace

void SearchedClasses::note(const ObjectPoses& poses) {
  constexpr std::size_t kMax = 500;  // classes of one detector
  const std::set<std::string> names = reported_classes(poses);
  Camera& camera = cameras_[poses.frame.channel];
  if (camera.utime != poses.frame.utime) camera.classes.clear();
  camera.utime = poses.frame.utime;
  if (!names.empty() && !camera.classes.empty() && !have_common(names, camera.classes)) camera.has_several = true;
  camera.classes.insert(names.begin(), names.end());
  for (const std::string& name : names) {
    Coverage& company = companies_[name];
    if (company.classes.size() < kMax) company.classes.insert(names.begin(), names.end());
    company.utime = std::max(company.utime, poses.frame.utime);
  }
}

bool SearchedClasses::has_searched(const ObjectPoses& poses, const std::string& class_name) const {
  const auto camera = cameras_.find(poses.frame.channel);
  if (camera == cameras_.end() || !camera->second.has_several) return true;
  const auto company = companies_.find(class_name);
  if (company == companies_.end()) return true;
  return have_common(reported_classes(poses), company->second.classes) || !is_reporting(class_name, poses.frame.utime);
}

/// Whether its detector has told of anything within the last second.
bool SearchedClasses::is_reporting(const std::string& class_name, std::int64_t utime) const {
  constexpr double kSilentS = 1.0;
  const std::set<std::string>& together = companies_.at(class_name).classes;
  return std::any_of(together.begin(), together.end(), [&](const std::string& name) {
    const auto told = companies_.find(name);
    return told != companies_.end() && seconds_between(told->second.utime, utime) <= kSilentS;
  });
}

void SearchedClasses::keep_only(const std::set<std::string>& classes) {
  for (auto it = companies_.begin(); it != companies_.end();)
    it = classes.count(it->first) > 0 ? std::next(it) : companies_.erase(it);
}

}  // namespace houghstream::tracks
