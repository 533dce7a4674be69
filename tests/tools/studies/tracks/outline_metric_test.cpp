#include "tools/studies/tracks/outline_metric.hpp"

#include <gtest/gtest.h>

#include "tests/pose/test_scene.hpp"

namespace houghstream::studies {
namespace {

TEST(OutlineMetrics, AShiftAcrossTheViewMovesTheOutlineByItsPixels) {
  const ObjectModel model = make_object_model("box", test_scene::cereal_box(), ModelSettings());
  const Eigen::Isometry3d truth = test_scene::standing(20.0, 30.0, 1.0);
  const Camera& camera = test_scene::kCamera;
  EXPECT_NEAR(outline_distance_px(model, camera, truth, truth), 0.0, 1e-6);
  const Eigen::Isometry3d beside = Eigen::Translation3d(0.01, 0.0, 0.0) * truth;
  const double shift_px = camera.fx * 0.01 / 1.0;
  const double apart_px = outline_distance_px(model, camera, truth, beside);
  EXPECT_LT(apart_px, shift_px) << "edges along the shift stay where they are";
  EXPECT_GT(apart_px, 0.3 * shift_px);
  const Eigen::Isometry3d nearer = Eigen::Translation3d(0.0, 0.0, -0.001) * truth;
  EXPECT_LT(outline_distance_px(model, camera, truth, nearer), 0.2);
}

}  // namespace
}  // namespace houghstream::studies
