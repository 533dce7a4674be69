#include "tools/track/drake_scene.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "pipeline/base/checks.hpp"
#include "tests/expect_says.hpp"
#include "tests/pipeline/geometry/tetrahedron.hpp"
#include "tests/test_files.hpp"
#include "tools/track/world_output.hpp"

namespace houghstream::track {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSecond = 1000000;

TrackedObject object(std::int64_t number, const std::string& name, const Eigen::Vector3d& place) {
  TrackedObject out;
  out.track_id = number;
  out.class_name = name;
  out.state = TrackState::kVisible;
  out.T_world_object = Eigen::Translation3d(place) * Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  return out;
}

WorldObjects world(std::int64_t utime, const std::vector<TrackedObject>& objects) {
  WorldObjects out;
  out.frame = {"OPENNI_FRAME", utime};
  out.world = "WORLD";
  out.objects = objects;
  return out;
}

tracks::TrackModels mug_model() {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.1F, 0, 0}, {0, 0.1F, 0}, {0, 0, 0.1F}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return tracks::make_track_models({{"mug", mesh}}, {});
}

fs::path folder() {
  return fs::temp_directory_path() / "houghstream_drake_scene";
}

TEST(DrakeScene, LoadsTheMeshOfEachObjectAndDrawsItWhereItIs) {
  DrakeScene scene(folder());
  scene.set_models(mug_model());
  const DrakeScene::Messages messages =
      scene.messages(world(5 * kSecond, {object(3, "mug", {1, 2, 3}), object(7, "mug", {4, 5, 6})}));
  ASSERT_TRUE(messages.load.has_value());
  ASSERT_EQ(messages.load->num_links, 2);
  ASSERT_EQ(messages.load->link.size(), 2U);
  EXPECT_EQ(messages.load->link[1].name, "mug_7");
  ASSERT_EQ(messages.load->link[1].num_geom, 1);
  const drake_viewer_geometry_data_t& shape = messages.load->link[1].geom[0];
  EXPECT_EQ(shape.type, drake_viewer_geometry_data_t::MESH);
  EXPECT_TRUE(fs::path(shape.string_data).is_absolute() && fs::exists(shape.string_data)) << shape.string_data;
  EXPECT_EQ(shape.num_float_data, 3);
  EXPECT_EQ(shape.float_data, std::vector<float>(3, 1.0F));
  EXPECT_EQ(shape.quaternion[0], 1.0F);
  EXPECT_EQ(shape.color[3], 1.0F);
  EXPECT_EQ(messages.draw.timestamp, 5000) << "milliseconds";
  EXPECT_EQ(messages.draw.num_links, 2);
  EXPECT_EQ(messages.draw.link_name, (std::vector<std::string>{"mug_3", "mug_7"}));
  EXPECT_EQ(messages.draw.robot_num, (std::vector<std::int32_t>{0, 0}));
  EXPECT_EQ(messages.draw.position[1], (std::vector<float>{4, 5, 6}));
  EXPECT_NEAR(messages.draw.quaternion[0][0], std::sqrt(0.5), 1e-6) << "w first";
  EXPECT_NEAR(messages.draw.quaternion[0][3], std::sqrt(0.5), 1e-6);
}

TEST(DrakeScene, NamedFramesAreAxesOnTheirObject) {
  tracks::TrackModels models = mug_model();
  models.at("mug").frames.push_back({"handle", Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.0, 0.0))});
  DrakeScene scene(folder());
  scene.set_models(models);
  const auto load = scene.messages(world(0, {object(3, "mug", {1, 2, 3})})).load;
  ASSERT_EQ(load->link[0].num_geom, 4) << "the mesh, and x, y, z";
  const drake_viewer_geometry_data_t& y = load->link[0].geom[2];
  EXPECT_EQ(y.type, drake_viewer_geometry_data_t::BOX);
  EXPECT_NEAR(y.position[0], 0.1F, 1e-6F);
  EXPECT_GT(y.position[1], 0.0F);
  EXPECT_GT(y.float_data[1], 5.0F * y.float_data[0]);
  EXPECT_EQ(y.color[0], 0.0F);
  EXPECT_EQ(y.color[1], 1.0F);
}

TEST(DrakeScene, AFrameOfWhatTurnsMovesAsAPointOfIt) {
  TrackedObject mug = object(3, "mug", {1, 2, 3});
  mug.velocity << 0.1, 0, 0, 0, 0, 2;  // m/s, and rad/s about z
  const PlacedObjectFrame handle{"handle", Eigen::Translation3d(1.05, 2, 3) * Eigen::Isometry3d::Identity()};
  const pose_t pose = frame_pose_message(mug, handle, 5);
  EXPECT_EQ(pose.utime, 5);
  EXPECT_EQ(pose.pos[0], 1.05);
  EXPECT_NEAR(pose.vel[0], 0.1, 1e-12);
  EXPECT_NEAR(pose.vel[1], 0.1, 1e-12) << "2 rad/s at 5 cm";
  EXPECT_EQ(pose.rotation_rate[2], 2.0);
}

TEST(DrakeScene, LoadsAgainWhenTheObjectsChangeAndEveryTenSeconds) {
  DrakeScene scene(folder());
  scene.set_models(mug_model());
  const TrackedObject mug = object(3, "mug", {1, 2, 3});
  EXPECT_TRUE(scene.messages(world(0, {})).load.has_value()) << "what a viewer showed before is no more";
  EXPECT_FALSE(scene.messages(world(kSecond, {})).load.has_value());
  EXPECT_TRUE(scene.messages(world(2 * kSecond, {mug})).load.has_value());
  EXPECT_FALSE(scene.messages(world(3 * kSecond, {mug})).load.has_value());
  EXPECT_FALSE(scene.messages(world(11 * kSecond, {mug})).load.has_value());
  EXPECT_TRUE(scene.messages(world(12 * kSecond, {mug})).load.has_value());
  EXPECT_TRUE(scene.messages(world(kSecond, {mug})).load.has_value()) << "a log that begins again";
  scene.set_models(mug_model());
  EXPECT_TRUE(scene.messages(world(2 * kSecond, {mug})).load.has_value()) << "it may look different now";
}

TEST(DrakeScene, WhatIsGoneIsNeitherLoadedNorDrawnAndWhatIsHiddenIsBoth) {
  DrakeScene scene(folder());
  scene.set_models(mug_model());
  TrackedObject gone = object(3, "mug", {1, 2, 3});
  gone.state = TrackState::kGone;
  TrackedObject hidden = object(4, "mug", {1, 2, 3});
  hidden.state = TrackState::kHidden;
  const DrakeScene::Messages messages = scene.messages(world(0, {gone, hidden}));
  ASSERT_EQ(messages.load->num_links, 1);
  EXPECT_EQ(messages.load->link[0].name, "mug_4");
  EXPECT_EQ(messages.draw.link_name, std::vector<std::string>{"mug_4"});
}

TEST(DrakeScene, AClassWithoutAMeshIsABoxWhereItIsAndSaidOnce) {
  DrakeScene scene(folder());
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  DrakeScene::Messages messages;
  for (int i = 0; i < 3; ++i) messages = scene.messages(world(20 * i * kSecond, {object(3, "a::b/c", {1, 2, 3})}));
  const std::string said = testing::internal::GetCapturedStderr() + testing::internal::GetCapturedStdout();
  EXPECT_NE(said.find("a box in place of a::b/c"), std::string::npos) << said;
  EXPECT_EQ(said.find("a box"), said.rfind("a box")) << said;
  ASSERT_TRUE(messages.load.has_value());
  const drake_viewer_geometry_data_t& shape = messages.load->link[0].geom[0];
  EXPECT_EQ(shape.type, drake_viewer_geometry_data_t::BOX);
  EXPECT_EQ(shape.float_data, std::vector<float>(3, 0.05F));
  EXPECT_EQ(messages.load->link[0].name, "a__b_c_3") << "viewers make folders of :: and /";
  EXPECT_EQ(messages.draw.link_name[0], "a__b_c_3");
  EXPECT_EQ(messages.draw.position[0], (std::vector<float>{1, 2, 3})) << "not at the origin";
}

TEST(DrakeScene, AFolderThatCannotBeWrittenIsSaidAndGivesBoxes) {
  const fs::path file = fs::temp_directory_path() / "houghstream_drake_scene_file";
  std::ofstream(file) << "no folder";
  DrakeScene scene(file / "meshes");
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  scene.set_models(mug_model());
  const DrakeScene::Messages messages = scene.messages(world(0, {object(3, "mug", {1, 2, 3})}));
  const std::string said = testing::internal::GetCapturedStderr() + testing::internal::GetCapturedStdout();
  EXPECT_NE(said.find(file.string()), std::string::npos) << said;
  EXPECT_EQ(said.find("a box"), said.rfind("a box")) << said;
  EXPECT_EQ(messages.load->link[0].geom[0].type, drake_viewer_geometry_data_t::BOX);
}

TEST(PoseMessage, HoldsPoseAndVelocitiesOfTheWorld) {
  TrackedObject mug = object(3, "mug", {1, 2, 3});
  mug.velocity << 0.1, 0.2, 0.3, 0.4, 0.5, 0.6;
  const pose_t message = pose_message(mug, 17);
  EXPECT_EQ(message.utime, 17);
  EXPECT_EQ(message.pos[2], 3.0);
  EXPECT_EQ(message.vel[2], 0.3);
  EXPECT_NEAR(message.orientation[0], std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(message.orientation[3], std::sqrt(0.5), 1e-12);
  EXPECT_EQ(message.rotation_rate[0], 0.4);
  EXPECT_EQ(message.accel[1], 0.0);
}

namespace fs = std::filesystem;

/// Red where the fourth vertex is not, darker elsewhere.
Mesh red_tetrahedron() {
  Mesh mesh = tetrahedron(0.1F);
  mesh.colours = {{0, 0, 255}, {0, 0, 255}, {0, 0, 255}, {0, 0, 0}};
  compute_normals(mesh);
  return mesh;
}

fs::path empty_folder(const std::string& name) {
  fs::path folder = fs::temp_directory_path() / ("houghstream_viewer_mesh_" + name);
  fs::remove_all(folder);
  return folder;
}

std::string text_of(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(ViewerMesh, IsAnObjInMetresWithItsMaterialsBesideIt) {
  const ViewerMesh written = write_viewer_mesh(red_tetrahedron(), "my mug/2", empty_folder("obj"));
  ASSERT_TRUE(fs::path(written.file).is_absolute());
  EXPECT_EQ(fs::path(written.file).extension(), ".obj");
  EXPECT_EQ(fs::path(written.file).filename().string().substr(0, 9), "my_mug_2-") << "no blanks, no folders";
  const Mesh back = load_mesh(written.file, 1.0);
  EXPECT_EQ(back.triangles.size(), 4U);
  EXPECT_NEAR(mesh_bounds(back).max().x(), 0.1F, 1e-6F);
  const std::string obj = text_of(written.file);
  const std::string mtl = fs::path(written.file).replace_extension(".mtl").filename().string();
  EXPECT_EQ(obj.substr(0, obj.find('\n')), "mtllib " + mtl);
  const std::string materials = text_of(fs::path(written.file).replace_extension(".mtl"));
  EXPECT_NE(materials.find("Kd 1.000 0.000 0.000"), std::string::npos) << materials;
  EXPECT_NE(materials.find("Kd 0.667 0.000 0.000"), std::string::npos) << materials;
  EXPECT_NEAR(written.colour[0], 0.75F, 1e-4F);
  EXPECT_EQ(written.colour[1], 0.0F);
}

TEST(ViewerMesh, ATexturesColoursAreThoseOfItsTriangles) {
  Mesh mesh = red_tetrahedron();
  mesh.colours.clear();
  mesh.uvs.assign(4, {0.9F, 0.9F});
  mesh.texture = cv::Mat(4, 4, CV_8UC3, cv::Scalar(255, 0, 0));
  EXPECT_EQ(write_viewer_mesh(mesh, "mug", empty_folder("texture")).colour, (std::array<float, 3>{0, 0, 1}));
}

TEST(ViewerMesh, EqualMeshesAreOneFileAndOthersAnother) {
  const fs::path folder = empty_folder("equal");
  const ViewerMesh first = write_viewer_mesh(red_tetrahedron(), "mug", folder);
  const auto written = fs::last_write_time(first.file);
  EXPECT_EQ(write_viewer_mesh(red_tetrahedron(), "mug", folder).file, first.file);
  EXPECT_EQ(fs::last_write_time(first.file), written) << "not written again";
  Mesh larger = red_tetrahedron();
  larger.vertices[1].x() = 0.2F;
  EXPECT_NE(write_viewer_mesh(larger, "mug", folder).file, first.file);
  Mesh darker = red_tetrahedron();
  darker.colours[1] = {0, 0, 0};
  EXPECT_NE(write_viewer_mesh(darker, "mug", folder).file, first.file);
}

TEST(ViewerMesh, AFolderThatCannotBeMadeIsNamed) {
  const fs::path file = empty_folder("file");
  std::ofstream(file) << "no folder";
  expect_says(error_of([&] { write_viewer_mesh(red_tetrahedron(), "mug", file / "meshes"); }),
              {(file / "meshes").string()});
}

}  // namespace

}  // namespace houghstream::track
