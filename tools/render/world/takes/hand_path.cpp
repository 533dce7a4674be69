#include "tools/render/world/takes/hand_path.hpp"

#include <algorithm>
#include <cmath>

#include "tools/render/world/objects/pixel_noise.hpp"
#include "tools/render/world/objects/world.hpp"

namespace houghstream::world {
namespace {

constexpr double kStepsPerSecond = 240.0;
constexpr double kGentleSeconds = 0.8;  // duration of a movement's start and end

std::vector<Wander> three(double slowest_hz, double fastest_hz, double deviation, Random& random) {
  std::vector<Wander> axes;
  axes.reserve(3);
  for (int axis = 0; axis < 3; ++axis) axes.emplace_back(slowest_hz, fastest_hz, deviation, random);
  return axes;
}

Eigen::Vector3d along(const std::vector<Wander>& axes, double seconds) {
  return {axes[0].at(seconds), axes[1].at(seconds), axes[2].at(seconds)};
}

}  // namespace

UnevenProgress::UnevenProgress(double seconds, std::uint64_t seed) : seconds_(seconds) {
  Random random(seed);
  const Wander speed(0.1, 0.6, 0.45, random);
  const int steps = std::max(2, static_cast<int>(seconds * kStepsPerSecond));
  done_.push_back(0.0);
  for (int i = 0; i < steps; ++i) {
    const double now = seconds * (i + 0.5) / steps;
    const double gentle = std::clamp(std::min(now, seconds - now) / std::min(kGentleSeconds, 0.3 * seconds), 0.0, 1.0);
    const double eased = gentle * gentle * (3.0 - 2.0 * gentle);
    done_.push_back(done_.back() + eased * std::clamp(1.0 + speed.at(now), 0.15, 2.2));
  }
  for (double& done : done_) done /= done_.back();
}

double UnevenProgress::at(double seconds) const {
  const double step = std::clamp(seconds / seconds_, 0.0, 1.0) * static_cast<double>(done_.size() - 1);
  const std::size_t before = std::min(static_cast<std::size_t>(step), done_.size() - 2);
  const double fraction = step - static_cast<double>(before);
  return (1.0 - fraction) * done_[before] + fraction * done_[before + 1];
}

HandPath::HandPath(const HandPathSettings& settings, std::uint64_t seed) : HandPath(settings, seed, Random(seed)) {}

HandPath::HandPath(const HandPathSettings& settings, std::uint64_t seed, Random random)
    : settings_(settings),
      progress_(settings.seconds, seed + 2),
      start_rad_(random.uniform(-0.6, 0.6)),
      direction_(chance(random, 0.5) ? 1.0 : -1.0),
      elevation_rad_(random.uniform(0.58, 0.7)),
      elevation_swing_rad_(random.uniform(0.18, 0.28)),
      swing_phase_rad_(random.uniform(0.0, 2.0 * M_PI)),
      elevation_drift_(0.05, 0.4, 0.05, random),
      distance_drift_(0.08, 0.4, 0.07, random),
      roll_(0.1, 0.7, 0.04, random),
      aim_(three(0.1, 0.8, 0.012, random)),
      shift_(three(1.0, 4.0, 0.002, random)),
      tremble_(three(2.0, 9.0, 0.0022, random)) {}

Eigen::Isometry3d HandPath::T_camera_world(double seconds) const {
  const double rotated = settings_.angle_rad * progress_.at(seconds);
  const double azimuth = start_rad_ + direction_ * rotated;
  // Twice up and down a turn: the end comes back to the start's height.
  const double elevation =
      elevation_rad_ + elevation_swing_rad_ * std::sin(2.0 * rotated + swing_phase_rad_) + elevation_drift_.at(seconds);
  const double distance = settings_.distance_m * (1.0 + distance_drift_.at(seconds));
  const Eigen::Vector3d from_target(std::sin(azimuth) * std::cos(elevation), -std::cos(azimuth) * std::cos(elevation),
                                    std::sin(elevation));
  const Eigen::Vector3d eye = settings_.target_world + distance * from_target + along(shift_, seconds);
  const Eigen::Vector3d tremble = along(tremble_, seconds) + roll_.at(seconds) * Eigen::Vector3d::UnitZ();
  Eigen::Isometry3d T_rotated_camera = Eigen::Isometry3d::Identity();
  if (tremble.norm() > 0.0) T_rotated_camera.rotate(Eigen::AngleAxisd(tremble.norm(), tremble.normalized()));
  return T_rotated_camera * look_at(eye, settings_.target_world + along(aim_, seconds));
}

}  // namespace houghstream::world
