#include "tools/render/world/rooms/stable_poses.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"
#include "tools/render/world/objects/objects.hpp"
#include "tools/render/world/rooms/tipping.hpp"

namespace houghstream::world {
namespace {

std::size_t count(const std::vector<StablePoseFamily>& families) {
  std::size_t sum = 0;
  for (const StablePoseFamily& family : families) sum += family.size();
  return sum;
}

Eigen::Vector3d up_of(const StablePose& attitude) {
  return attitude.R_table_object.row(2);
}

// Returns the family of an attitude in which `up`, object frame, points upwards; null where there is none.
const StablePoseFamily* family_with(const std::vector<StablePoseFamily>& families, const Eigen::Vector3d& up) {
  for (const StablePoseFamily& family : families) {
    for (const StablePose& attitude : family) {
      if (up_of(attitude).dot(up) > 0.9999) return &family;
    }
  }
  return nullptr;
}

double lowest_point(const Mesh& mesh, const StablePose& attitude) {
  double lowest = 1.0;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3d point = attitude.R_table_object * vertex.cast<double>();
    lowest = std::min(lowest, point.z() + attitude.origin_height_m);
  }
  return lowest;
}

// Returns whether every line on the table through the centre of mass's foot has contact points on both sides.
bool foot_is_between_touching_points(const Mesh& mesh, const StablePose& attitude) {
  const Eigen::Vector3d foot = attitude.R_table_object * TippingBody(mesh).centre_of_mass();
  for (int degrees = 0; degrees < 360; degrees += 5) {
    const double angle = degrees * M_PI / 180.0;
    const Eigen::Vector2d beyond(std::cos(angle), std::sin(angle));
    bool held = false;
    for (const Eigen::Vector3f& vertex : mesh.vertices) {
      const Eigen::Vector3d point = attitude.R_table_object * vertex.cast<double>();
      const bool touches = point.z() + attitude.origin_height_m < 1e-4;
      held = held || (touches && beyond.dot(point.head<2>() - foot.head<2>()) > 0.0);
    }
    if (!held) return false;
  }
  return true;
}

TEST(Resting, StandOnTheTableWithTheirWeightOverWhatTouchesIt) {
  for (int id = 1; id <= kTaughtObjectCount; ++id) {
    const TaughtObject object = make_taught_object(id);
    const Mesh& mesh = object.thing->mesh;
    SCOPED_TRACE(object.name);
    for (const StablePoseFamily& family : find_stable_poses(mesh)) {
      for (const StablePose& attitude : family) {
        EXPECT_NEAR(lowest_point(mesh, attitude), 0.0, 1e-6);
        EXPECT_NEAR(attitude.R_table_object.determinant(), 1.0, 1e-9);
        EXPECT_TRUE(foot_is_between_touching_points(mesh, attitude));
      }
    }
  }
}

TEST(Resting, BoxRestsOnItsSixSides) {
  const Mesh mesh = box({0.1, 0.2, 0.3}, cv::Mat(8, 8, CV_8UC3, cv::Scalar::all(128)));
  const std::vector<StablePoseFamily> families = find_stable_poses(mesh);
  EXPECT_EQ(count(families), 6U);
  for (int axis = 0; axis < 3; ++axis) {
    const StablePoseFamily* family = family_with(families, Eigen::Vector3d::Unit(axis));
    ASSERT_NE(family, nullptr);
    EXPECT_NEAR(family->front().centre_height_m, 0.05 * (axis + 1), 1e-6);
    EXPECT_NEAR(family->front().margin_m, axis == 0 ? 0.1 : 0.05, 1e-6);
    EXPECT_NE(family_with(families, -Eigen::Vector3d::Unit(axis)), nullptr);
  }
}

TEST(Resting, CanStandsOnBothEndsAndLiesOnAllOfItsSide) {
  const std::vector<StablePoseFamily> families = find_stable_poses(make_taught_object(4).thing->mesh);
  ASSERT_EQ(families.size(), 3U);
  EXPECT_NE(family_with(families, Eigen::Vector3d::UnitZ()), nullptr);
  EXPECT_NE(family_with(families, -Eigen::Vector3d::UnitZ()), nullptr);
  EXPECT_EQ(count(families), 2U + 48U);  // its side has 48 strips
}

TEST(Resting, MugLiesOnEitherSideOfItsHandle) {
  const std::vector<StablePoseFamily> families = find_stable_poses(make_taught_object(3).thing->mesh);
  ASSERT_EQ(families.size(), 3U);
  for (const StablePoseFamily& family : families) {
    if (std::abs(up_of(family.front()).z()) > 0.9) continue;
    ASSERT_EQ(family.size(), 2U);
    EXPECT_LT(up_of(family[0]).x(), -0.3);  // its handle, to +x, points downwards
    EXPECT_NEAR(up_of(family[0]).y(), -up_of(family[1]).y(), 1e-3);
  }
}

TEST(Resting, AllTaughtObjectsHaveAnotherAttitudeThanUpright) {
  for (const int id : twenty_class_ids()) {
    const TaughtObject object = make_taught_object(id);
    EXPECT_GE(count(lying_families(find_stable_poses(object.thing->mesh))), 1U) << object.name;
  }
}

TEST(Resting, SurfacesWithoutVolumeAreRefused) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_THROW(find_stable_poses(mesh), InputError);
}

}  // namespace
}  // namespace houghstream::world
