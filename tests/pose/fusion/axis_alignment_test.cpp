#include "pose/fusion/axis_alignment.hpp"

#include <gtest/gtest.h>

#include "tests/pose/fusion/turntable_views.hpp"

namespace houghstream::fusion {
namespace {

using test_scene::TurntableScene;

/// Returns the error of the position of the object's middle, metres.
double middle_error_m(const DepthView& view, const Eigen::Isometry3d& truth) {
  return (view.T_camera_object.translation() - truth.translation()).norm();
}

double axis_error_deg(const DepthView& view, const Eigen::Isometry3d& truth) {
  const Eigen::Vector3d axis = view.T_camera_object.linear().col(2);
  return std::acos(std::min(1.0, axis.dot(truth.linear().col(2)))) * 180.0 / M_PI;
}

std::vector<DepthView> make_views(const std::vector<TrainingView>& views) {
  std::vector<DepthView> out;
  out.reserve(views.size());
  for (const TrainingView& view : views) out.push_back(make_depth_view(view));
  return out;
}

TEST(AxisAlignment, FindsTheAxisOfATurntable) {
  TurntableScene scene{test_scene::mug()};
  scene.noise_m = 0.001;
  const std::vector<TrainingView> training = turntable_views(scene);
  std::vector<DepthView> views = make_views(training);
  Eigen::Isometry3d wrong = Eigen::Isometry3d::Identity();
  wrong.linear() = Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Eigen::Vector3d middle = training[0].T_camera_object.translation();
  wrong.translation() = middle - wrong.linear() * middle + Eigen::Vector3d(0.005, 0.0, 0.0);
  for (DepthView& view : views) view.T_camera_object = wrong * view.T_camera_object;
  const double before = measure_alignment_error(views, {}).median_m;
  align_views(views, {});
  EXPECT_LT(measure_alignment_error(views, {}).median_m, 0.8 * before);
  EXPECT_LT(middle_error_m(views[3], training[3].T_camera_object), 0.0015);
  EXPECT_LT(axis_error_deg(views[3], training[3].T_camera_object), 0.5);
}

TEST(AxisAlignment, LeavesWhatIsRight) {
  const std::vector<TrainingView> training = turntable_views(TurntableScene{test_scene::cereal_box()});
  std::vector<DepthView> views = make_views(training);
  align_views(views, {});
  EXPECT_LT(middle_error_m(views[5], training[5].T_camera_object), 0.001);
  EXPECT_LT(axis_error_deg(views[5], training[5].T_camera_object), 0.2);
}

TEST(AxisAlignment, DoesNotDependOnThreads) {
  TurntableScene scene{test_scene::mug()};
  scene.views = 8;
  scene.noise_m = 0.001;
  std::vector<DepthView> one = make_views(turntable_views(scene));
  std::vector<DepthView> three = one;
  AlignmentSettings settings;
  align_views(one, settings);
  settings.threads = 3;
  align_views(three, settings);
  EXPECT_EQ(one[4].T_camera_object.matrix(), three[4].T_camera_object.matrix());
}

TEST(AxisAlignment, ASingleViewStays) {
  const TrainingView training = turntable_view(TurntableScene{test_scene::mug()}, 0);
  std::vector<DepthView> views = make_views({training});
  align_views(views, {});
  EXPECT_EQ(views[0].T_camera_object.matrix(), training.T_camera_object.matrix());
  EXPECT_EQ(measure_alignment_error(views, {}).pairs, 0);
}

}  // namespace
}  // namespace houghstream::fusion
