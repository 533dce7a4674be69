#include "tools/teach/teach_jobs.hpp"

#include <gtest/gtest.h>

#include "detector/forest/forest_file.hpp"
#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/store/object_store.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "tests/drivers/test_files.hpp"
#include "tests/tools/teach/shapes.hpp"
#include "tools/common/stored_quality.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;

/// Few views, rooms and trees: what is learnt is worth nothing, but it is learnt as ever.
TeachOptions quick_options(const fs::path& folder, const std::string& mesh) {
  TeachOptions options;
  options.meshes.sources = {(folder / mesh).string()};
  options.out = folder / "store";
  options.rooms.cache = fs::temp_directory_path() / "houghstream_teach_jobs_test_cache";
  options.rooms.count = 5;
  options.views.views_per_attitude = 3;
  options.profile.training.trees = 2;
  options.profile.training.tests_per_node = 100;
  options.profile.training.patches_per_view = 60;
  options.profile.training.composites_per_view = 1;
  options.practice.rooms = 3;
  return options;
}

fs::path folder_of_meshes(const std::string& name) {
  fs::path folder = fresh_folder(name);
  save_ply(crooked_part(), folder / "bracket.ply");
  Mesh plain = mirrored(crooked_part());
  plain.colours.clear();
  save_ply(plain, folder / "grey.ply");
  return folder;
}

std::vector<std::string> forest_names(const fs::path& store) {
  std::vector<std::string> names;
  for (const ObjectClass& object : load_forest(store / "forest").classes) names.push_back(object.name);
  return names;
}

TEST(TeachJobs, ObjectsAreTaughtAddedAndRemoved) {
  const fs::path folder = folder_of_meshes("teach_whole");
  TeachOptions options = quick_options(folder, "bracket.ply");
  options.dump_views = folder / "views";
  teach_meshes(options);
  const store::ObjectStore first = store::read_store(options.out);
  ASSERT_EQ(first.objects.size(), 1U);
  EXPECT_EQ(first.objects[0].name, "bracket");
  EXPECT_GT(first.objects[0].views, 3);
  EXPECT_TRUE(fs::exists(first.contact_sheet()));
  EXPECT_EQ(static_cast<int>(read_bop_training_views(options.dump_views).size()), first.objects[0].views);

  const nlohmann::json learnt = first.objects[0].quality;
  EXPECT_EQ(stored_quality(first, {}).count("bracket"), 1U);

  TeachOptions more = quick_options(folder, "grey.ply");
  more.add = true;
  start_log("teach_tests", LogLevel::kInfo);
  testing::internal::CaptureStderr();
  teach_meshes(more);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("'bracket' and 'grey' can hardly be told apart"), std::string::npos) << said;
  const store::ObjectStore both = store::read_store(options.out);
  ASSERT_EQ(both.objects.size(), 2U);
  EXPECT_FALSE(both.objects[1].coloured);
  EXPECT_EQ(both.objects[1].id, 2);
  EXPECT_EQ(both.objects[0].quality, learnt) << "what was learnt of an older object stays";
  EXPECT_EQ(stored_quality(both, {}).count("grey"), 1U);
  EXPECT_EQ(forest_names(options.out), (std::vector<std::string>{"bracket", "grey"}));
  EXPECT_EQ(error_of([&] { teach_meshes(more); }).find((folder / "grey.ply").string()), 0U) << "known already";

  remove_from_store(options.out, "bracket");
  EXPECT_EQ(forest_names(options.out), std::vector<std::string>{"grey"});
  EXPECT_EQ(store::load_store_meshes(store::read_store(options.out)).count("grey"), 1U);
  EXPECT_NE(error_of([&] { remove_from_store(options.out, "bracket"); }), "");
  EXPECT_NE(error_of([&] { remove_from_store(options.out, "grey"); }), "") << "the only one";
  EXPECT_EQ(store::read_store(options.out).objects.size(), 1U) << "a refusal loses nothing";
}

TEST(TeachJobs, PractisingAnewKeepsTheObjects) {
  const fs::path folder = folder_of_meshes("teach_practise");
  const TeachOptions options = quick_options(folder, "bracket.ply");
  teach_meshes(options);
  const store::ObjectStore before = store::read_store(options.out);
  PracticeSettings other = options.practice;
  other.seed = 7;
  practise_store(options.out, other);
  const store::ObjectStore after = store::read_store(options.out);
  ASSERT_EQ(after.objects.size(), 1U);
  EXPECT_EQ(after.objects[0].name, "bracket");
  EXPECT_EQ(after.objects[0].views, before.objects[0].views);
  EXPECT_EQ(stored_quality(after, {}).count("bracket"), 1U);
  EXPECT_NE(after.objects[0].quality, before.objects[0].quality) << "in other rooms";
  EXPECT_EQ(forest_names(options.out), std::vector<std::string>{"bracket"});
  EXPECT_NE(error_of([&] { practise_store(folder / "nowhere", other); }).find("expected an object store"),
            std::string::npos);
}

TEST(TeachJobs, ARefusedTeachingLosesNothing) {
  const fs::path folder = folder_of_meshes("teach_refused");
  TeachOptions options = quick_options(folder, "bracket.ply");
  options.add = true;
  EXPECT_NE(error_of([&] { teach_meshes(options); }).find("no such folder, expected an object store"),
            std::string::npos);
  options.add = false;
  options.attitudes = "sideways";
  EXPECT_NE(error_of([&] { teach_meshes(options); }).find("expected resting, upright or any"), std::string::npos);
  EXPECT_FALSE(fs::exists(options.out));
}

}  // namespace
}  // namespace houghstream::teach
