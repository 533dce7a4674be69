#include "tools/studies/recorded/pose_agreement.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

constexpr double kDegree = M_PI / 180.0;

Eigen::Isometry3d pose(double x, double angle_deg) {
  return Eigen::Translation3d(x, 0.0, 0.7) * Eigen::AngleAxisd(angle_deg * kDegree, Eigen::Vector3d::UnitZ());
}

ComparedFrame frame(bool reliable, std::optional<PoseDifference> difference) {
  return {"frame", reliable, difference ? "valid" : "not detected", difference};
}

TEST(ComparePoses, MeasuresShiftAndTurn) {
  const PoseDifference found = compare_poses(pose(0.103, 34.0), pose(0.1, 30.0), {});
  EXPECT_NEAR(found.shift_m, 0.003, 1e-9);
  EXPECT_NEAR(found.angle_deg, 4.0, 1e-6);
  EXPECT_NEAR(compare_poses(pose(0.1, 210.0), pose(0.1, 30.0), {}).angle_deg, 180.0, 1e-5);
}

TEST(ComparePoses, ATurnThatLooksTheSameIsNoError) {
  Symmetries half_turn;
  half_turn.discrete.emplace_back(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  EXPECT_NEAR(compare_poses(pose(0.1, 213.0), pose(0.1, 30.0), half_turn).angle_deg, 3.0, 1e-5);
  EXPECT_NEAR(compare_poses(pose(0.1, 120.0), pose(0.1, 30.0), half_turn).angle_deg, 90.0, 1e-5);
  Symmetries round;
  round.continuous.push_back({Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero()});
  EXPECT_NEAR(compare_poses(pose(0.1, 120.0), pose(0.1, 30.0), round).angle_deg, 0.0, 1e-5);
}

TEST(Summarise, CountsReliableFramesAndThoseWithoutAPose) {
  const AgreementSummary found = summarise(
      {frame(true, PoseDifference{0.004, 4.0}), frame(true, PoseDifference{0.006, 1.0}),
       frame(true, PoseDifference{0.001, 6.0}), frame(true, std::nullopt), frame(false, PoseDifference{0.0, 0.0})});
  EXPECT_EQ(found.frames, 4);
  EXPECT_EQ(found.with_pose, 3);
  EXPECT_EQ(found.within_5mm_5deg, 1);
  ASSERT_TRUE(found.median.has_value());
  EXPECT_DOUBLE_EQ(found.median->shift_m, 0.004);
  EXPECT_DOUBLE_EQ(found.median->angle_deg, 4.0);
  EXPECT_FALSE(summarise({frame(true, std::nullopt)}).median.has_value());
}

TEST(ReferencePoses, AreReadInMetresAndCheckedForRotations) {
  const auto folder = fresh_folder("reference_poses");
  const auto write = [&](const std::string& text) { write_text(folder / "poses.json", text); };
  write(R"({"poses": [{"frame": "a", "R_m2c": [[0,-1,0],[1,0,0],[0,0,1]], "t_m2c_mm": [1,2,3], "reliable": true}]})");
  const std::map<std::string, ReferencePose> poses = read_reference_poses(folder / "poses.json");
  ASSERT_EQ(poses.count("a"), 1U);
  EXPECT_TRUE(poses.at("a").reliable);
  const Eigen::Vector3d moved = poses.at("a").T_camera_object * Eigen::Vector3d(1.0, 0.0, 0.0);
  EXPECT_LT((moved - Eigen::Vector3d(0.001, 1.002, 0.003)).norm(), 1e-9);
  write(R"({"poses": [{"frame": "a", "R_m2c": [[0,1,0],[1,0,0],[0,0,1]], "t_m2c_mm": [1,2,3], "reliable": true}]})");
  EXPECT_THROW(read_reference_poses(folder / "poses.json"), InputError);  // a mirror
  write(R"({"poses": [{"frame": "a", "t_m2c_mm": [1,2,3], "reliable": true}]})");
  EXPECT_THROW(read_reference_poses(folder / "poses.json"), InputError);
  EXPECT_THROW(read_reference_poses(folder / "missing.json"), InputError);
}

}  // namespace
}  // namespace houghstream
