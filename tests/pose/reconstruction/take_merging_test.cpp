#include "pose/reconstruction/take_merging.hpp"

#include <gtest/gtest.h>

#include "tests/pose/reconstruction/shown_scene.hpp"

namespace houghstream::reconstruction {
namespace {

TEST(FuseMaskedViews, PicturesThatCutTheObjectOffDoNotCutTheModelOff) {
  const test_scene::ShownScene scene;
  const Mesh table = test_scene::table_with(scene);
  Mesh box;
  test_scene::add_box(scene.box, 0.0, box);
  MaskedViews views;
  views.whole_pictures = true;
  const cv::Rect lower_half(0, scene.camera.height / 2, scene.camera.width, scene.camera.height / 2);
  for (int i = 0; i < 24; ++i) {
    TrainingView view;
    view.T_camera_object = test_scene::camera_at(2.0 * M_PI * i / 24, 0.7, 0.6);
    view.frame = test_scene::photograph(table, view.T_camera_object, scene.camera, i + 1);
    if (i % 3 != 0) {  // the camera looks down, at the object's foot
      view.frame.colour = view.frame.colour(lower_half);
      view.frame.depth = view.frame.depth(lower_half);
      view.frame.camera = scene.camera.cropped(lower_half.x, lower_half.y, lower_half.width, lower_half.height);
    }
    view.mask = mask_of(box, view.frame, view.T_camera_object);
    views.views.push_back(std::move(view));
  }
  ModelMaking settings;
  settings.voxel_m = 0.003;
  const Eigen::AlignedBox3f bounds = mesh_bounds(fuse_masked_views("box", views, box, 0.0, settings).mesh);
  EXPECT_NEAR(bounds.sizes().z(), scene.box.z(), 0.01);
}

}  // namespace
}  // namespace houghstream::reconstruction
