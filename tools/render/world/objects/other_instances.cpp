#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"
#include "tools/render/world/objects/objects.hpp"
#include "tools/render/world/objects/pixel_noise.hpp"
#include "tools/render/world/objects/taught_colours.hpp"
#include "tools/render/world/objects/vessels.hpp"

namespace houghstream::world {
namespace {

// Varies either the size or the colour of the taught object, never neither, so that a person can tell them apart.
struct InstanceVariation {
  double size = 1.0;  // factor
  Palette palette;
};

cv::Scalar far_colour(const Hsv& colour, Random& random) {
  return hsv(colour.hue_deg + random.uniform(60, 300), random.uniform(0.25, 0.8), random.uniform(0.3, 0.9));
}

InstanceVariation draw_variation(int kind, Random& random) {
  const ClassColours& taught = class_colours(kind + 1);
  InstanceVariation variation{random.uniform(0.88, 1.12), random_palette(random)};
  if (chance(random, 0.5)) {
    const bool smaller = chance(random, 0.5) || kind == 1;  // no carton of half a metre
    variation.size = smaller ? random.uniform(0.55, 0.74) : random.uniform(1.35, 1.65);
    variation.palette.base = near_colour(taught.base, random);
    variation.palette.accent = near_colour(taught.accent, random);
  } else {
    variation.palette.base = far_colour(taught.base, random);
    variation.palette.accent = far_colour(taught.accent, random);
  }
  return variation;
}

Mesh other_bowl(const InstanceVariation& variation, double slimness, Random& random) {
  const double s = variation.size;
  const BowlShape shape{0.074 * s, 0.036 * s, 0.066 * s * slimness, 0.004};
  return bowl_mesh(shape, plain({256, 256}, variation.palette.base, 0.03, random));
}

Mesh other_mug(const InstanceVariation& variation, double slimness, Random& random) {
  const double radius = 0.0405 * variation.size;
  const MugShape shape{radius, random.uniform(0.85, 1.0) * radius, 0.094 * variation.size * slimness, 0.0038};
  return mug_mesh(shape, variation.palette, random);
}

}  // namespace

AssetPtr make_other_instance(int class_id, std::uint64_t seed) {
  require(class_id >= 1 && class_id <= kClassCount, "other instance: class {}, expected 1 to {}", class_id,
          kClassCount);
  Random random(seed);
  const InstanceVariation variation = draw_variation(class_id - 1, random);
  const double slimness = random.uniform(0.9, 1.12);
  const double s = variation.size;
  switch (class_id) {
    case 1: return make_asset("other_bowl", other_bowl(variation, slimness, random), 0.25F);
    case 2: {
      const Eigen::Vector3d size = s * Eigen::Vector3d(0.192, 0.058, 0.285 * slimness);
      return make_asset("other_carton", carton_mesh(size, variation.palette, random), 0.12F);
    }
    case 3: return make_asset("other_mug", other_mug(variation, slimness, random), 0.3F);
    default: {
      const double radius = 0.033 * s;
      return make_asset("other_can", can_mesh(radius, 0.122 * s * slimness, variation.palette, random), 0.45F);
    }
  }
}

}  // namespace houghstream::world
