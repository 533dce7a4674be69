#include "tools/render/world/calibration_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "pipeline/base/checks.hpp"
#include "pipeline/geometry/renderer.hpp"
#include "tests/tools/render/world/scene_checks.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"

namespace houghstream::world {
namespace {

constexpr int kFrames = 4;

CalibrationSceneObject brick(int id, const Eigen::Vector3d& size, const cv::Vec3b& colour) {
  Mesh mesh = box(size, cv::Mat(8, 8, CV_8UC3, cv::Scalar::all(0)));
  mesh.texture.release();
  mesh.colours.assign(mesh.vertices.size(), colour);
  CalibrationSceneObject object;
  object.id = id;
  object.thing = make_taught_thing(mesh, true);
  object.ups = up_directions(mesh, MeshAttitudes::kResting);
  return object;
}

CalibrationScenes two_bricks(std::uint64_t seed) {
  return {{brick(3, {0.08, 0.12, 0.18}, {30, 30, 200}), brick(8, {0.1, 0.1, 0.06}, {200, 60, 20})}, seed};
}

/// Returns the pose of the second object relative to the first, in a frame that shows both.
Eigen::Matrix4d between(const RenderedFrame& view) {
  if (view.objects.size() != 2) throw std::runtime_error("both bricks expected");
  return (view.objects[0].T_camera_object.inverse() * view.objects[1].T_camera_object).matrix();
}

TEST(CalibrationScenes, TheSameSeedGivesTheSameFrameAndAnotherOneAnotherRoom) {
  const RenderedFrame frame = two_bricks(1).render(0).front();
  const RenderedFrame again = two_bricks(1).render(0).front();
  EXPECT_TRUE(identical(frame.frame.colour, again.frame.colour));
  EXPECT_TRUE(identical(frame.frame.depth, again.frame.depth));
  EXPECT_EQ(frame.objects.size(), again.objects.size());
  const RenderedFrame other = two_bricks(2).render(0).front();
  const double apart = cv::norm(frame.frame.colour, other.frame.colour, cv::NORM_L1) / (640.0 * 480.0 * 3.0);
  EXPECT_GT(apart, 8.0) << "not only the noise";
  EXPECT_GT((between(frame) - between(other)).cwiseAbs().maxCoeff(), 0.02) << "not only the camera's place";
}

TEST(CalibrationScenes, SettingsGiveTheCameraTheNumberOfFramesAndTheNumberOfObjects) {
  CalibrationSceneSettings settings;
  settings.frames = 3;
  settings.camera = synthetic_camera();
  settings.min_objects = 1;
  settings.max_objects = 1;
  const CalibrationScenes scenes(
      {brick(3, {0.08, 0.12, 0.18}, {30, 30, 200}), brick(8, {0.1, 0.1, 0.06}, {200, 60, 20})}, 1, settings);
  const std::vector<RenderedFrame> frames = scenes.render(0);
  ASSERT_EQ(frames.size(), 3U);
  for (const RenderedFrame& view : frames) {
    EXPECT_EQ(view.frame.camera.fx, synthetic_camera().fx);
    EXPECT_LE(view.objects.size(), 1U);
  }
  EXPECT_FALSE(identical(frames[0].frame.colour, frames[2].frame.colour));
}

/// Returns the median distance of the measured depth from the mesh's at the true pose, metres.
float median_error(const RenderedFrame& view, std::size_t index, const Mesh& mesh) {
  const cv::Rect all({0, 0}, view.frame.depth.size());
  const cv::Mat rendered = render_depth(mesh, view.objects[index].T_camera_object, view.frame.camera, all);
  std::vector<float> errors;
  for (int y = 0; y < all.height; ++y) {
    for (int x = 0; x < all.width; ++x) {
      const float error = std::abs(rendered.at<float>(y, x) - view.frame.depth.at<float>(y, x));
      if (view.visible_masks[index].at<std::uint8_t>(y, x) != 0 && !std::isnan(error)) errors.push_back(error);
    }
  }
  if (errors.empty()) return NAN;
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  return errors[errors.size() / 2];
}

TEST(CalibrationScenes, TheTruthAgreesWithTheMeasuredDepth) {
  const std::map<int, Mesh> meshes = {{3, brick(3, {0.08, 0.12, 0.18}, {30, 30, 200}).thing->mesh},
                                      {8, brick(8, {0.1, 0.1, 0.06}, {200, 60, 20}).thing->mesh}};
  const CalibrationScenes scenes = two_bricks(1);
  int judged = 0;
  for (int f = 0; f < kFrames; ++f) {
    const RenderedFrame view = scenes.render(f).front();
    check_frame(view.frame, "rendered");
    for (std::size_t i = 0; i < view.objects.size(); ++i) {
      if (cv::countNonZero(view.visible_masks[i]) < 300) continue;
      const float error = median_error(view, i, meshes.at(view.objects[i].object_id));
      if (std::isnan(error)) continue;
      ++judged;
      EXPECT_LT(error, 0.006F) << "frame " << f << " object " << view.objects[i].object_id;
    }
  }
  EXPECT_GE(judged, kFrames);
}

/// Returns the object with another origin.
CalibrationSceneObject displaced(CalibrationSceneObject object, const Eigen::Vector3f& away) {
  Mesh mesh = object.thing->mesh;
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex += away;
  object.thing = make_taught_thing(std::move(mesh), true);
  return object;
}

TEST(CalibrationScenes, WhereTheOriginLiesMakesNoDifference) {
  const Eigen::Vector3f away(0.8F, -2.3F, 0.5F);
  const CalibrationSceneObject object = brick(5, {0.08, 0.12, 0.18}, {30, 30, 200});
  const CalibrationScenes scenes({object}, 4);
  const CalibrationScenes far_scenes({displaced(object, away)}, 4);
  int named = 0;
  for (int room = 0; room < kFrames; ++room) {
    const RenderedFrame view = scenes.render(room).front();
    const RenderedFrame far_view = far_scenes.render(room).front();
    ASSERT_EQ(far_view.objects.size(), view.objects.size()) << room;
    for (std::size_t i = 0; i < view.objects.size(); ++i) {
      const Eigen::Vector3d middle = far_view.objects[i].T_camera_object * away.cast<double>();
      EXPECT_LT((middle - view.objects[i].T_camera_object.translation()).norm(), 1e-3) << room;
      ++named;
    }
  }
  EXPECT_GE(named, kFrames / 2);
}

TEST(CalibrationScenes, LookAlikesAreNotNamedInTheTruth) {
  const CalibrationScenes scenes({brick(5, {0.08, 0.12, 0.18}, {30, 30, 200})}, 4);
  int named = 0;
  for (int f = 0; f < kFrames; ++f) {
    const RenderedFrame view = scenes.render(f).front();
    EXPECT_LE(view.objects.size(), 1U) << "one brick stands in each room, all others are nearly it";
    for (const GroundTruthObject& object : view.objects) EXPECT_EQ(object.object_id, 5);
    named += static_cast<int>(view.objects.size());
  }
  EXPECT_GE(named, kFrames / 2);
}

TEST(CalibrationScenes, WhatIsPractisedStandsInEachRoomAmongManyOthers) {
  constexpr int kRooms = 8;
  std::vector<CalibrationSceneObject> objects;
  for (int id = 1; id <= 12; ++id) {
    objects.push_back(brick(id, {0.08, 0.08, 0.08}, {30, 30, 200}));
    objects.back().is_calibrated = id == 5;
  }
  const CalibrationScenes scenes(objects, 4);
  int rooms = 0;
  for (int room = 0; room < kRooms; ++room) {
    const auto frames = scenes.render(room);
    rooms += std::any_of(frames.begin(), frames.end(), [](const RenderedFrame& frame) {
      return std::any_of(frame.objects.begin(), frame.objects.end(),
                         [](const GroundTruthObject& object) { return object.object_id == 5; });
    });
  }
  EXPECT_GE(rooms, kRooms - 1) << "of which a frame may look past it";
}

TEST(CalibrationScenes, FramesOfOneRoomShowItFromOtherSides) {
  const CalibrationScenes scenes = two_bricks(1);
  auto frames = scenes.render(0);
  for (int room = 1; frames.front().objects.size() < 2 || frames.back().objects.size() < 2; ++room)
    frames = scenes.render(room);  // until both bricks are in view
  const RenderedFrame& first = frames.front();
  const RenderedFrame& second = frames.back();
  EXPECT_FALSE(identical(first.frame.colour, second.frame.colour));
  EXPECT_LT((between(first) - between(second)).cwiseAbs().maxCoeff(), 1e-6);
}

}  // namespace
}  // namespace houghstream::world
