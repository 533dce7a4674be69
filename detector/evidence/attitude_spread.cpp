#include "detector/evidence/attitude_spread.hpp"

#include <algorithm>
#include <cmath>

namespace houghstream {
namespace {

bool looks_upright(const TrainedView& view) {
  constexpr float kMostAside = 0.35F;     // 20 degrees of roll
  constexpr float kMostDownwards = 0.2F;  // from straight above the axis has no direction in the picture
  const Eigen::Vector3f up_ray = view.R_ray_object * Eigen::Vector3f::UnitZ();
  return std::abs(up_ray.x()) < kMostAside && up_ray.y() < kMostDownwards;
}

}  // namespace

float attitude_spread(const Forest& forest, std::uint32_t class_index) {
  constexpr float kMost = 4.0F;
  constexpr float kNearlyAll = 0.98F;  // measured turntables have an odd view
  float all = 0.0F;
  float upright = 0.0F;
  for (const TrainedView& view : forest.views) {
    if (view.class_index != class_index) continue;
    all += 1.0F;
    upright += looks_upright(view) ? 1.0F : 0.0F;
  }
  if (upright >= kNearlyAll * all) return 1.0F;
  return upright > 0.0F ? std::min(kMost, all / upright) : kMost;
}

}  // namespace houghstream
