#include "tools/render/world/optics/shadow_map.hpp"

#include <array>
#include <cmath>

#include "pipeline/geometry/renderer.hpp"

namespace houghstream::world {
namespace {

constexpr double kMapPxPerM = 430.0;  // of the part of the world that the map shows
constexpr float kBiasM = 0.006F;
constexpr int kTaps = 8;
constexpr int kTurns = 64;

using Taps = std::array<std::array<Eigen::Vector2f, kTaps>, kTurns>;

// Vogel's spiral in the unit disc, from the rim inwards, for each turn of the pattern.
Taps make_taps() {
  Taps taps;
  for (int turn = 0; turn < kTurns; ++turn) {
    for (int i = 0; i < kTaps; ++i) {
      const double radius = std::sqrt((kTaps - i - 0.5) / kTaps);
      const double angle = 2.399963 * i + 2.0 * M_PI * turn / kTurns;  // golden angle
      taps[static_cast<std::size_t>(turn)][static_cast<std::size_t>(i)] =
          Eigen::Vector2d(radius * std::cos(angle), radius * std::sin(angle)).cast<float>();
    }
  }
  return taps;
}

}  // namespace

ShadowMap make_shadow_map(const World& world, const Light& light) {
  ShadowMap map;
  if (!light.casts_shadow) return map;
  const double distance = light.position_world.norm();
  const int size = static_cast<int>(std::lround(2.0 * world.focus_radius_m * kMapPxPerM));
  const double focal = 0.5 * size * distance / world.focus_radius_m;
  const double centre = 0.5 * (size - 1);
  map.camera = Camera{size, size, focal, focal, centre, centre};
  map.T_light_world = look_at(light.position_world, Eigen::Vector3d::Zero());
  map.inverse_depth = cv::Mat::zeros(size, size, CV_32FC1);
  std::vector<RenderItem> items;
  for (const Placed& placed : world.items) {
    if (placed.casts_shadow) items.push_back({&placed.thing->mesh, map.T_light_world * placed.T_world_object, 1});
  }
  const cv::Mat depth = render_depth(items, map.camera, {0, 0, size, size});
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      const float z = depth.at<float>(y, x);
      map.inverse_depth.at<float>(y, x) = std::isnan(z) ? 0.0F : 1.0F / z;
    }
  }
  return map;
}

ShadowLookup::ShadowLookup(const ShadowMap& map, const Eigen::Isometry3d& T_world_camera, double penumbra_m)
    : map_(map),
      T_light_camera_((map.T_light_world * T_world_camera).cast<float>()),
      penumbra_m_(static_cast<float>(penumbra_m)) {}

float ShadowLookup::lit(const Eigen::Vector3f& point_camera, float turn) const {
  static const Taps kPatterns = make_taps();
  if (map_.camera.width == 0) return 1.0F;
  const Eigen::Vector3f point = T_light_camera_ * point_camera;
  if (point.z() <= 0.1F) return 1.0F;
  const auto focal = static_cast<float>(map_.camera.fx);
  const auto centre = static_cast<float>(map_.camera.cx);
  // Half a pixel and the first pixel's row of safety are added, so that cutting off rounds.
  const float u = focal * point.x() / point.z() + centre + 1.5F;
  const float v = focal * point.y() / point.z() + centre + 1.5F;
  const float radius = penumbra_m_ * focal / point.z();
  const auto last = static_cast<float>(map_.camera.width + 1) - radius;
  if (!(u > 1.0F + radius && v > 1.0F + radius && u < last && v < last)) return 1.0F;
  const float limit = 1.0F / (point.z() - kBiasM - 0.25F * penumbra_m_);
  const auto& taps = kPatterns[static_cast<std::size_t>(turn * kTurns) % kTurns];
  int lit = 0;
  for (int i = 0; i < kTaps; ++i) {
    // Where the outer half agrees, the inner one will not differ.
    if (i == kTaps / 2 && (lit == 0 || lit == i)) return lit == 0 ? 0.0F : 1.0F;
    const Eigen::Vector2f& tap = taps[static_cast<std::size_t>(i)];
    const int x = static_cast<int>(u + radius * tap.x()) - 1;
    const int y = static_cast<int>(v + radius * tap.y()) - 1;
    if (map_.inverse_depth.at<float>(y, x) <= limit) ++lit;
  }
  return static_cast<float>(lit) / kTaps;
}

}  // namespace houghstream::world
