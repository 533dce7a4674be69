#include "pose/following/region_modality.hpp"

#include <gtest/gtest.h>

#include "tests/pose/following/modality_scene.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

RegionLines lines_at(const ModalityScene& scene, const Eigen::Isometry3d& pose, const RegionScale& scale) {
  return find_region_lines(scene.view(), make_silhouette(scene.model, pose, 200), scene.learnt(), pose, scale, {});
}

/// Steps from a pose by the silhouette alone, at one scale.
Eigen::Isometry3d drawn_in(const ModalityScene& scene, Eigen::Isometry3d pose, const RegionScale& scale) {
  constexpr double kHeld = 3e4;  // 1/m^2
  for (int i = 0; i < 8; ++i) {
    const Silhouette silhouette = make_silhouette(scene.model, pose, 200);
    const RegionLines lines = find_region_lines(scene.view(), silhouette, scene.learnt(), pose, scale, {});
    MotionEquations equations = region_equations(scene.view(), lines.lines, pose, scale, EdgeStep::kToMean, {});
    equations.hessian.diagonal().array() += kHeld;
    move_by_step(equations.hessian.selfadjointView<Eigen::Lower>().ldlt().solve(equations.gradient), scene.model, pose);
  }
  return pose;
}

TEST(RegionModality, AnOuterProductIsBitForBitThatOfEigen) {
  Vector6d row;
  row << 0.1, -3.7, 1e-3, 17.0, -0.33, 2.0 / 3.0;
  Matrix6d ours = Matrix6d::Constant(0.7);
  Matrix6d theirs = ours;
  add_outer_product(row, 0.3, ours);
  theirs.selfadjointView<Eigen::Lower>().rankUpdate(row, 0.3);
  EXPECT_EQ(ours, theirs);
}

TEST(RegionModality, EdgesAreOnTheSilhouetteAtTheTruePose) {
  const ModalityScene& scene = box_scene();
  const RegionLines found = lines_at(scene, scene.truth, {1, 1.5});
  EXPECT_GE(found.lines.size(), 150U);
  double sum = 0.0;
  for (const RegionLine& line : found.lines) sum += line.mean / line.segments_per_px;
  EXPECT_LT(std::abs(sum) / static_cast<double>(found.lines.size()), 0.4) << "pixels";
}

TEST(RegionModality, DrawsAPoseInFromTheSide) {
  const ModalityScene& scene = box_scene();
  Eigen::Isometry3d pose = scene.truth;
  pose.pretranslate(Eigen::Vector3d(0.015, -0.008, 0.0));  // ten pixels
  const Eigen::Isometry3d coarse = drawn_in(scene, pose, {4, 5.0});
  const Eigen::Isometry3d fine = drawn_in(scene, coarse, {1, 1.5});
  EXPECT_LT(scene.shift_of(fine).head<2>().norm(), 0.0015);
}

/// Displacement of the object away from the camera after one step of all lines, metres, with the information of the
/// lines on it.
struct StepAway {
  double step_m = 0.0;
  double information = 0.0;
};

StepAway step_away(const ModalityScene& scene, double common_error_px) {
  RegionModalitySettings settings;
  settings.common_error_px = common_error_px;
  const RegionLines lines = lines_at(scene, scene.truth, {1, 1.5});
  MotionEquations equations =
      region_equations(scene.view(), lines.lines, scene.truth, {1, 1.5}, EdgeStep::kToMean, settings);
  const double information = equations.hessian(5, 5);
  equations.hessian.diagonal().array() += 1e4;  // 1/m^2
  const Vector6d step = equations.hessian.selfadjointView<Eigen::Lower>().ldlt().solve(equations.gradient);
  return {step.tail<3>().z(), information};
}

TEST(RegionModality, AnOutlineThatIsTooWideAllRoundHardlyChangesTheDistance) {
  ModalityScene scene = box_scene().copy();
  cv::dilate(scene.frame.colour, scene.frame.colour, {}, {-1, -1}, 2);  // the object is the brighter side
  const StepAway trusting = step_away(scene, 0.0);
  const StepAway careful = step_away(scene, 3.0);
  EXPECT_GT(std::abs(trusting.step_m), 0.004) << "the outline says that it is nearer";
  EXPECT_LT(std::abs(careful.step_m), 0.4 * std::abs(trusting.step_m));
  EXPECT_LT(careful.information, 0.2 * trusting.information);
  EXPECT_GT(careful.information, 0.0);
}

TEST(RegionModality, ALineBehindNearerDepthSaysNothing) {
  ModalityScene scene = box_scene().copy();
  const std::size_t before = lines_at(scene, scene.truth, {1, 1.5}).lines.size();
  const Eigen::Vector2d middle = kCamera.project(scene.truth * scene.model.centre.cast<double>());
  const int column = static_cast<int>(middle.x());
  scene.frame.depth(cv::Rect(0, 0, column, kCamera.height)) = 0.4F;  // an arm over the left half
  const RegionLines found = lines_at(scene, scene.truth, {1, 1.5});
  EXPECT_GT(found.covered, 50);
  EXPECT_LT(found.lines.size(), 0.75 * static_cast<double>(before));
  for (const RegionLine& line : found.lines) EXPECT_GT(line.centre_px.x(), static_cast<float>(column) - 5.0F);
}

TEST(RegionModality, AFrameOfOneColourHasNoEdges) {
  for (const int tone : {0, 255}) {
    ModalityScene scene = box_scene().copy();
    const ColourStatistics colours = scene.learnt();
    scene.frame.colour.setTo(cv::Scalar::all(tone));
    const Silhouette silhouette = make_silhouette(scene.model, scene.truth, 200);
    const RegionLines found = find_region_lines(scene.view(), silhouette, colours, scene.truth, {1, 1.5}, {});
    EXPECT_TRUE(found.lines.empty()) << tone;
    EXPECT_GE(found.blank, 150) << tone;
  }
}

TEST(RegionModality, WhatIsBeforeTheObjectIsNotLearntAsItsColour) {
  ModalityScene scene = box_scene().copy();
  const cv::Vec3b sleeve(10, 10, 10);
  const Eigen::Vector2d middle = kCamera.project(scene.truth * scene.model.centre.cast<double>());
  const cv::Rect left(0, 0, static_cast<int>(middle.x()), kCamera.height);
  scene.frame.depth(left) = 0.4F;
  scene.frame.colour(left) = sleeve;
  EXPECT_LT(scene.learnt().foreground(sleeve), 0.1F);
}

}  // namespace
}  // namespace houghstream
