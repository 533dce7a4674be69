#include "tools/studies/household/household_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/datasets/bop_writer.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"
#include "tests/tools/teach/shapes.hpp"

namespace houghstream::household {
namespace {

namespace fs = std::filesystem;

SceneSettings five_to_nine() {
  SceneSettings settings;
  settings.rooms = 12;
  settings.min_objects = 5;
  settings.max_objects = 9;
  return settings;
}

TEST(HouseholdScenes, EachObjectStandsInAboutAsManyRoomsAsAnyOther) {
  constexpr int kObjects = 10;
  const auto rooms = deal_objects(kObjects, five_to_nine());
  ASSERT_EQ(rooms.size(), 12U);
  std::vector<int> times(kObjects, 0);
  std::set<std::size_t> sizes;
  for (const std::vector<int>& room : rooms) {
    sizes.insert(room.size());
    EXPECT_EQ(std::set<int>(room.begin(), room.end()).size(), room.size()) << "an object stands in a room once";
    for (const int place : room) ++times.at(static_cast<std::size_t>(place));
  }
  EXPECT_GE(*sizes.begin(), 5U);
  EXPECT_LE(*sizes.rbegin(), 9U);
  EXPECT_GT(sizes.size(), 2U) << "rooms differ in their number of objects";
  const auto [least, most] = std::minmax_element(times.begin(), times.end());
  EXPECT_LE(*most - *least, 2);
}

TEST(HouseholdScenes, TheSameSeedDealsTheSameRoomsAndAnotherOneOthers) {
  SceneSettings settings = five_to_nine();
  const auto rooms = deal_objects(10, settings);
  EXPECT_EQ(rooms, deal_objects(10, settings));
  settings.seed = 2;
  EXPECT_NE(rooms, deal_objects(10, settings));
}

SceneSettings three_parts(const std::string& name) {
  const fs::path folder = fresh_folder(name);
  const std::vector<NamedModel> models = {{2, "small", teach::crooked_part(), {}},
                                          {5, "middle", teach::crooked_part(0.13F), {}},
                                          {9, "large", teach::crooked_part(0.16F), {}}};
  write_bop_models(models, folder / "models");
  SceneSettings settings;
  settings.models = folder / "models";
  settings.out = folder / "scenes";
  settings.rooms = 2;
  settings.frames = 2;
  settings.min_objects = 2;
  settings.max_objects = 3;
  return settings;
}

TEST(HouseholdScenes, AreBopScenesOfTheNamedObjectsAndEqualForAnyNumberOfThreads) {
  SceneSettings settings = three_parts("household");
  settings.threads = 1;
  render_scenes(settings);
  const BopScene scene(settings.out / "000001");
  ASSERT_EQ(scene.images().size(), 2U);
  EXPECT_EQ(find_bop_names(scene.folder()).at(5), "middle");
  std::set<int> ids;
  for (const int room : {1, 2}) {
    const BopScene it(settings.out / fmt::format("{:06d}", room));
    for (const BopImage& image : it.images()) {
      EXPECT_EQ(image.camera.fx, scene.images().front().camera.fx) << "one camera sees all rooms";
      for (const GroundTruthObject& object : image.objects) ids.insert(object.object_id);
    }
  }
  EXPECT_EQ(ids, (std::set<int>{2, 5, 9}));
  const fs::path first = settings.out;
  settings.out = first.parent_path() / "again";
  settings.threads = 2;
  render_scenes(settings);
  for (const char* file : {"000002/scene_gt.json", "000002/rgb/000001.png", "000002/depth/000001.png"})
    EXPECT_EQ(read_text(first / file), read_text(settings.out / file)) << file;
}

TEST(HouseholdScenes, TooFewObjectsAndPicturesThatAreThereAreRefused) {
  SceneSettings settings = three_parts("household_refused");
  settings.ids = {"2", "9"};
  expect_says(error_of([&] { render_scenes(settings); }), {"models", "2 objects", "expected at least 3"});
  settings.ids = {};
  settings.min_objects = 4;
  expect_says(error_of([&] { render_scenes(settings); }), {"4 to 3 objects", "expected the smaller number first"});
  settings.min_objects = 2;
  fs::create_directories(settings.out / "000002" / "rgb");
  write_text(settings.out / "000002" / "rgb" / "000000.png", "mine");
  expect_says(error_of([&] { render_scenes(settings); }), {"000002", "holds pictures already"});
  EXPECT_FALSE(fs::exists(settings.out / "000001"));
}

}  // namespace
}  // namespace houghstream::household
