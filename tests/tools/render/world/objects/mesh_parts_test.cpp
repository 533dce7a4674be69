#include "tools/render/world/objects/mesh_parts.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/tools/render/world/closed_surface.hpp"

namespace houghstream::world {
namespace {

const cv::Mat kTexture(16, 16, CV_8UC3, cv::Scalar(10, 20, 30));

void expect_sound(const Mesh& mesh) {
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_GT(signed_volume(mesh), 0.0);
  EXPECT_EQ(agreeing_normals(mesh), 1.0);
}

TEST(MeshParts, BoxIsClosedAndOfTheRightSize) {
  const Mesh mesh = box({0.1, 0.2, 0.3}, kTexture);
  expect_sound(mesh);
  EXPECT_NEAR(signed_volume(mesh), 0.1 * 0.2 * 0.3, 1e-8);
}

TEST(MeshParts, LatheOfACylinderHasItsVolume) {
  const Mesh mesh =
      lathe(with_arc_length({{0, 0}, {0.1, 0}, {0.1, 0}, {0.1, 0.3}, {0.1, 0.3}, {0, 0.3}}), kTexture, 96);
  expect_sound(mesh);
  EXPECT_NEAR(signed_volume(mesh), M_PI * 0.01 * 0.3, 1e-4 * 0.3);
}

TEST(MeshParts, TubeIsClosed) {
  expect_sound(tube({{0, 0, 0}, {0.1, 0, 0}, {0.15, 0, 0.1}}, 0.01, kTexture));
  EXPECT_THROW(tube({{0, 0, 0}}, 0.01, kTexture), InputError);
}

TEST(MeshParts, AtlasKeepsEachPartsTexture) {
  const cv::Mat other(8, 40, CV_8UC3, cv::Scalar(200, 100, 50));
  const Mesh mesh =
      finish_object(compose({at(box({1, 1, 1}, kTexture), {0, 0, 0}), at(box({1, 1, 1}, other), {2, 0, 0})}));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    EXPECT_EQ(mesh.colours[i], mesh.vertices[i].x() < 0 ? cv::Vec3b(10, 20, 30) : cv::Vec3b(200, 100, 50));
  EXPECT_LT(mesh_bounds(mesh).center().norm(), 1e-6F);
}

TEST(MeshParts, PrismIsClosedWithTheVolumeOfItsOutline) {
  const Mesh roof = prism({{-0.1, 0.0}, {0.1, 0.0}, {0.0, 0.05}}, 0.3, kTexture, kTexture);
  expect_sound(roof);
  EXPECT_NEAR(signed_volume(roof), 0.5 * 0.2 * 0.05 * 0.3, 1e-7);
  EXPECT_THROW(prism({{0, 0}, {1, 0}}, 0.3, kTexture, kTexture), InputError);
}

TEST(MeshParts, StretchingKeepsTheSurfaceClosedAndItsNormalsUpright) {
  const Mesh cube = scaled(box({0.1, 0.1, 0.1}, kTexture), {1.0, 0.5, 2.0});
  expect_sound(cube);
  EXPECT_NEAR(signed_volume(cube), 0.001, 1e-8);
}

TEST(MeshParts, TaperedTubeIsAClosedCone) {
  const Mesh cone = tapered_tube({{0, 0, 0}, {0, 0, 0.1}}, {0.03, 0.01}, kTexture, 96);
  expect_sound(cone);
  EXPECT_NEAR(signed_volume(cone), M_PI * 0.1 * (0.03 * 0.03 + 0.03 * 0.01 + 0.01 * 0.01) / 3.0, 2e-6);
  EXPECT_THROW(tapered_tube({{0, 0, 0}, {0, 0, 0.1}}, {0.03}, kTexture), InputError);
}

}  // namespace
}  // namespace houghstream::world
