#include "pose/reconstruction/model/take_model.hpp"

#include <gtest/gtest.h>

#include "tests/pose/reconstruction/shown_scene.hpp"

namespace houghstream::reconstruction {
namespace {

TEST(FuseMaskedViews, ImagesThatCutTheObjectOffDoNotCutTheModelOff) {
  const test_scene::ShownScene scene;
  const Mesh table = test_scene::table_with(scene);
  const Mesh box = test_scene::box_of(scene);
  MaskedViews views;
  views.whole_images = true;
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
    view.mask = render_visible_mask(box, view.frame, view.T_camera_object);
    views.views.push_back(std::move(view));
  }
  ReconstructionSettings settings;
  settings.voxel_m = 0.003;
  const Eigen::AlignedBox3f bounds = mesh_bounds(fuse_masked_views("box", views, box, 0.0, settings).mesh);
  EXPECT_NEAR(bounds.sizes().z(), scene.box.z(), 0.01);
}

/// Returns images of the box on its table from all round, from an azimuth on.
Take take_about_box(double azimuth) {
  constexpr int kImages = 12;
  const test_scene::ShownScene scene;
  const Mesh table = test_scene::table_with(scene);
  Take take;
  for (int i = 0; i < kImages; ++i) {
    Keyframe keyframe;
    keyframe.T_camera_world = test_scene::camera_at(azimuth + 2.0 * M_PI * i / kImages, 0.7, 0.6);
    keyframe.frame = test_scene::photograph(table, keyframe.T_camera_world, scene.camera, i + 1);
    take.keyframes.push_back(std::move(keyframe));
  }
  return take;
}

/// Returns the true box as the model of a take, which says of itself that it agrees badly.
ReconstructedModel ground_truth_model(const Take& take) {
  ReconstructedModel model;
  model.mesh = test_scene::box_of({});
  compute_normals(model.mesh);
  model.seen.assign(model.mesh.vertices.size(), true);
  for (std::size_t i = 0; i < take.keyframes.size(); ++i) {
    const Keyframe& keyframe = take.keyframes[i];
    model.views.push_back({static_cast<int>(i), keyframe.T_camera_world,
                           render_visible_mask(model.mesh, keyframe.frame, keyframe.T_camera_world)});
  }
  model.deviation_m = 1.0;
  return model;
}

TEST(MergeTakes, HowWellTheViewsAgreeIsThatOfBothTakes) {
  const Take first = take_about_box(0.0);
  const Take second = take_about_box(0.26);
  ReconstructedModel model = ground_truth_model(first);
  ReconstructedModel other = ground_truth_model(second);
  ReconstructionSettings settings;
  settings.voxel_m = 0.003;
  ASSERT_TRUE(merge_takes(first, model, second, other, settings));
  EXPECT_LT(model.deviation_m, 0.003);
  EXPECT_EQ(other.deviation_m, model.deviation_m);
  EXPECT_EQ(model.deviation_m, surface_deviation(model.mesh, {{&first, &model.views}, {&second, &other.views}}, 1));
}

}  // namespace
}  // namespace houghstream::reconstruction
