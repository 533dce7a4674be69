#include "tools/view/http/page_json.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tests/pipeline/test_frame.hpp"

namespace houghstream::view {
namespace {

using nlohmann::json;

ViewedFrame viewed_frame() {
  ViewedFrame viewed;
  viewed.frame = make_test_frame(42);
  viewed.frame.id.channel = "LEFT";
  viewed.detections.frame = viewed.frame.id;
  viewed.detections.stages = {{"detect.leaves", 1500}};
  viewed.detections.detections.resize(2);
  viewed.detections.detections[0].class_name = "bowl";
  viewed.detections.detections[0].class_id = 1;
  viewed.detections.detections[0].score = 0.75F;
  viewed.detections.detections[0].centre_camera = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  viewed.detections.detections[1].class_name = "mug \xff<b>";
  viewed.detect_latency_ms = 12.0;
  return viewed;
}

void add_poses(ViewedFrame& viewed) {
  viewed.poses = ObjectPoses{viewed.frame.id, {}, {{"pose.icp", 2500}}};
  viewed.poses->poses.resize(2);
  viewed.poses->poses[0].detection_index = 0;
  viewed.poses->poses[0].status = PoseStatus::kValid;
  viewed.poses->poses[0].quality = 0.25F;
  viewed.poses->poses[0].shape_quality = 0.75F;
  viewed.poses->poses[0].T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.2, 0.9));
  viewed.poses->poses[1].detection_index = 1;
  viewed.poses->poses[1].status = PoseStatus::kRejectedByDepth;
  viewed.poses->poses[1].residual = std::numeric_limits<float>::quiet_NaN();
}

TEST(PageJson, AFrameTellsItsObjectsWithTheirPoses) {
  ViewedFrame viewed = viewed_frame();
  add_poses(viewed);
  const json told = json::parse(frame_json(viewed, 17.0, std::nullopt));
  EXPECT_EQ(told["channel"], "LEFT");
  EXPECT_EQ(told["utime"], 42);
  EXPECT_EQ(told["age_ms"], 17.0);
  EXPECT_EQ(told["detect_ms"], 12.0);
  EXPECT_TRUE(told["pose_ms"].is_null());
  EXPECT_EQ(told["stages"][0]["name"], "pose.icp");
  EXPECT_EQ(told["stages"][0]["ms"], 2.5);
  const json& bowl = told["objects"][0];
  EXPECT_EQ(bowl["score"], 0.75);
  EXPECT_TRUE(bowl["centre"][0].is_null());
  EXPECT_EQ(bowl["pose"]["position"], json({0.1, 0.2, 0.9}));
  EXPECT_EQ(bowl["pose"]["quaternion"], json({1.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(bowl["pose"]["quality"], 0.25);
  EXPECT_EQ(bowl["pose"]["shape_quality"], 0.75);
  EXPECT_EQ(bowl["why"], "");
}

TEST(PageJson, AWithheldPoseSaysWhyAndAnOddNameIsStillText) {
  ViewedFrame viewed = viewed_frame();
  add_poses(viewed);
  const json mug = json::parse(frame_json(viewed, 0.0, std::nullopt))["objects"][1];
  EXPECT_TRUE(mug["pose"]["position"].is_null());
  EXPECT_TRUE(mug["pose"]["residual"].is_null());
  EXPECT_NE(mug["why"].get<std::string>().find("contradicts the measured depth"), std::string::npos);
  EXPECT_NE(mug["name"].get<std::string>().find("<b>"), std::string::npos);
  EXPECT_NE(json::parse(frame_json(viewed_frame(), 0.0, std::nullopt))["objects"][0]["why"], "");  // hs-pose is silent
}

TEST(PageJson, EveryReasonHasWordsOfItsOwn) {
  std::set<std::string> words;
  for (int status = 2; status <= 10; ++status) {
    ObjectPose pose;
    pose.status = static_cast<PoseStatus>(status);
    EXPECT_GT(why_no_pose(&pose).size(), 20U) << status;
    words.insert(why_no_pose(&pose));
  }
  EXPECT_EQ(words.size(), 9U);
}

TEST(PageJson, TheStreamTellsRatesLossesAndWhatIsShown) {
  StreamView stream;
  stream.state.frames_hz = 30.0;
  ProcessState& pose = stream.state.processes.emplace_back();
  pose.name = "hs-pose";
  pose.pid = 7;
  pose.rate_hz = 9.5F;
  pose.skipped = 3;
  pose.lost = -1;
  stream.frames_lost = 4;
  stream.cameras = {"LEFT", "RIGHT"};
  FrameViewSettings settings;
  settings.paused = true;
  settings.min_score = 0.5F;
  const json told = json::parse(stream_json(stream, settings));
  EXPECT_EQ(told["frames_hz"], 30.0);
  EXPECT_EQ(told["lost"], 4);
  EXPECT_EQ(told["cameras"].size(), 2U);
  EXPECT_EQ(told["processes"][0]["hz"], 9.5);
  EXPECT_TRUE(told["processes"][0]["lost"].is_null());
  EXPECT_EQ(told["processes"][0]["ended"], false);
  stream.state.processes[0].ended = true;
  const json ended = json::parse(stream_json(stream, settings))["processes"][0];
  EXPECT_EQ(ended["ended"], true);
  EXPECT_TRUE(ended["hz"].is_null()) << "a process that has ended has no rate";
  EXPECT_EQ(told["paused"], true);
  EXPECT_EQ(told["min_score"], 0.5);
  EXPECT_TRUE(told["teaching"].is_null());
  EXPECT_TRUE(told["world"].is_null());
  EXPECT_EQ(told["show_world"], false);
  EXPECT_TRUE(told["colours"].empty());
  stream.state.colours["LEFT"] = ChromaMap();
  EXPECT_EQ(json::parse(stream_json(stream, settings))["colours"]["LEFT"]["saturation"], 1.0);
  stream.frames_lost = -1;
  EXPECT_TRUE(json::parse(stream_json(stream, settings))["lost"].is_null());
}

TEST(PageJson, TheWorldIsToldWithItsObjects) {
  TrackedObject mug;
  mug.track_id = 3;
  mug.class_name = "mug";
  mug.state = TrackState::kHidden;
  mug.probability = 0.75F;
  mug.T_world_object = Eigen::Translation3d(1, 2, 3);
  mug.reason = "occluded by a nearer surface";
  TrackedObject moved = mug;
  moved.moving = true;
  moved.velocity << 0.3, 0.4, 0.0, 0.0, 0.0, 0.0;
  WorldObjects world;
  world.frame = {"LEFT", 6};
  world.world = "WORLD";
  world.objects = {mug, moved};
  StreamView stream;
  stream.state.world.emplace().add(world);
  world.frame.channel = "RIGHT";
  stream.state.world->add(world);
  const json told = json::parse(stream_json(stream, {}))["world"];
  EXPECT_EQ(told["name"], "WORLD");
  EXPECT_EQ(told["cameras"], 2);
  ASSERT_EQ(told["objects"].size(), 2U);
  EXPECT_EQ(told["objects"][0]["number"], 3);
  EXPECT_EQ(told["objects"][0]["state"], to_string(TrackState::kHidden));
  EXPECT_EQ(told["objects"][0]["position"], json::parse("[1.0, 2.0, 3.0]"));
  EXPECT_EQ(told["objects"][0]["reason"], "occluded by a nearer surface");
  EXPECT_TRUE(told["objects"][0]["speed"].is_null());
  EXPECT_NEAR(told["objects"][1]["speed"].get<double>(), 0.5, 1e-9);
}

TEST(PageJson, AFrameHoldsTheWorldWithCamerasPosesAndBoxes) {
  TrackedObject mug;
  mug.track_id = 3;
  mug.class_name = "mug";
  mug.state = TrackState::kVisible;
  mug.T_world_object = Eigen::Translation3d(1, 2, 3);
  TrackedObject gone = mug;
  gone.track_id = 4;
  gone.state = TrackState::kGone;
  TrackedObject plain = mug;
  plain.track_id = 5;
  WorldObjects world;
  world.frame = {"LEFT", 6};
  world.world = "WORLD";
  world.T_world_camera = Eigen::Translation3d(0, -1, 0.5);
  world.objects = {mug, gone, plain};
  ObjectPlacement box;
  box.track_id = 3;
  box.T_world_box = Eigen::Translation3d(1, 2, 3.05);
  box.box_size = {0.08, 0.09, 0.1};
  std::optional<WorldState> state;
  EXPECT_TRUE(json::parse(frame_json(viewed_frame(), 0.0, state))["world"].is_null());
  state.emplace().add(world);
  state->add(ObjectPlacements{world.frame, world.world, world.world_number, {box}});
  const json told = json::parse(frame_json(viewed_frame(), 0.0, state));
  EXPECT_GT(told["camera"]["fx"], 0.0);
  const json& scene = told["world"];
  EXPECT_EQ(scene["cameras"][0]["name"], "LEFT");
  EXPECT_EQ(scene["cameras"][0]["position"], json({0.0, -1.0, 0.5}));
  ASSERT_EQ(scene["objects"].size(), 2U) << "one is gone";
  EXPECT_EQ(scene["objects"][0]["position"], json({1.0, 2.0, 3.0}));
  EXPECT_EQ(scene["objects"][0]["box"]["position"], json({1.0, 2.0, 3.05}));
  EXPECT_EQ(scene["objects"][0]["box"]["size"], json({0.08, 0.09, 0.1}));
  EXPECT_EQ(scene["objects"][0]["box"]["quaternion"], json({1.0, 0.0, 0.0, 0.0}));
  EXPECT_TRUE(scene["objects"][1]["box"].is_null()) << "no model of it is known";
}

}  // namespace
}  // namespace houghstream::view
