#include "pose/seen/camera_colours.hpp"

#include <algorithm>

namespace houghstream {
namespace {

constexpr float kConfirmed = 0.8F;  // quality of a pose that is learnt from

std::vector<ChromaPair> confirmed_pairs(const ObjectPoses& poses) {
  std::vector<ChromaPair> confirmed;
  for (const ObjectPose& pose : poses.poses) {
    if (pose.status == PoseStatus::kValid && pose.quality >= kConfirmed && pose.chroma)
      confirmed.push_back(*pose.chroma);
  }
  return confirmed;
}

/// Updates an exponentially forgetting mean.
void forget_towards(const ChromaPair& fresh, ChromaPair& mean) {
  constexpr double kStep = 0.2;
  mean.model += kStep * (fresh.model - mean.model);
  mean.measured += kStep * (fresh.measured - mean.measured);
  mean.lightness += kStep * (fresh.lightness - mean.lightness);
  mean.probability += kStep * (fresh.probability - mean.probability);
}

}  // namespace

void CameraColours::update(const ObjectPoses& poses) {
  constexpr int kJumps = 2;
  const std::vector<ChromaPair> confirmed = confirmed_pairs(poses);
  if (has_jumped(confirmed)) {
    if (++jumps_ < kJumps) return;
    remembered_.clear();
  }
  jumps_ = 0;
  if (!confirmed.empty()) frame_ = poses.frame;
  for (const ChromaPair& pair : confirmed) {
    const auto [known, is_new] = remembered_.emplace(pair.class_name, pair);
    if (!is_new) forget_towards(pair, known->second);
  }
}

std::vector<ChromaPair> CameraColours::pairs() const {
  std::vector<ChromaPair> all;
  all.reserve(remembered_.size());
  for (const auto& [name, pair] : remembered_) all.push_back(pair);
  return all;
}

ChromaMap CameraColours::map_without(const std::string& class_name) const {
  return fit_chroma_map_without(class_name, pairs());
}

ChromaMap CameraColours::map() const {
  return fit_chroma_map(pairs());
}

/// Returns whether objects have other colours than before. Another side of an object has other colours too, as its
/// model shows.
bool CameraColours::has_jumped(const std::vector<ChromaPair>& confirmed) const {
  constexpr double kJump = 10.0;  // CIE a*b*
  const ChromaMap camera = map();
  std::vector<double> changes;
  for (const ChromaPair& pair : confirmed) {
    const auto known = remembered_.find(pair.class_name);
    if (known == remembered_.end()) continue;
    const ChromaPair& before = known->second;
    const Eigen::Vector2d expected =
        camera.apply(pair.model, pair.lightness) - camera.apply(before.model, before.lightness);
    changes.push_back((pair.measured - before.measured - expected).norm());
  }
  if (changes.empty()) return false;
  const auto middle = changes.begin() + static_cast<std::ptrdiff_t>(changes.size() / 2);
  std::nth_element(changes.begin(), middle, changes.end());
  return *middle > kJump;
}

}  // namespace houghstream
