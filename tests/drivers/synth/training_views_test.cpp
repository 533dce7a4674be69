#include "drivers/synth/training_views.hpp"

#include <gtest/gtest.h>

#include "pipeline/checks.hpp"

namespace houghstream {
namespace {

TEST(TrainingViews, ShowOneObjectFromAllRoundAtSeveralPitches) {
  TurntableSettings settings;
  settings.azimuths = 4;
  settings.pitches = 2;
  const Turntable turntable(settings, 1);
  ASSERT_EQ(turntable.view_count(), 8);
  const TaughtObject mug = make_taught_object(3);
  for (const int index : {0, 1, 5}) {
    const SceneFrame view = turntable.render(mug, index);
    ASSERT_EQ(view.objects.size(), 1U);
    EXPECT_EQ(view.objects[0].object_id, 3);
    EXPECT_DOUBLE_EQ(view.objects[0].visible_fraction, 1.0);
    EXPECT_GT(cv::countNonZero(view.visible_masks[0]), 2000);
    const Eigen::Isometry3d& T_camera_object = view.objects[0].T_camera_object;
    EXPECT_NEAR(T_camera_object.translation().norm(), 0.7, 0.05);
    const Eigen::Vector3d eye_object = T_camera_object.inverse().translation();
    const double pitch = std::asin(eye_object.z() / eye_object.norm()) * 180.0 / M_PI;
    EXPECT_NEAR(pitch, index < 4 ? 30.0 : 60.0, 2.0);
    const double azimuth = std::atan2(eye_object.x(), -eye_object.y()) * 180.0 / M_PI;
    EXPECT_NEAR(azimuth, index % 4 == 0 ? 0.0 : -90.0, 2.0);
  }
}

TEST(TrainingViews, RefusesAbsurdSettings) {
  TurntableSettings settings;
  settings.azimuths = 0;
  EXPECT_THROW(Turntable(settings, 1), InputError);
}

}  // namespace
}  // namespace houghstream
