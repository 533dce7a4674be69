#include "tools/render/world/objects/shape_variants.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tools/render/world/objects/objects.hpp"

namespace houghstream::world {
namespace {

constexpr int kSeeds = 40;

/// Returns the mean square distance of the vertices, after the best scale about the middle of the first mesh, metres^2.
double bent_by_m2(const Mesh& a, const Mesh& b) {
  const Eigen::Vector3f middle = mesh_bounds(a).center();
  double along = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    const Eigen::Vector3f from = a.vertices[i] - middle;
    along += static_cast<double>(from.dot(b.vertices[i] - middle));
    square += static_cast<double>(from.squaredNorm());
  }
  const auto scale = static_cast<float>(along / square);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    sum += static_cast<double>((b.vertices[i] - middle - scale * (a.vertices[i] - middle)).squaredNorm());
  }
  return sum / static_cast<double>(a.vertices.size());
}

TEST(NearlyAlike, TheNextOfItsKindIsAFewMillimetresOff) {
  const TaughtObject box = make_taught_object(2);
  double max_m = 0.0;
  double sum_m = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const AssetPtr next = make_instance_variant(*box.thing, random);
    ASSERT_EQ(next->mesh.vertices.size(), box.thing->mesh.vertices.size());
    EXPECT_EQ(next->mesh.triangles.size(), box.thing->mesh.triangles.size());
    const double bent_m = std::sqrt(bent_by_m2(box.thing->mesh, next->mesh));
    max_m = std::max(max_m, bent_m);
    sum_m += bent_m;
    const Eigen::Vector3f sizes = mesh_bounds(next->mesh).sizes().cwiseQuotient(mesh_bounds(box.thing->mesh).sizes());
    EXPECT_GT(sizes.minCoeff(), 0.8F) << seed;
    EXPECT_LT(sizes.maxCoeff(), 1.2F) << seed;
  }
  EXPECT_LT(max_m, 0.0045) << "3 mm, and what chance adds";
  EXPECT_GT(sum_m / kSeeds, 0.0007);
}

TEST(NearlyAlike, TheSameSeedGivesTheSameShapeAndTheColoursStay) {
  const TaughtObject box = make_taught_object(2);
  Random a(7);
  Random b(7);
  Random other(8);
  const AssetPtr first = make_instance_variant(*box.thing, a);
  EXPECT_EQ(first->mesh.vertices, make_instance_variant(*box.thing, b)->mesh.vertices);
  EXPECT_NE(first->mesh.vertices, make_instance_variant(*box.thing, other)->mesh.vertices);
  EXPECT_EQ(first->mesh.colours, box.thing->mesh.colours);
  EXPECT_EQ(first->mesh.uvs, box.thing->mesh.uvs);
  EXPECT_EQ(first->mip_levels.size(), box.thing->mip_levels.size());
}

TEST(NearlyAlike, ALookAlikeDiffersInSizeOrColours) {
  const TaughtObject box = make_taught_object(2);
  for (int seed = 0; seed < kSeeds; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const AssetPtr other = make_hard_negative(*box.thing, random);
    const Eigen::Vector3f sizes = mesh_bounds(other->mesh).sizes().cwiseQuotient(mesh_bounds(box.thing->mesh).sizes());
    const bool other_size = (sizes - Eigen::Vector3f::Ones()).cwiseAbs().maxCoeff() > 0.05F;
    const bool other_colours =
        other->mesh.colours != box.thing->mesh.colours ||
        (!other->mesh.texture.empty() && cv::norm(other->mesh.texture, box.thing->mesh.texture, cv::NORM_L1) > 0.0);
    EXPECT_TRUE(other_size || other_colours) << seed;
  }
}

}  // namespace
}  // namespace houghstream::world
