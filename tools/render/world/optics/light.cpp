#include "tools/render/world/optics/light.hpp"

#include <cmath>

#include "pipeline/base/random.hpp"
#include "tools/render/world/objects/pixel_noise.hpp"

namespace houghstream::world {
namespace {

Eigen::Vector3f light_colour(double warmth, double strength) {
  // Warm lamps lack blue, cool daylight lacks red.
  return (Eigen::Vector3d(1.0 - 0.45 * warmth, 1.0 - 0.12 * std::abs(warmth), 1.0 + 0.3 * warmth) * strength)
      .cast<float>();
}

// Lamps are warm and weak: a camera's gain makes up for part of it and adds noise.
void turn_to_evening(World& world, Random& random) {
  for (Light& light : world.lights) light.colour_bgr.array() *= light_colour(random.uniform(0.4, 0.8), 1.0).array();
  world.ambient_bgr *= 0.5F;
  world.photo.mean_level *= 0.5;
  world.photo.shot_noise *= 2.0;
  world.photo.read_noise *= 2.0;
  world.photo.blur_px = 1.1;
}

}  // namespace

void set_lighting(World& world, TimeOfDay time, std::uint64_t seed) {
  Random random(seed);
  const double warmth = random.uniform(-0.5, 0.9);
  const double azimuth = random.uniform(-0.9 * M_PI, 0.5 * M_PI);
  const double elevation = random.uniform(0.6, 1.25);
  Light key;
  key.position_world =
      random.uniform(2.0, 3.2) * Eigen::Vector3d(std::cos(azimuth) * std::cos(elevation),
                                                 std::sin(azimuth) * std::cos(elevation), std::sin(elevation));
  key.colour_bgr = light_colour(warmth, random.uniform(0.5, 1.3));
  key.penumbra_m = random.uniform(0.004, 0.05);
  key.casts_shadow = !chance(random, 0.12);
  Light overhead;
  overhead.position_world = {random.uniform(-0.3, 0.3), random.uniform(-0.5, 0.1), 2.2};
  overhead.colour_bgr = light_colour(random.uniform(-0.4, 0.6), random.uniform(0.15, 0.5));
  overhead.penumbra_m = random.uniform(0.08, 0.16);
  world.lights = {key, overhead};
  world.ambient_bgr = light_colour(random.uniform(-0.4, 0.5), random.uniform(0.12, 0.32));

  world.photo.mean_level = random.uniform(0.16, 0.28);
  world.photo.exposure_bias = random.uniform(0.75, 1.3);
  world.photo.blur_px = random.uniform(0.5, 0.9);
  world.photo.shot_noise = random.uniform(0.006, 0.018);
  world.photo.read_noise = random.uniform(0.001, 0.004);
  world.photo.vignetting = random.uniform(0.0, 0.3);
  world.photo.white_balance_bgr = light_colour(-warmth * random.uniform(0.2, 0.8), 1.0);
  if (time == TimeOfDay::kEvening) turn_to_evening(world, random);
}

}  // namespace houghstream::world
