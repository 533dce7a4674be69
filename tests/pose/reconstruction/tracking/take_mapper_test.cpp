#include "pose/reconstruction/tracking/take_mapper.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "pose/reconstruction/model/take_model.hpp"
#include "tests/pose/reconstruction/shown_scene.hpp"

namespace houghstream::reconstruction {
namespace {

using test_scene::photograph;
using test_scene::ShownScene;
using test_scene::table_with;

constexpr int kFrames = 100;
constexpr double kAngle = 6.283185307179586;

/// The camera goes once about the box, and a little farther.
Eigen::Isometry3d ground_truth_pose(int i) {
  return test_scene::camera_at(0.3 + 1.04 * kAngle * i / kFrames, 0.55 + 0.1 * std::sin(0.1 * i), 0.65);
}

Take go_round(const Mesh& mesh, int from, int to, const std::vector<int>& black) {
  TakeMapper mapper{TakeMapperSettings()};
  for (int i = from; i < to; ++i) {
    RgbdFrame frame = photograph(mesh, ground_truth_pose(i), ShownScene().camera, 1 + 33000 * i);
    if (std::find(black.begin(), black.end(), i) != black.end()) {
      frame.colour.setTo(cv::Scalar::all(0));
      frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
    }
    mapper.process(frame);
  }
  return mapper.finish();
}

/// Returns the drift of the last tracked pose relative to the first, metres at the object.
double drift_m(const Take& take, int first, int last) {
  const auto pose = [&](int i) { return take.pose_of(take.frames[static_cast<std::size_t>(i)]); };
  const Eigen::Isometry3d at_first = pose(first).inverse() * ground_truth_pose(first);
  const Eigen::Isometry3d at_last = pose(last).inverse() * ground_truth_pose(last);
  return (at_first.inverse() * at_last).translation().norm();
}

TEST(TakeMapper, ClosesATurnAndMakesAModel) {
  const Take take = go_round(table_with({}), 0, kFrames, {});
  EXPECT_EQ(take.motion, Motion::kCamera);
  EXPECT_EQ(take.covered_degrees, 360);
  EXPECT_TRUE(take.lost.empty());
  ASSERT_TRUE(take.loop_error);
  EXPECT_LT(take.loop_error->shift_m, 0.01);
  EXPECT_LT(drift_m(take, 0, kFrames - 1), 0.003);
  const ReconstructedModel model = reconstruct_model(take, {});
  const Eigen::AlignedBox3f bounds = mesh_bounds(model.mesh);
  EXPECT_NEAR(bounds.min().z(), 0.0, 0.003);
  EXPECT_NEAR(bounds.max().z(), 0.16, 0.004);
  EXPECT_NEAR(bounds.diagonal().head<2>().norm(), std::hypot(bounds.sizes().x(), bounds.sizes().y()), 1e-4);
  EXPECT_NEAR(mesh_diameter(model.mesh), Eigen::Vector3d(0.12, 0.08, 0.16).norm(), 0.006);
  EXPECT_LT(model.deviation_m, 0.001);
}

TEST(TakeMapper, FirstSaysWhatItTakesForTheObject) {
  RgbdFrame frame = photograph(table_with({}), ground_truth_pose(0), ShownScene().camera, 1);
  TakeMapper mapper{TakeMapperSettings()};
  const std::string choice = mapper.process(frame).message;
  EXPECT_EQ(choice.find("meant is what stands at "), 0U) << choice;
  EXPECT_NE(choice.find(" cm across and 16 cm high"), std::string::npos) << choice;
  for (int i = 1; i < 46; ++i) {
    frame.id.utime += 33000;
    mapper.process(frame);
  }
  EXPECT_EQ(mapper.state().message.find("seen from "), 0U) << "when it could be read: " << mapper.state().message;
}

TEST(TakeMapper, SaysWhereItWasLostAndGoesOn) {
  const Take take = go_round(table_with({}), 0, 40, {20, 21});
  ASSERT_EQ(take.lost.size(), 1U);
  EXPECT_EQ(take.lost[0].from, 20);
  EXPECT_EQ(take.lost[0].to, 21);
  EXPECT_TRUE(take.frames[30].tracked);
  EXPECT_LT(drift_m(take, 0, 39), 0.003);
}

TEST(TakeMapper, FollowsAnObjectThatTurnsBeforeAStillCamera) {
  const Mesh table = table_with({{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, ShownScene().camera});
  const Eigen::Isometry3d T_camera_table = test_scene::camera_at(0.3, 0.6, 0.65);
  const Mesh box = test_scene::box_of({});
  TakeMapper mapper{TakeMapperSettings()};
  for (int i = 0; i < 40; ++i) {
    Mesh both = table;
    const Eigen::Matrix3f rotated =
        Eigen::AngleAxisf(-0.03F * static_cast<float>(i), Eigen::Vector3f::UnitZ()).toRotationMatrix();
    const auto offset = static_cast<std::uint32_t>(both.vertices.size());
    for (const Eigen::Vector3f& vertex : box.vertices) both.vertices.push_back(rotated * vertex);
    both.colours.insert(both.colours.end(), box.colours.begin(), box.colours.end());
    for (const auto& t : box.triangles) both.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    mapper.process(photograph(both, T_camera_table, ShownScene().camera, 1 + 33000 * i));
  }
  const Take take = mapper.finish();
  EXPECT_EQ(take.motion, Motion::kObject);
  ASSERT_TRUE(take.frames.back().tracked);
  const Eigen::Isometry3d moved = take.keyframes.front().T_camera_world.inverse() * take.pose_of(take.frames.back());
  EXPECT_NEAR(Eigen::AngleAxisd(moved.linear()).angle(), 0.03 * 39, 0.03);
  int untracked = 0;
  for (std::size_t i = 0; i < take.frames.size(); ++i) {
    const RegisteredFrame& frame = take.frames[i];
    untracked += frame.tracked ? 0 : 1;
    if (!frame.tracked) continue;
    ASSERT_GE(frame.keyframe, 0) << i;
    ASSERT_LT(frame.keyframe, static_cast<int>(take.keyframes.size())) << i;
    const Eigen::Isometry3d at = take.keyframes.front().T_camera_world.inverse() * take.pose_of(frame);
    EXPECT_NEAR(Eigen::AngleAxisd(at.linear()).angle(), 0.03 * static_cast<double>(i), 0.2) << i;
  }
  EXPECT_GE(untracked, 2) << "it turned before that was known";
  EXPECT_LT(untracked, 10);
}

/// Returns a plain round tin on a plain table; boxes painted with spots stand about it, farther away.
Mesh plain_tin_among_boxes() {
  constexpr int kSides = 60;
  constexpr float kRadius_m = 0.06F;
  Mesh mesh;
  const auto add_face = [&](const std::vector<Eigen::Vector3f>& corners, std::uint8_t shade) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
    mesh.colours.resize(mesh.vertices.size(), cv::Vec3b(shade, shade, shade));
    for (std::uint32_t i = 2; i < corners.size(); ++i) mesh.triangles.push_back({first, first + i - 1, first + i});
  };
  add_face({{-0.7F, -0.7F, 0.0F}, {0.7F, -0.7F, 0.0F}, {0.7F, 0.7F, 0.0F}, {-0.7F, 0.7F, 0.0F}}, 120);
  std::vector<Eigen::Vector3f> lid;
  for (int i = 0; i < kSides; ++i) {
    const auto rim = [&](int k, float z) {
      const auto angle = static_cast<float>(kAngle * k / kSides);
      return Eigen::Vector3f(kRadius_m * std::cos(angle), kRadius_m * std::sin(angle), z);
    };
    add_face({rim(i, 0.0F), rim(i + 1, 0.0F), rim(i + 1, 0.1F), rim(i, 0.1F)}, 180);
    lid.push_back(rim(i, 0.1F));
  }
  add_face(lid, 190);
  for (int i = 0; i < 6; ++i) {
    Mesh box;
    test_scene::add_box({0.1 + 0.01 * i, 0.08, 0.12 + 0.01 * i}, 0.0, box);
    const Eigen::Matrix3f rotated =
        Eigen::AngleAxisf(1.047F * static_cast<float>(i), Eigen::Vector3f::UnitZ()).toRotationMatrix();
    const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Eigen::Vector3f& vertex : box.vertices)
      mesh.vertices.push_back(rotated * (vertex + Eigen::Vector3f(0.55F, 0.0F, 0.0F)));
    mesh.colours.insert(mesh.colours.end(), box.colours.begin(), box.colours.end());
    for (const auto& t : box.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  return mesh;
}

/// Depth in steps, as a structured-light camera has it: its pattern moves with the camera, not with the scene.
void step_depth(RgbdFrame& frame) {
  constexpr double kStep = 0.004;  // step of 1/z, per metre
  for (int y = 0; y < frame.depth.rows; ++y) {
    for (int x = 0; x < frame.depth.cols; ++x) {
      auto& z = frame.depth.at<float>(y, x);
      if (std::isfinite(z)) z = static_cast<float>(1.0 / (kStep * std::round(1.0 / (kStep * z))));
    }
  }
}

/// Returns the mapper's rotation about the object after 70 degrees.
double degrees_gone(std::size_t min_landmarks) {
  const Mesh mesh = plain_tin_among_boxes();
  TakeMapperSettings settings;
  settings.map.min_landmarks = min_landmarks;
  TakeMapper mapper(settings);
  for (int i = 0; i <= 35; ++i) {
    const Eigen::Isometry3d T = test_scene::camera_at(0.3 + kAngle * i / 180.0, 0.5, 0.7);
    RgbdFrame frame = photograph(mesh, T, ShownScene().camera, 1 + 33000 * i);
    step_depth(frame);
    mapper.process(frame);
  }
  const Take take = mapper.finish();
  if (!take.frames.back().tracked) return 0.0;
  const Eigen::Isometry3d gone = take.pose_of(take.frames.front()).inverse() * take.pose_of(take.frames.back());
  return Eigen::AngleAxisd(gone.linear()).angle() * 360.0 / kAngle;
}

TEST(TakeMapper, CornersSayHowFarItIsRoundSomethingPlainAndRound) {
  EXPECT_NEAR(degrees_gone(12), 70.0, 1.0);
  EXPECT_GT(std::abs(degrees_gone(100000) - 70.0), 3.0) << "the scene holds a camera without corners, too";
}

TEST(TakeMapper, RefusesAFrameOfAnotherSize) {
  const Mesh table = table_with({});
  const Camera smaller = {160, 120, 145.0, 145.0, 79.5, 59.5};
  TakeMapper mapper{TakeMapperSettings()};
  mapper.process(photograph(table, ground_truth_pose(0), ShownScene().camera, 1));
  std::string line;
  try {
    mapper.process(photograph(table, ground_truth_pose(1), smaller, 33001));
  } catch (const InputError& error) {
    line = error.what();
  }
  EXPECT_EQ(line.find("frame 33001: colour 160x120 and depth 160x120, expected 320x240 as of the first frame"), 0U)
      << line;
}

TEST(TakeMapper, RefusesATakeWithoutAnObject) {
  ShownScene empty;
  empty.box.setZero();
  EXPECT_THROW(go_round(table_with(empty), 0, 50, {}), InputError);
}

}  // namespace
}  // namespace houghstream::reconstruction
