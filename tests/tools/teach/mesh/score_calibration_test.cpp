#include "tools/teach/mesh/score_calibration.hpp"

#include <gtest/gtest.h>

#include "tests/test_files.hpp"

namespace houghstream::teach {
namespace {

CalibrationObject object_of(int id, const std::string& name) {
  CalibrationObject object;
  object.name = name;
  object.in_scene.id = id;
  return object;
}

world::RenderedFrame frame_of(const std::vector<int>& ids) {
  world::RenderedFrame frame;
  for (const int id : ids) {
    frame.objects.emplace_back();
    frame.objects.back().object_id = id;
  }
  return frame;
}

TEST(Calibration, NewObjectsThatNoFrameShowsAreNamed) {
  const std::vector<CalibrationObject> objects = {object_of(1, "old"), object_of(2, "mug"), object_of(4, "wardrobe")};
  const std::vector<world::RenderedFrame> frames = {frame_of({}), frame_of({2}), frame_of({2, 3})};
  EXPECT_EQ(unobserved_objects(frames, objects, {2, 4}), std::vector<std::string>{"wardrobe"});
  EXPECT_TRUE(unobserved_objects(frames, objects, {2}).empty());
  EXPECT_EQ(unobserved_objects({}, objects, {1, 2}), (std::vector<std::string>{"old", "mug"}));
}

TEST(Calibration, MoreRoomsThanMemoryHoldsAreRefused) {
  CalibrationSettings settings;
  settings.scenes = CalibrationSettings::kMaxScenes + 1;
  Forest forest;
  EXPECT_EQ(error_of([&] { calibrate_on_scenes({}, {}, settings, forest); }),
            "501 practice rooms, expected at most 500: all are in memory");
}

}  // namespace
}  // namespace houghstream::teach
