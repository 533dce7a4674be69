#include "tools/render/world/training_views.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "pipeline/base/checks.hpp"
#include "pipeline/geometry/renderer.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"

namespace houghstream::world {
namespace {

TEST(TrainingViews, ShowOneObjectFromAllRoundAtSeveralPitches) {
  TurntableSettings settings;
  settings.azimuths = 4;
  settings.pitches = 2;
  const TurntableWorld turntable(settings, 1);
  ASSERT_EQ(turntable.view_count(nullptr), 8);
  const TaughtObject mug = make_taught_object(3);
  for (const int index : {0, 1, 5}) {
    const RenderedFrame view = turntable.render(mug, nullptr, index);
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

TEST(TrainingViews, TheCameraStandsAsFarAwayAsAsked) {
  TurntableSettings settings;
  settings.distance_m = 1.3;
  const RenderedFrame view = TurntableWorld(settings, 1).render(make_taught_object(3), nullptr, 0);
  EXPECT_NEAR(view.objects.at(0).T_camera_object.translation().norm(), 1.3, 0.08);
}

TurntableSettings few_views(const std::vector<Attitude>& attitudes) {
  TurntableSettings settings;
  settings.azimuths = 5;
  settings.pitches = 1;
  settings.attitudes = attitudes;
  return settings;
}

// Returns the fraction of the mask's pixels with depth at which the model, rendered by the ground truth, has the same
// depth.
double agreeing_fraction(const RenderedFrame& view, const Mesh& mesh) {
  const cv::Rect frame({0, 0}, view.frame.depth.size());
  const cv::Mat rendered = render_depth(mesh, view.objects.at(0).T_camera_object, view.frame.camera, frame);
  int measured = 0;
  int agreeing = 0;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const float depth = view.frame.depth.at<float>(y, x);
      if (view.visible_masks.at(0).at<std::uint8_t>(y, x) == 0 || std::isnan(depth)) continue;
      ++measured;
      agreeing += std::abs(rendered.at<float>(y, x) - depth) < 0.01F ? 1 : 0;
    }
  }
  return measured > 500 ? static_cast<double>(agreeing) / measured : 0.0;
}

TEST(TrainingViews, LyingAndTiltedOnesMatchTheirTruth) {
  const TurntableWorld turntable(few_views({Attitude::kLying, Attitude::kTilted}), 1);
  for (int id = 1; id <= kClassCount; ++id) {
    const TaughtObject object = make_taught_object(id);
    SCOPED_TRACE(object.name);
    const AttitudeChoice choice(object.thing->mesh);
    const int lying = 3 * choice.lying_count();
    ASSERT_EQ(turntable.view_count(&choice), lying + 5);
    for (const int index : {0, 1, 2, lying + 1}) {
      const RenderedFrame view = turntable.render(object, &choice, index);
      ASSERT_EQ(view.objects.size(), 1U);
      EXPECT_GT(agreeing_fraction(view, object.thing->mesh), 0.9);
    }
  }
}

TEST(TrainingViews, LyingOnesShowEverySideOfABox) {
  const AttitudeChoice choice(make_taught_object(2).thing->mesh);
  Random random(1);
  std::set<std::array<int, 3>> ups;
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3i up =
        choice.R_table_object(Attitude::kLying, i, random).row(2).transpose().array().round().cast<int>();
    ups.insert({up.x(), up.y(), up.z()});
  }
  EXPECT_EQ(ups.size(), 5U);
  EXPECT_EQ(ups.count({0, 0, 1}), 0U);
}

TEST(TrainingViews, UprightOnesDoNotDependOnTheOthers) {
  const TaughtObject mug = make_taught_object(3);
  const AttitudeChoice choice(mug.thing->mesh);
  const RenderedFrame alone = TurntableWorld(few_views({Attitude::kUpright}), 1).render(mug, nullptr, 2);
  const RenderedFrame second =
      TurntableWorld(few_views({Attitude::kTilted, Attitude::kUpright}), 1).render(mug, &choice, 5 + 2);
  EXPECT_EQ(cv::norm(alone.frame.colour, second.frame.colour, cv::NORM_INF), 0.0);
  EXPECT_TRUE(alone.objects[0].T_camera_object.matrix() == second.objects[0].T_camera_object.matrix());
}

TEST(TrainingViews, RefusesAbsurdSettings) {
  TurntableSettings settings;
  settings.azimuths = 0;
  EXPECT_THROW(TurntableWorld(settings, 1), InputError);
  EXPECT_THROW(TurntableWorld(few_views({}), 1), InputError);
  EXPECT_THROW(TurntableWorld(few_views({Attitude::kLying, Attitude::kLying}), 1), InputError);
  EXPECT_THROW(TurntableWorld(few_views({Attitude::kLying}), 1).render(make_taught_object(3), nullptr, 0), InputError);
  EXPECT_THROW(parse_attitude("floating"), InputError);
}

}  // namespace
}  // namespace houghstream::world
