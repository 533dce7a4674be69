#include "tools/teach/practice.hpp"

#include <gtest/gtest.h>

#include "tests/test_files.hpp"

namespace houghstream::teach {
namespace {

PractisedObject object_of(int id, const std::string& name) {
  PractisedObject object;
  object.name = name;
  object.in_room.id = id;
  return object;
}

world::SceneFrame frame_of(const std::vector<int>& ids) {
  world::SceneFrame frame;
  for (const int id : ids) {
    frame.objects.emplace_back();
    frame.objects.back().object_id = id;
  }
  return frame;
}

TEST(Practice, NewObjectsThatNoFrameShowsAreNamed) {
  const std::vector<PractisedObject> objects = {object_of(1, "old"), object_of(2, "mug"), object_of(4, "wardrobe")};
  const std::vector<world::SceneFrame> frames = {frame_of({}), frame_of({2}), frame_of({2, 3})};
  EXPECT_EQ(never_seen(frames, objects, {2, 4}), std::vector<std::string>{"wardrobe"});
  EXPECT_TRUE(never_seen(frames, objects, {2}).empty());
  EXPECT_EQ(never_seen({}, objects, {1, 2}), (std::vector<std::string>{"old", "mug"}));
}

TEST(Practice, MoreRoomsThanMemoryHoldsAreRefused) {
  PracticeSettings settings;
  settings.rooms = PracticeSettings::kMostRooms + 1;
  Forest forest;
  EXPECT_EQ(error_of([&] { practise({}, {}, settings, forest); }),
            "501 practice rooms, expected at most 500: all are in memory");
}

}  // namespace
}  // namespace houghstream::teach
