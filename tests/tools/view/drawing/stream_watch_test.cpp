#include "tools/view/drawing/stream_watch.hpp"

#include <gtest/gtest.h>

namespace houghstream::view {
namespace {

ProcessState heard(const std::string& name, std::int64_t time_us) {
  ProcessState process;
  process.name = name;
  process.heard_us = time_us;
  return process;
}

TEST(StreamWatch, RateIsThatOfTheLastTwoSeconds) {
  StreamWatch watch;
  EXPECT_EQ(watch.state(0).frames_hz, 0.0);
  for (std::int64_t i = 0; i < 100; ++i) watch.note_frame(i * 1'000'000);  // once a second
  for (std::int64_t i = 0; i < 90; ++i) watch.note_frame(100'000'000 + i * 33'333);
  EXPECT_NEAR(watch.state(103'000'000).frames_hz, 30.0, 0.5);
  EXPECT_EQ(watch.state(110'000'000).frames_hz, 0.0);  // nothing comes any more
}

TEST(StreamWatch, ProcessesAreShownByNameAndHaveEndedWhenTheyFallSilent) {
  StreamWatch watch;
  watch.note_process(heard("hs-pose", 1'000'000));
  watch.note_process(heard("hs-detect", 2'000'000));
  watch.note_process(heard("hs-detect", 3'000'000));
  const StreamState both = watch.state(4'000'000);
  ASSERT_EQ(both.processes.size(), 2U);
  EXPECT_EQ(both.processes[0].name, "hs-detect");
  const StreamState later = watch.state(7'000'000);
  ASSERT_EQ(later.processes.size(), 2U);
  EXPECT_EQ(later.processes[0].heard_us, 3'000'000);
  EXPECT_FALSE(later.processes[0].ended);
  EXPECT_EQ(later.processes[1].name, "hs-pose");
  EXPECT_TRUE(later.processes[1].ended);
  EXPECT_EQ(watch.state(62'000'000).processes.size(), 1U) << "an ended process is listed for a minute";
}

TEST(StreamWatch, AProcessThatRunsAgainReplacesTheOneThatEnded) {
  StreamWatch watch;
  watch.note_process(heard("hs-pose", 1'000'000));
  ProcessState again = heard("hs-pose", 8'000'000);
  again.pid = 17;
  watch.note_process(again);
  const StreamState state = watch.state(9'000'000);
  ASSERT_EQ(state.processes.size(), 1U);
  EXPECT_EQ(state.processes[0].pid, 17);
}

TEST(StreamWatch, BoxesThatComeJustBeforeTheirWorldAreOfIt) {
  StreamWatch watch;
  WorldObjects world;
  world.frame = {"CAMERA", 7};
  ObjectPlacements placed;
  placed.frame = world.frame;
  placed.world_number = world.world_number;
  placed.objects.resize(1);
  placed.objects[0].track_id = 9;
  watch.note_placed(placed);
  EXPECT_FALSE(watch.state(1'000'000).world.has_value());
  watch.note_world(world, 1'000'000);
  EXPECT_EQ(watch.state(1'000'000).world->boxes.count(9), 1U);
}

TEST(StreamWatch, ATeachingIsShownUntilItFallsSilent) {
  StreamWatch watch;
  EXPECT_FALSE(watch.state(0).teaching.has_value());
  Teaching mug;
  mug.name = "mug";
  watch.note_teaching(mug, 1'000'000);
  ASSERT_TRUE(watch.state(5'000'000).teaching.has_value());
  EXPECT_EQ(watch.state(5'000'000).teaching->name, "mug");
  EXPECT_FALSE(watch.state(7'000'000).teaching.has_value());
}

TEST(StreamWatch, TwoProcessesOfOneNameAreTwo) {
  StreamWatch watch;
  ProcessState other = heard("hs-detect", 2'000'000);
  other.pid = 17;
  watch.note_process(heard("hs-detect", 1'000'000));
  watch.note_process(other);
  EXPECT_EQ(watch.state(3'000'000).processes.size(), 2U);
}

TEST(StreamWatch, ACamerasColoursAreShownUntilNobodyTellsOfThem) {
  StreamWatch watch;
  CameraChroma colours;
  colours.frame = {"LEFT", 1};
  ChromaPair& pair = colours.objects.emplace_back();
  pair.class_name = "bowl";
  pair.model = {30.0, 10.0};
  pair.measured = {20.0, 20.0};
  pair.lightness = 60.0;
  pair.probability = 0.9;
  watch.note_colours(colours, 1'000'000);
  const StreamState state = watch.state(2'000'000);
  ASSERT_EQ(state.colours.count("LEFT"), 1U);
  EXPECT_GT(state.colours.at("LEFT").white().y(), 2.0);
  EXPECT_TRUE(watch.state(7'000'000).colours.empty());
}

TEST(SelectedCamera, TheFirstIsShownUntilAnotherIsAskedFor) {
  SelectedCamera cameras;
  EXPECT_TRUE(cameras.is_shown("ANY"));
  cameras.next();
  cameras.note("LEFT");
  cameras.note("RIGHT");
  cameras.note("ABOVE");
  EXPECT_TRUE(cameras.is_shown("LEFT"));
  EXPECT_FALSE(cameras.is_shown("RIGHT"));
  cameras.next();
  EXPECT_TRUE(cameras.is_shown("RIGHT"));
  cameras.next();
  EXPECT_TRUE(cameras.is_shown("ABOVE"));
  EXPECT_EQ(cameras.heard(), (std::vector<std::string>{"ABOVE", "LEFT", "RIGHT"}));
}

}  // namespace
}  // namespace houghstream::view
