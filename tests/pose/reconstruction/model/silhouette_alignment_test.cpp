#include "pose/reconstruction/model/silhouette_alignment.hpp"

#include <gtest/gtest.h>

#include "tests/pose/fusion/turntable_views.hpp"

namespace houghstream::reconstruction {
namespace {

TEST(OutlinePlacement, AViewMovesToWhereItsMaskIs) {
  test_scene::TurntableScene scene;
  scene.mesh = test_scene::mug();
  std::vector<TrainingView> views;
  for (int i = 0; i < 4; ++i) {
    views.push_back(turntable_view(scene, i));
    views.back().T_camera_object.translation() += Eigen::Vector3d(0.007, -0.005, 0.012);
    EXPECT_LT(silhouette_iou(scene.mesh, views.back()), 0.87);
  }
  align_silhouettes(scene.mesh, 2, views);
  for (int i = 0; i < 4; ++i) {
    const TrainingView& view = views[static_cast<std::size_t>(i)];
    EXPECT_GT(silhouette_iou(scene.mesh, view), 0.97);
    const Eigen::Isometry3d truth = turntable_view(scene, i).T_camera_object;
    EXPECT_LT((view.T_camera_object.translation() - truth.translation()).norm(), 0.002);
    EXPECT_TRUE(view.T_camera_object.linear().isApprox(truth.linear()));
  }
}

TEST(OutlinePlacement, WithoutDepthAndMaskNothingMoves) {
  test_scene::TurntableScene scene;
  scene.mesh = test_scene::mug();
  std::vector<TrainingView> views = {turntable_view(scene, 0)};
  views[0].mask.setTo(0);
  const Eigen::Isometry3d before = views[0].T_camera_object;
  EXPECT_EQ(silhouette_iou(scene.mesh, views[0]), 0.0);
  align_silhouettes(scene.mesh, 1, views);
  EXPECT_EQ(views[0].T_camera_object.matrix(), before.matrix());
}

}  // namespace
}  // namespace houghstream::reconstruction
