#include "pose/fusion/view_colours.hpp"

#include <gtest/gtest.h>

#include "tests/pose/fusion/turntable_views.hpp"

namespace houghstream::fusion {
namespace {

/// Returns two squares of 12 cm, 2 cm apart, one behind the other; both face -y.
Mesh two_sheets() {
  Mesh mesh;
  for (const float y : {0.0F, 0.02F}) {
    test_scene::add_quad(mesh, {Eigen::Vector3f(-0.06F, y, -0.06F), Eigen::Vector3f(0.06F, y, -0.06F),
                                Eigen::Vector3f(0.06F, y, 0.06F), Eigen::Vector3f(-0.06F, y, 0.06F)});
  }
  compute_normals(mesh);
  return mesh;
}

TEST(ViewColours, VerticesTakeTheColourOfWhatTheyShowAndHiddenOnesAreNotSeen) {
  test_scene::TurntableScene scene{two_sheets()};
  scene.paint = [](const Eigen::Vector3d& p) { return cv::Vec3b(p.x() > 0.0 ? 200 : 50, 90, p.z() > 0.0 ? 30 : 220); };
  scene.elevation = 0.0;
  const std::vector<DepthView> views = {make_depth_view(turntable_view(scene, 0))};
  Mesh mesh;
  for (const float y : {0.0F, 0.02F}) mesh.vertices.emplace_back(0.02F, y, -0.03F);
  mesh.normals = {{0.0F, -1.0F, 0.0F}, {0.0F, -1.0F, 0.0F}};
  const std::vector<bool> seen = colour_mesh(views, 0.004, 1, mesh);
  EXPECT_EQ(seen, (std::vector<bool>{true, false}));
  EXPECT_EQ(mesh.colours[0], cv::Vec3b(200, 90, 220));
}

TEST(ViewColours, TheUnseenTakesItsNeighboursColour) {
  test_scene::TurntableScene scene{two_sheets()};
  scene.elevation = 0.0;
  const std::vector<DepthView> views = {make_depth_view(turntable_view(scene, 0))};
  Mesh mesh;
  mesh.vertices = {{0.0F, 0.0F, 0.0F}, {0.0F, 0.1F, 0.0F}, {0.0F, 0.1F, 0.1F}, {0.0F, 0.2F, 0.1F}};
  mesh.normals.assign(4, -Eigen::Vector3f::UnitY());
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
  const std::vector<bool> seen = colour_mesh(views, 0.004, 1, mesh);
  EXPECT_EQ(seen, (std::vector<bool>{true, false, false, false}));
  for (const cv::Vec3b& colour : mesh.colours) EXPECT_EQ(colour, cv::Vec3b(90, 120, 150));
}

}  // namespace
}  // namespace houghstream::fusion
