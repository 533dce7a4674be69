#include "pose/tracks/camera_extrinsics.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "tests/test_files.hpp"

namespace houghstream::tracks {
namespace {

Eigen::Isometry3d at(double x, double angle_rad = 0.0) {
  return Eigen::Translation3d(x, 0, 0) * Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ());
}

std::filesystem::path written(const std::string& name, const std::string& text) {
  std::filesystem::path file = fresh_folder("camera_places") / name;
  std::ofstream(file) << text;
  return file;
}

TEST(CameraExtrinsics, AMovingCameraIsInterpolatedAtTheFramesOwnTime) {
  CameraExtrinsics extrinsics;
  extrinsics.add_transform("LEFT", 1000000, at(0.0, 0.0));
  extrinsics.add_transform("LEFT", 1100000, at(1.0, 0.4));
  const CameraPose place = extrinsics.interpolate("LEFT", 1025000);
  ASSERT_TRUE(place.T_world_camera.has_value());
  EXPECT_TRUE(place.T_world_camera->isApprox(at(0.25, 0.1), 1e-9));
  EXPECT_TRUE(extrinsics.interpolate("LEFT", 1100000).T_world_camera.has_value());
}

TEST(CameraExtrinsics, WhatIsMissingLateOrFarApartIsNoPlaceAndSaysWhy) {
  CameraExtrinsics extrinsics;
  EXPECT_TRUE(extrinsics.interpolate("LEFT", 1000000).may_come);
  extrinsics.add_transform("LEFT", 1000000, at(0.0));
  extrinsics.add_transform("LEFT", 1200000, at(0.1));
  const CameraPose late = extrinsics.interpolate("LEFT", 1300000);
  EXPECT_FALSE(late.T_world_camera.has_value());
  EXPECT_TRUE(late.may_come);
  EXPECT_EQ(late.reason, "the last transform of LEFT is 0.100 s older");
  const CameraPose before = extrinsics.interpolate("LEFT", 500000);
  EXPECT_FALSE(before.T_world_camera.has_value() || before.may_come);
  EXPECT_NE(before.reason.find("0.500 s later: do the clocks agree?"), std::string::npos) << before.reason;
  extrinsics.add_transform("LEFT", 2200000, at(0.3));
  EXPECT_EQ(extrinsics.interpolate("LEFT", 1700000).reason,
            "the transforms of LEFT about it are 1.000 s apart, expected at most 0.5 s");
}

TEST(CameraExtrinsics, ACameraThatStandsNeedsFewTransformsAFixedOneNone) {
  CameraExtrinsics extrinsics;
  extrinsics.add_transform("LEFT", 1000000, at(0.2));
  extrinsics.add_transform("LEFT", 9000000, at(0.2));
  EXPECT_TRUE(extrinsics.interpolate("LEFT", 5000000).T_world_camera.has_value());
  EXPECT_TRUE(extrinsics.interpolate("LEFT", 9900000).T_world_camera.has_value());
  extrinsics.set_static("RIGHT", at(0.7));
  EXPECT_TRUE(extrinsics.interpolate("RIGHT", 1).T_world_camera->isApprox(at(0.7)));
}

TEST(CameraExtrinsics, TimesMayBeAny) {
  constexpr std::int64_t kFirst = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  CameraExtrinsics extrinsics;
  extrinsics.add_transform("MOVING", kFirst, at(0.0));
  extrinsics.add_transform("MOVING", kLast, at(0.1));
  EXPECT_NE(extrinsics.interpolate("MOVING", 0).reason.find("s apart, expected at most 0.5 s"), std::string::npos);
  extrinsics.add_transform("STANDING", kFirst, at(0.2));
  extrinsics.add_transform("STANDING", kLast, at(0.2));
  EXPECT_TRUE(extrinsics.interpolate("STANDING", 0).T_world_camera->isApprox(at(0.2)));
  extrinsics.add_transform("LATER", kLast, at(0.0));
  EXPECT_NE(extrinsics.interpolate("LATER", kFirst).reason.find("is 9223372036854.775 s later"), std::string::npos);
  extrinsics.add_transform("EARLIER", kFirst, at(0.0));
  EXPECT_NE(extrinsics.interpolate("EARLIER", kLast).reason.find("is 9223372036854.775 s older"), std::string::npos);
}

TEST(CameraExtrinsics, ACameraTooManyIsRefusedAndTheOthersGoOn) {
  CameraExtrinsics extrinsics;
  for (std::size_t i = 0; i < CameraExtrinsics::kMaxMoving; ++i)
    extrinsics.add_transform("CAMERA_" + std::to_string(i), 1000000, at(0));
  EXPECT_EQ(error_of([&] { extrinsics.add_transform("FORGED", 1000000, at(0)); }),
            "transforms of more than 256 cameras, expected at most that many");
  extrinsics.add_transform("CAMERA_0", 1100000, at(1.0));
  EXPECT_TRUE(extrinsics.interpolate("CAMERA_0", 1050000).T_world_camera->isApprox(at(0.5), 1e-9));
  EXPECT_EQ(extrinsics.interpolate("FORGED", 1000000).reason, "no transform of FORGED has come");
}

TEST(CameraExtrinsics, OursAreReadWithTheirParents) {
  const auto places = read_camera_extrinsics(written("ours.yaml",
                                                     "cameras:\n"
                                                     "  LEFT: {translation: [1.0, 0, 0.5], rotation: [1, 0, 0, 0]}\n"
                                                     "  RIGHT:\n"
                                                     "    parent: LEFT\n"
                                                     "    translation: [0.0, 2, 0]\n"
                                                     "    rotation: [0.7071, 0, 0, 0.7071]\n"));
  ASSERT_EQ(places.size(), 2U);
  EXPECT_TRUE(places.at("RIGHT").translation().isApprox(Eigen::Vector3d(1.0, 2.0, 0.5)));
  EXPECT_TRUE((places.at("RIGHT") * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(1.0, 3.0, 0.5), 1e-6));
}

TEST(CameraExtrinsics, StaticTransformsAreReadAsRosTexturesThem) {
  const auto places = read_camera_extrinsics(written("ros.yaml",
                                                     "transforms:\n"
                                                     "- header:\n"
                                                     "    stamp:\n"
                                                     "      sec: 1700000000\n"
                                                     "      nanosec: 5\n"
                                                     "    frame_id: map\n"
                                                     "  child_frame_id: stand\n"
                                                     "  transform:\n"
                                                     "    translation:\n"
                                                     "      x: 1.0\n"
                                                     "      y: 0.0\n"
                                                     "      z: 0.0\n"
                                                     "    rotation:\n"
                                                     "      x: 0.0\n"
                                                     "      y: 0.0\n"
                                                     "      z: 0.0\n"
                                                     "      w: 1.0\n"
                                                     "- header:\n"
                                                     "    frame_id: stand\n"
                                                     "  child_frame_id: LEFT\n"
                                                     "  transform:\n"
                                                     "    translation: {x: 0.0, y: 0.5, z: 0.0}\n"
                                                     "    rotation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}\n"
                                                     "---\n"));
  EXPECT_TRUE(places.at("LEFT").translation().isApprox(Eigen::Vector3d(1.0, 0.5, 0.0)));
}

TEST(CameraExtrinsics, BadFilesAreOneLine) {
  EXPECT_NE(error_of([] { read_camera_extrinsics("/nowhere.yaml"); }).find("/nowhere.yaml: missing or unreadable"),
            std::string::npos);
  const auto loop = written("loop.yaml",
                            "cameras:\n"
                            "  A: {parent: B, translation: [0, 0, 0], rotation: [1, 0, 0, 0]}\n"
                            "  B: {parent: A, translation: [0, 0, 0], rotation: [1, 0, 0, 0]}\n");
  EXPECT_NE(error_of([&] { read_camera_extrinsics(loop); }).find("camera A: its parents go round in a loop"),
            std::string::npos);
  const auto bent = written("bent.yaml", "cameras:\n  A: {translation: [0, 0, 0], rotation: [1, 1, 0, 0]}\n");
  EXPECT_NE(error_of([&] { read_camera_extrinsics(bent); }).find("camera A: quaternion of length 1.414, expected 1"),
            std::string::npos);
  const auto empty = written("empty.yaml", "other: 1\n");
  EXPECT_NE(error_of([&] { read_camera_extrinsics(empty); }).find("neither 'cameras:' nor 'transforms:'"),
            std::string::npos);
}

// Entries with these would be ignored silently.
TEST(CameraExtrinsics, NamesThatNobodyReadsOrThatStandTwiceAreRefused) {
  const std::string place = "translation: [0, 0, 0], rotation: [1, 0, 0, 0]}\n";
  const auto error_with = [&](const std::string& text) {
    const auto file = written("names.yaml", text);
    return error_of([&] { read_camera_extrinsics(file); });
  };
  EXPECT_EQ(error_with("cameras:\n  A: {parent: world, " + place + "  B: {parent: A, " + place), "");
  EXPECT_NE(error_with("cameras:\n  A: {parenu: B, " + place + "  B: {" + place)
                .find("camera A: 'parenu', expected one of parent, rotation, translation"),
            std::string::npos);
  EXPECT_NE(error_with("cameras:\n  A: {" + place + "B: {" + place).find("'B', expected one of cameras, transforms"),
            std::string::npos);
  EXPECT_NE(error_with("cameras:\n  A: {" + place + "  A: {" + place).find("duplicate camera A"), std::string::npos);
  const std::string message =
      "transforms:\n- header:\n    frame_id: map\n  child_frame_id: A\n  transform:\n"
      "    translation: {x: 0.0, y: 0.5, z: 0.0}\n    rotation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}\n---\n";
  EXPECT_EQ(error_with(message), "");
  EXPECT_NE(error_with(message + message).find("duplicate 'transforms'"), std::string::npos);
}

TEST(CameraExtrinsics, WhatIsNoNumberOrLiesTooDeepIsRefused) {
  const auto words = written("words.yaml", "cameras:\n  A: {translation: [a, 0, 0], rotation: [1, 0, 0, 0]}\n");
  EXPECT_NE(error_of([&] { read_camera_extrinsics(words); }).find("camera A: translation: expected 3 numbers"),
            std::string::npos);
  const auto far_away = written("far.yaml", "cameras:\n  A: {translation: [1e300, 0, 0], rotation: [1, 0, 0, 0]}\n");
  EXPECT_NE(error_of([&] { read_camera_extrinsics(far_away); }).find("expected metres within"), std::string::npos);
  const auto scalar = written("scalar.yaml", "cameras:\n  A: 5\n");
  EXPECT_NE(error_of([&] { read_camera_extrinsics(scalar); }), "");
  const auto nameless = written("nameless.yaml", "cameras: [1, 2]\n");
  EXPECT_NE(error_of([&] { read_camera_extrinsics(nameless); }).find("with names"), std::string::npos);
  std::string deep = "cameras:\n";
  for (int i = 0; i < 5000; ++i) deep += " [\n";
  const auto brackets = written("deep.yaml", deep);
  EXPECT_NE(error_of([&] { read_camera_extrinsics(brackets); }).find("no YAML"), std::string::npos);
}

TEST(CameraExtrinsics, TheOptionIsParsed) {
  const auto [name, T] = parse_camera_pose("LEFT=1,2,3,1,0,0,0");
  EXPECT_EQ(name, "LEFT");
  EXPECT_TRUE(T.translation().isApprox(Eigen::Vector3d(1, 2, 3)));
  EXPECT_NE(error_of([] { parse_camera_pose("LEFT=1,2,3"); }).find("3 numbers, expected CHANNEL=x,y,z,qw,qx,qy,qz"),
            std::string::npos);
  EXPECT_NE(error_of([] { parse_camera_pose("LEFT=1,2,3,a,0,0,0"); }).find("'a' is no number"), std::string::npos);
  EXPECT_NE(error_of([] { parse_camera_pose("1,2,3"); }).find("expected CHANNEL="), std::string::npos);
}

TEST(CameraExtrinsics, ACameraHasOnePlaceOfTheCommandLine) {
  std::map<std::string, Eigen::Isometry3d> places = {{"LEFT", at(0.2)}};
  add_camera_pose("RIGHT=1,2,3,1,0,0,0", places);
  EXPECT_EQ(places.at("RIGHT").translation().y(), 2.0);
  for (const std::string camera : {"LEFT", "RIGHT"}) {
    const std::string error = error_of([&] { add_camera_pose(camera + "=4,5,6,1,0,0,0", places); });
    EXPECT_NE(error.find(camera + " has a place already"), std::string::npos) << error;
  }
  EXPECT_EQ(places.at("RIGHT").translation().y(), 2.0);
}

}  // namespace
}  // namespace houghstream::tracks
