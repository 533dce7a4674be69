#include "pose/model/surface_texture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace houghstream {
namespace {

Eigen::Vector3i cube_of(const Eigen::Vector3f& point, float detail_m) {
  return (point / detail_m).array().floor().cast<int>();
}

std::int64_t number_of(const Eigen::Vector3i& cube) {
  constexpr std::int64_t kHalf = 1 << 20;  // cubes to each side of the origin
  const auto part = [](int index) { return std::clamp<std::int64_t>(index + kHalf, 0, 2 * kHalf - 1); };
  return (part(cube.x()) * 2 * kHalf + part(cube.y())) * 2 * kHalf + part(cube.z());
}

/// Returns the offsets of the cube itself, which is first, and of those that share a face with it.
const std::array<Eigen::Vector3i, 7>& neighbours() {
  static const std::array<Eigen::Vector3i, 7> offsets = {
      Eigen::Vector3i(0, 0, 0),  Eigen::Vector3i(1, 0, 0), Eigen::Vector3i(-1, 0, 0), Eigen::Vector3i(0, 1, 0),
      Eigen::Vector3i(0, -1, 0), Eigen::Vector3i(0, 0, 1), Eigen::Vector3i(0, 0, -1)};
  return offsets;
}

int direction_of(const Eigen::Vector3f& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return 2 * static_cast<int>(axis) + (normal[axis] < 0.0F ? 1 : 0);
}

}  // namespace

std::optional<Eigen::Vector3f> SurfaceTexture::find(const Eigen::Vector3f& point,
                                                    const Eigen::Vector3f& towards) const {
  const Eigen::Vector3i cube = cube_of(point, detail_m);
  for (const Eigen::Vector3i& offset : neighbours()) {
    const std::int64_t number = number_of(cube + offset);
    std::optional<std::size_t> best;
    float best_facing = 0.0F;
    for (auto side = std::lower_bound(cubes.begin(), cubes.end(), number); side != cubes.end() && *side == number;
         ++side) {
      const auto index = static_cast<std::size_t>(side - cubes.begin());
      const float facing = normals[index].dot(towards);
      if (!(facing > best_facing)) continue;
      best = index;
      best_facing = facing;
    }
    if (best) return colours[*best];
  }
  return std::nullopt;
}

void SurfaceTextureBuilder::add(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, const LabColour& colour) {
  Sum& sum = sums_[{number_of(cube_of(point, detail_m_)), direction_of(normal)}];
  sum.normal += normal;
  sum.colour += Eigen::Vector3f(colour[0], colour[1], colour[2]);
  sum.count += 1.0F;
}

SurfaceTexture SurfaceTextureBuilder::make() const {
  SurfaceTexture texture;
  texture.detail_m = detail_m_;
  for (const auto& [place, sum] : sums_) {
    texture.cubes.push_back(place.first);
    texture.normals.emplace_back(sum.normal / sum.count);
    texture.colours.emplace_back(sum.colour / sum.count);
  }
  return texture;
}

}  // namespace houghstream
