#include "pose/model/object_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/base/checks.hpp"
#include "tests/expect_says.hpp"
#include "tests/pose/test_scene.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

TEST(ObjectModel, DirectionsCoverTheSphereEvenly) {
  const std::vector<Eigen::Vector3f> directions = sphere_directions(4);
  ASSERT_EQ(directions.size(), 162U);
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3f any =
        Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized().cast<float>();
    float nearest = -1.0F;
    for (const Eigen::Vector3f& direction : directions) nearest = std::max(nearest, direction.dot(any));
    EXPECT_GT(nearest, std::cos(0.2F));  // 11.5 degrees
  }
}

TEST(ObjectModel, BoundsAreThoseOfTheMesh) {
  const ObjectModel model = make_object_model("box", cereal_box(), ModelSettings());
  EXPECT_NEAR(model.centre.norm(), 0.0F, 1e-6F);
  EXPECT_NEAR(model.radius, std::sqrt(0.09F * 0.09F + 0.03F * 0.03F + 0.13F * 0.13F), 1e-5F);
  EXPECT_EQ(model.views.size(), 162U);
}

TEST(ObjectModel, ShapeSymmetriesAreFoundInTheMeshOrThoseThatAreGiven) {
  ModelSettings settings;
  EXPECT_EQ(make_object_model("box", cereal_box(), settings).shape_symmetries.discrete.size(), 3U);
  const ObjectModel of_mug = make_object_model("mug", mug(), settings);
  EXPECT_TRUE(of_mug.shape_symmetries.empty());
  ASSERT_TRUE(of_mug.nearly_round.has_value());
  EXPECT_GT(std::abs(of_mug.nearly_round->axis.z()), 0.9994);
  settings.shape_symmetries["box"].nearly_round = ContinuousSymmetry{Eigen::Vector3d::UnitX(), {0.0, 0.1, 0.0}};
  const ObjectModel given = make_object_model("box", cereal_box(), settings);
  EXPECT_TRUE(given.shape_symmetries.empty());
  ASSERT_TRUE(given.nearly_round.has_value());
  EXPECT_EQ(given.nearly_round->offset.y(), 0.1);
}

TEST(ObjectModel, ViewsHoldPointsOfTheNearSideOnly) {
  const ObjectModel model = make_object_model("box", cereal_box(), ModelSettings());
  for (const ModelView& view : model.views) {
    ASSERT_GT(view.points.size(), 100U);
    ASSERT_LE(view.points.size(), 600U);
    ASSERT_EQ(view.points.size(), view.normals.size());
    EXPECT_GT(view.area, 0.0F);
    EXPECT_LE(view.area, 1.0F);
    for (std::size_t i = 0; i < view.points.size(); ++i) {
      const Eigen::Vector3f& p = view.points[i];
      const float off_surface = std::min(
          {std::abs(std::abs(p.x()) - 0.09F), std::abs(std::abs(p.y()) - 0.03F), std::abs(std::abs(p.z()) - 0.13F)});
      ASSERT_LT(off_surface, 1e-5F);
      ASSERT_GT(view.normals[i].dot(1.2F * view.direction - p), 0.0F);
    }
  }
}

TEST(ObjectModel, InsideOfAMugIsSeenFromAboveAndNotFromBelow) {
  const ObjectModel model = make_object_model("mug", mug(), ModelSettings());
  const auto points_inside = [&](const ModelView& view) {
    int inside = 0;
    for (const Eigen::Vector3f& p : view.points) inside += p.head<2>().norm() < 0.03F && p.z() > -0.049F ? 1 : 0;
    return inside;
  };
  int above = 0;
  int below = 0;
  for (const ModelView& view : model.views) {
    if (view.direction.z() > 0.8F) above += points_inside(view);
    if (view.direction.z() < -0.8F) below += points_inside(view);
  }
  EXPECT_GT(above, 500);
  EXPECT_EQ(below, 0);
}

TEST(ObjectModel, NearestViewLooksFromTheCamera) {
  const ObjectModel model = make_object_model("box", cereal_box(), ModelSettings());
  const Eigen::Isometry3d T_camera_object = standing(77.0, 35.0, 1.3);
  const Eigen::Vector3d eye = T_camera_object.inverse().translation();
  EXPECT_GT(nearest_view(model, T_camera_object).direction.dot(eye.normalized().cast<float>()), std::cos(0.2F));
}

/// Returns a mesh without thickness, which is invisible from its edge.
Mesh sheet() {
  Mesh mesh;
  mesh.vertices = {{-0.1F, -0.1F, 0.0F}, {0.1F, -0.1F, 0.0F}, {0.1F, 0.1F, 0.0F}, {-0.1F, 0.1F, 0.0F}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TEST(ObjectModel, IsTheSameForAnyNumberOfThreads) {
  for (const Mesh& mesh : {mug(), sheet()}) {
    const ObjectModel one = make_object_model("any", mesh, ModelSettings(), 1);
    const ObjectModel many = make_object_model("any", mesh, ModelSettings(), 3);
    EXPECT_LE(one.views.size(), 162U);
    ASSERT_EQ(one.views.size(), many.views.size());
    for (std::size_t v = 0; v < one.views.size(); ++v) {
      ASSERT_EQ(one.views[v].direction, many.views[v].direction);
      ASSERT_EQ(one.views[v].points, many.views[v].points);
      ASSERT_EQ(one.views[v].normals, many.views[v].normals);
      ASSERT_EQ(one.views[v].area, many.views[v].area);
    }
  }
  EXPECT_LT(make_object_model("sheet", sheet(), ModelSettings()).views.size(), 162U);
}

TEST(ObjectModel, TurnedTrianglesGiveTheSameNormals) {
  Mesh rotated = cereal_box();
  for (auto& triangle : rotated.triangles) std::swap(triangle[1], triangle[2]);
  const ObjectModel a = make_object_model("box", cereal_box(), ModelSettings());
  const ObjectModel b = make_object_model("box", rotated, ModelSettings());
  EXPECT_NEAR((a.views[7].normals[3] - b.views[7].normals[3]).norm(), 0.0F, 1e-5F);
}

TEST(ObjectModel, MeshesThatCannotBeModelsAreRefusedByName) {
  Mesh point;
  point.vertices = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  point.triangles = {{0, 1, 2}};
  Mesh millimetres = cereal_box();
  for (Eigen::Vector3f& v : millimetres.vertices) v *= 1000.0F;
  for (const Mesh& mesh : {Mesh(), point, millimetres}) {
    expect_says(error_of([&] { make_object_model("teapot", mesh, ModelSettings()); }), {"teapot"});
  }
}

}  // namespace
}  // namespace houghstream
