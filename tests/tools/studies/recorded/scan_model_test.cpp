#include "tools/studies/recorded/scan_model.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/pose/test_scene.hpp"

namespace houghstream {
namespace {

/// Returns three boxes that touch at corners; no turn and no mirror brings the figure onto itself.
Mesh figure() {
  Mesh mesh;
  test_scene::add_box(mesh, {-0.03F, -0.03F, -0.09F}, {0.03F, 0.03F, 0.03F});
  test_scene::add_box(mesh, {0.03F, 0.03F, 0.03F}, {0.08F, 0.05F, 0.06F});
  test_scene::add_box(mesh, {-0.06F, -0.05F, -0.09F}, {-0.03F, -0.03F, 0.0F});
  compute_normals(mesh);
  return mesh;
}

Mesh moved(Mesh mesh, const Eigen::Isometry3d& T) {
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = (T * vertex.cast<double>()).cast<float>();
  compute_normals(mesh);
  return mesh;
}

Eigen::Isometry3d far_away() {
  return Eigen::Translation3d(0.2, -0.1, -0.8) * Eigen::AngleAxisd(2.1, Eigen::Vector3d(1.0, -2.0, 0.5).normalized());
}

void expect_near(const Eigen::Isometry3d& found, const Eigen::Isometry3d& expected) {
  const Eigen::Isometry3d left = found * expected.inverse();
  EXPECT_LT(left.translation().norm(), 0.001);
  EXPECT_LT(Eigen::AngleAxisd(left.linear()).angle(), 0.01);
}

TEST(MeshCrop, KeepsWhatLiesAboveThePlaneWithItsAttributes) {
  Mesh mesh;
  test_scene::add_box(mesh, {0.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 1.0F});
  test_scene::add_box(mesh, {0.0F, 0.0F, 2.0F}, {1.0F, 1.0F, 3.0F});
  compute_normals(mesh);
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    mesh.colours.push_back(cv::Vec3b::all(static_cast<std::uint8_t>(10.0F * vertex.z())));
  const Mesh kept = crop_below(mesh, Eigen::Hyperplane<float, 3>(Eigen::Vector3f::UnitZ(), -1.5F));
  ASSERT_EQ(kept.triangles.size(), mesh.triangles.size() / 2);
  ASSERT_EQ(kept.vertices.size(), mesh.vertices.size() / 2);
  ASSERT_EQ(kept.colours.size(), kept.vertices.size());
  EXPECT_EQ(kept.normals.size(), kept.vertices.size());
  EXPECT_TRUE(kept.uvs.empty());
  for (std::size_t v = 0; v < kept.vertices.size(); ++v) {
    EXPECT_GE(kept.vertices[v].z(), 2.0F);
    EXPECT_EQ(kept.colours[v][0], static_cast<int>(10.0F * kept.vertices[v].z()));
  }
}

TEST(MeshCrop, ATriangleThatReachesBelowIsDropped) {
  Mesh mesh;
  test_scene::add_box(mesh, {0.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 1.0F});
  const Mesh lid = crop_below(mesh, Eigen::Hyperplane<float, 3>(Eigen::Vector3f::UnitZ(), -0.5F));
  EXPECT_EQ(lid.triangles.size(), 2U);
  EXPECT_EQ(lid.vertices.size(), 4U);
  EXPECT_TRUE(crop_below(mesh, Eigen::Hyperplane<float, 3>(Eigen::Vector3f::UnitZ(), -5.0F)).vertices.empty());
}

TEST(MeshCrop, WeldedCornersAreOneVertexEach) {
  Mesh mesh;
  test_scene::add_box(mesh, {0.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 1.0F});
  const Mesh box = welded(mesh);
  EXPECT_EQ(box.vertices.size(), 8U);
  EXPECT_EQ(box.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(box.normals.size(), 8U);
}

TEST(MeshCrop, BaseIsTheLowestHeightButForStrays) {
  Mesh mesh;
  for (int i = 0; i < 2000; ++i) mesh.vertices.emplace_back(0.0F, 0.0F, 0.001F * static_cast<float>(i));
  mesh.vertices.emplace_back(0.0F, 0.0F, -7.0F);
  EXPECT_NEAR(base_height(mesh), 0.003, 1e-5);
  EXPECT_THROW(base_height(Mesh()), InputError);
}

TEST(AlignMeshes, FindsAnyTurnAndSaysThatOthersAreWorse) {
  const MeshAlignment found = align_meshes(moved(figure(), far_away()), figure());
  expect_near(found.T_target_source, far_away().inverse());
  EXPECT_LT(found.rms_m, 0.0005);
  EXPECT_GT(found.next_rms_m, 0.002);
}

TEST(AlignMeshes, ASymmetricShapeHasAnotherTurnThatFitsAsWell) {
  const Mesh box = test_scene::cereal_box();
  const MeshAlignment found = align_meshes(moved(box, far_away()), box);
  EXPECT_LT(found.rms_m, 0.0005);
  EXPECT_LT(found.next_rms_m, 0.0005);
}

TEST(AlignMeshes, MeshesWithoutSurfaceAreRefused) {
  EXPECT_THROW(align_meshes(Mesh(), figure()), InputError);
  EXPECT_THROW(align_meshes(figure(), Mesh()), InputError);
}

TEST(FitScan, LosesTheGroundAndTakesTheColoursOfTheViews) {
  Mesh fused = figure();
  fused.colours.assign(fused.vertices.size(), cv::Vec3b(10, 20, 200));
  Mesh scan = figure();
  test_scene::add_box(scan, {-0.09F, -0.05F, -0.1F}, {0.05F, 0.08F, -0.099F});  // scanned ground
  const ScanModel model = fit_scan(moved(scan, far_away()), fused, 0.008);
  expect_near(model.alignment.T_target_source, far_away().inverse());
  EXPECT_NEAR(mesh_bounds(model.mesh).min().z(), -0.09F, 0.001F);
  EXPECT_NEAR(mesh_bounds(model.mesh).max().z(), 0.06F, 0.001F);
  ASSERT_EQ(model.mesh.colours.size(), model.mesh.vertices.size());
  EXPECT_EQ(model.mesh.colours.front(), cv::Vec3b(10, 20, 200));
  EXPECT_EQ(model.mesh.normals.size(), model.mesh.vertices.size());
  EXPECT_THROW(fit_scan(scan, fused, 1.0), InputError);
}

}  // namespace
}  // namespace houghstream
