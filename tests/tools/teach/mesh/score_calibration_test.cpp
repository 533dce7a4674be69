#include "tools/teach/mesh/score_calibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>

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
  std::vector<Forest> groups(1);
  EXPECT_EQ(error_of([&] { calibrate_on_scenes({}, {}, settings, groups); }),
            "501 practice rooms, expected at most 500: all are in memory");
}

std::vector<int> ids_with_distractors(int members, int distractors) {
  std::vector<world::CalibrationSceneObject> objects;
  std::set<int> group;
  for (int id = 1; id <= members + distractors; ++id) {
    objects.emplace_back();
    objects.back().id = id;
    if (id <= members) group.insert(id);
  }
  std::vector<int> ids;
  for (const world::CalibrationSceneObject& object : interleave_distractors(objects, group)) ids.push_back(object.id);
  return ids;
}

TEST(Calibration, EachStrangerStandsBesideMembersOfTheGroup) {
  EXPECT_EQ(ids_with_distractors(2, 0), (std::vector<int>{1, 2}));
  EXPECT_EQ(ids_with_distractors(1, 8), (std::vector<int>{1, 2, 3, 4, 5, 1, 6, 7, 8, 9}));
  EXPECT_EQ(ids_with_distractors(3, 3), (std::vector<int>{1, 4, 2, 5, 3, 6}));
  constexpr int kOfARoom = 7;
  for (const int members : {4, 6, 7}) {
    const std::vector<int> ids = ids_with_distractors(members, 53);
    for (int id = members + 1; id <= members + 53; ++id)
      EXPECT_EQ(std::count(ids.begin(), ids.end(), id), 1) << "stranger " << id;
    for (std::size_t first = 0; first < ids.size(); ++first) {
      int in_room = 0;
      std::set<int> different;
      for (std::size_t i = 0; i < kOfARoom; ++i) {
        const int id = ids[(first + i) % ids.size()];
        in_room += id <= members ? 1 : 0;
        if (id <= members) different.insert(id);
      }
      EXPECT_EQ(static_cast<int>(different.size()), in_room) << "none twice";
      EXPECT_GE(in_room, 1);
    }
  }
}

}  // namespace
}  // namespace houghstream::teach
