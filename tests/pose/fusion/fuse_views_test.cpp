#include "pose/fusion/fuse_views.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/pose/fusion/turntable_views.hpp"
#include "tests/test_files.hpp"

namespace houghstream::fusion {
namespace {

using test_scene::median;
using test_scene::TurntableScene;

const Eigen::Vector3d kHalfBox(0.09, 0.03, 0.13);  // half the size of the cereal box

FusionSettings settings_for_tests() {
  FusionSettings settings;
  settings.grid.voxel = 0.002;
  settings.threads = 2;
  return settings;
}

/// Returns green on wide sides, red on narrow ones, blue on the top.
cv::Vec3b side_paint(const Eigen::Vector3d& p) {
  const Eigen::Vector3d past = p.cwiseAbs() - kHalfBox;
  if (past.z() > past.x() && past.z() > past.y()) return {200, 20, 20};
  return past.x() > past.y() ? cv::Vec3b(20, 20, 200) : cv::Vec3b(20, 200, 20);
}

FusedModel fused_box(bool background) {
  TurntableScene scene{test_scene::cereal_box()};
  scene.paint = side_paint;
  scene.noise_m = 0.0015;
  scene.background = background;
  return fuse_views("box", turntable_views(scene), settings_for_tests());
}

TEST(FuseViews, ABoxComesBackWithinMillimetresAndInItsColours) {
  const FusedModel model = fused_box(true);
  std::vector<double> errors;
  int inwards = 0;
  int wrong_colour = 0;
  int away_from_edges = 0;
  for (std::size_t i = 0; i < model.mesh.vertices.size(); ++i) {
    const Eigen::Vector3d v = model.mesh.vertices[i].cast<double>();
    if (!model.seen[i]) continue;
    errors.push_back(std::abs(test_scene::box_distance(v, kHalfBox)));
    const Eigen::Vector3d past = v.cwiseAbs() - kHalfBox;
    if ((past.array() > -0.006).count() > 1) continue;
    ++away_from_edges;
    inwards += test_scene::box_distance(v + 0.004 * model.mesh.normals[i].cast<double>(), kHalfBox) < 0.0 ? 1 : 0;
    wrong_colour += cv::norm(cv::Vec3i(model.mesh.colours[i]) - cv::Vec3i(side_paint(v))) > 30.0 ? 1 : 0;
  }
  EXPECT_LT(median(errors), 0.001);
  EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 0.006);
  ASSERT_GT(away_from_edges, 5000);
  EXPECT_LT(inwards, away_from_edges / 1000);
  EXPECT_LT(wrong_colour, away_from_edges / 100);
}

TEST(FuseViews, TheUnseenBottomIsFlatAndClosed) {
  for (const bool background : {true, false}) {
    const FusedModel model = fused_box(background);
    std::vector<double> bottom;
    for (std::size_t i = 0; i < model.mesh.vertices.size(); ++i) {
      const Eigen::Vector3f& v = model.mesh.vertices[i];
      if (std::abs(v.x()) < 0.08F && std::abs(v.y()) < 0.02F && v.z() < 0.0F) {
        EXPECT_FALSE(model.seen[i]);
        bottom.push_back(static_cast<double>(v.z()));
      }
    }
    ASSERT_GT(bottom.size(), 1000U);
    EXPECT_NEAR(median(bottom), -kHalfBox.z(), 0.004);
    EXPECT_NEAR(mesh_diameter(model.mesh), 2.0 * kHalfBox.norm(), 0.012);
  }
}

/// Returns the distance to the tangent plane of the nearest point.
double plane_distance(const SurfacePoints& surface, const Eigen::Vector3f& v) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < surface.points.size(); ++i) {
    if ((surface.points[i] - v).squaredNorm() < (surface.points[nearest] - v).squaredNorm()) nearest = i;
  }
  return static_cast<double>(std::abs(surface.normals[nearest].dot(v - surface.points[nearest])));
}

TEST(FuseViews, AMugKeepsItsHandleItsHollowAndTheHoleBetweenThem) {
  TurntableScene scene{test_scene::mug()};
  scene.noise_m = 0.001;
  scene.elevation = 0.9;
  const FusedModel model = fuse_views("mug", turntable_views(scene), settings_for_tests());
  const SurfacePoints truth = sample_surface(scene.mesh, 3000, 1);
  std::vector<double> errors;
  bool handle = false;
  for (std::size_t i = 0; i < model.mesh.vertices.size(); i += 7) {
    const Eigen::Vector3f& v = model.mesh.vertices[i];
    handle = handle || v.x() > 0.065F;
    if (!model.seen[i]) continue;
    errors.push_back(plane_distance(truth, v));
    EXPECT_FALSE(std::abs(v.y()) < 0.02F && v.x() > 0.048F && v.x() < 0.055F && std::abs(v.z()) < 0.01F)
        << "in the hole at " << v.transpose();
  }
  EXPECT_LT(median(errors), 0.002);
  EXPECT_TRUE(handle);
  const auto down = std::count_if(model.mesh.vertices.begin(), model.mesh.vertices.end(), [](const auto& v) {
    return v.template head<2>().norm() < 0.02F && v.z() > -0.049F && v.z() < 0.02F;
  });
  EXPECT_GT(down, 50) << "the hollow";
}

TEST(FuseViews, DoesNotDependOnThreads) {
  TurntableScene scene{test_scene::cereal_box()};
  scene.paint = side_paint;
  scene.views = 8;
  FusionSettings settings = settings_for_tests();
  settings.grid.voxel = 0.005;
  const FusedModel two = fuse_views("box", turntable_views(scene), settings);
  settings.threads = 1;
  const FusedModel one = fuse_views("box", turntable_views(scene), settings);
  EXPECT_EQ(one.mesh.vertices, two.mesh.vertices);
  EXPECT_EQ(one.mesh.colours, two.mesh.colours);
}

TEST(FuseViews, NothingToFuseIsRefusedByName) {
  const auto refusal = [](const std::vector<TrainingView>& views) -> std::string {
    return error_of([&] { fuse_views("toy", views, settings_for_tests()); });
  };
  EXPECT_EQ(refusal({}).substr(0, 4), "toy:");
  TrainingView blind = turntable_view(TurntableScene{test_scene::cereal_box()}, 0);
  blind.mask = 0;
  EXPECT_EQ(refusal({blind}).substr(0, 4), "toy:");
}

}  // namespace
}  // namespace houghstream::fusion
