#include "pose/tracks/extrinsic_check.hpp"

#include <algorithm>

#include "pipeline/types/frame_id.hpp"

namespace houghstream::tracks {
namespace {

constexpr std::int64_t kMaxInterval_us = 40000;  // time between compared frames, at most
constexpr double kMaxDistance_m = 0.3;           // an object that is seen farther away is another one
constexpr std::size_t kMaxOffsets = 300;
constexpr std::size_t kMinSamples = 20;
constexpr std::size_t kMaxObjects = 500;  // objects of a view: each is compared with each of another camera's

Eigen::Vector3d median_of(const std::deque<Eigen::Vector3d>& offsets) {
  Eigen::Vector3d out;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    values.reserve(offsets.size());
    for (const Eigen::Vector3d& offset : offsets) values.push_back(offset[axis]);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    out[axis] = *middle;
  }
  return out;
}

}  // namespace

void ExtrinsicCheck::add(const ObjectPoses& poses, const Eigen::Isometry3d& T_world_camera, const TrackModels& models) {
  View view{poses.frame.utime, {}};
  for (const ObjectPose& pose : poses.poses) {
    if (pose.T_camera_object && view.objects.size() < kMaxObjects)
      view.objects.push_back(
          {pose.class_name, T_world_camera * *pose.T_camera_object * centre_of(models, pose.class_name)});
  }
  for (const auto& [channel, other] : last_) {
    const std::int64_t interval_us = microseconds_between(view.utime, other.utime);
    if (channel == poses.frame.channel || interval_us > kMaxInterval_us || interval_us < -kMaxInterval_us) continue;
    const bool first = poses.frame.channel < channel;
    std::deque<Eigen::Vector3d>& offsets = offsets_[std::minmax(poses.frame.channel, channel)];
    for (const ObservedObject& object : view.objects) {
      const ObservedObject* nearest = nullptr;
      for (const ObservedObject& candidate : other.objects) {
        if (candidate.class_name != object.class_name || (candidate.centre - object.centre).norm() > kMaxDistance_m)
          continue;
        if (nearest == nullptr || (candidate.centre - object.centre).norm() < (nearest->centre - object.centre).norm())
          nearest = &candidate;
      }
      if (nearest == nullptr) continue;
      offsets.push_back(first ? Eigen::Vector3d(nearest->centre - object.centre)
                              : Eigen::Vector3d(object.centre - nearest->centre));
      if (offsets.size() > kMaxOffsets) offsets.pop_front();
    }
  }
  // Several detectors' results of one frame are one view.
  View& last = last_[poses.frame.channel];
  if (last.utime != view.utime) last = {view.utime, {}};
  const std::size_t free_count = kMaxObjects - std::min(kMaxObjects, last.objects.size());
  const auto added = static_cast<std::ptrdiff_t>(std::min(free_count, view.objects.size()));
  last.objects.insert(last.objects.end(), view.objects.begin(), view.objects.begin() + added);
}

std::vector<ExtrinsicInconsistency> ExtrinsicCheck::pairs() const {
  std::vector<ExtrinsicInconsistency> out;
  for (const auto& [cameras, offsets] : offsets_) {
    if (offsets.size() < kMinSamples) continue;
    out.push_back({cameras.first, cameras.second, median_of(offsets), static_cast<int>(offsets.size())});
  }
  return out;
}

std::vector<ExtrinsicInconsistency> ExtrinsicCheck::inconsistencies() const {
  std::vector<ExtrinsicInconsistency> out = pairs();
  out.erase(std::remove_if(out.begin(), out.end(),
                           [](const ExtrinsicInconsistency& c) { return c.offset_m.norm() < kReport_m; }),
            out.end());
  return out;
}

}  // namespace houghstream::tracks
