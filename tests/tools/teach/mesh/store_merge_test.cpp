#include "tools/teach/mesh/store_merge.hpp"

#include <gtest/gtest.h>

#include "detector/forest/forest_file.hpp"
#include "drivers/files/image_file.hpp"
#include "drivers/store/object_store.hpp"
#include "tests/drivers/store/small_store.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"
#include "tests/tools/teach/shapes.hpp"
#include "tools/finder/object_finder.hpp"
#include "tools/finder/stored_forest.hpp"
#include "tools/finder/stored_quality.hpp"
#include "tools/teach/mesh/store_rename.hpp"
#include "tools/teach/mesh/teach_jobs.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;
using FileContents = std::map<std::string, std::string>;

/// Teaches quickly: the result is worth nothing, but it is learnt as ever.
TeachOptions quick_teaching(const fs::path& folder, const std::string& mesh, const std::string& store) {
  TeachOptions options;
  options.meshes.sources = {(folder / mesh).string()};
  options.out = folder / store;
  options.backgrounds.cache = fs::temp_directory_path() / "houghstream_teach_jobs_test_cache";
  options.backgrounds.count = 5;
  options.views.views_per_attitude = 3;
  options.profile.training.trees = 2;
  options.profile.training.tests_per_node = 100;
  options.profile.training.patches_per_view = 60;
  options.calibration.scenes = 3;
  return options;
}

/// Teaches stores of one object each, once in a process: "a" of a bracket and "b" of a longer one, whose texture its
/// mesh names by its id, and "c" of a grey part. All of them were taught with the id 1.
const fs::path& taught_apart() {
  static const fs::path folder = [] {
    fs::path made = fresh_folder("merge_taught");
    save_ply(crooked_part(), made / "bracket.ply");
    Mesh long_one = crooked_part(0.13F);
    long_one.colours.clear();
    long_one.uvs.assign(long_one.vertices.size(), Eigen::Vector2f(0.25F, 0.75F));
    long_one.texture = cv::Mat(4, 4, CV_8UC3, cv::Scalar(30, 160, 90));
    save_ply(long_one, made / "arm.ply");
    Mesh grey = mirrored(crooked_part(0.08F));
    grey.colours.clear();
    save_ply(grey, made / "grey.ply");
    teach_meshes(quick_teaching(made, "bracket.ply", "a"));
    teach_meshes(quick_teaching(made, "arm.ply", "b"));
    teach_meshes(quick_teaching(made, "grey.ply", "c"));
    return made;
  }();
  return folder;
}

/// Copies these stores, so that a test may change them.
fs::path copied_stores(const std::string& name) {
  fs::path folder = fresh_folder(name);
  for (const char* store : {"a", "b", "c"})
    fs::copy(taught_apart() / store, folder / store, fs::copy_options::recursive);
  return folder;
}

/// Reads the files of a store by their paths in it, byte for byte.
FileContents files_in(const fs::path& store) {
  FileContents files;
  for (const auto& [path, bytes] : store::files_of(store)) files[fs::relative(path, store).string()] = bytes;
  return files;
}

/// Returns the names of the groups' objects, and the bytes of their forests.
std::map<std::string, std::string> forests_in(const fs::path& folder) {
  const store::ObjectStore list = store::read_store(folder);
  std::map<std::string, std::string> forests;
  for (const store::StoredObject& object : list.objects)
    forests[object.name] = read_text(list.forest_file(object.group));
  return forests;
}

TEST(StoreMerge, NeitherOrderNorDivisionChangesABit) {
  const fs::path in = taught_apart();
  const fs::path out = fresh_folder("merge_order");
  const auto merged = [&](const std::vector<fs::path>& stores, const std::string& name) {
    merge_stores(stores, out / name, false);
    return files_in(out / name);
  };
  const FileContents all = merged({in / "a", in / "b", in / "c"}, "abc");
  EXPECT_TRUE(merged({in / "c", in / "b", in / "a"}, "cba") == all);
  merged({in / "b", in / "c"}, "bc");
  EXPECT_TRUE(merged({out / "bc", in / "a"}, "bc_a") == all) << "two first";
  merged({in / "a", in / "c"}, "ac");
  EXPECT_TRUE(merged({in / "b", out / "ac"}, "b_ac") == all) << "two others first";
  CalibrationSettings calibration;
  calibration.scenes = 3;
  for (const char* name : {"abc", "b_ac"}) calibrate_store(out / name, calibration);
  EXPECT_TRUE(files_in(out / "abc") == files_in(out / "b_ac")) << "practised";
  EXPECT_FALSE(files_in(out / "abc") == all);
}

TEST(StoreMerge, ATornForestCostsItsOwnGroup) {
  const fs::path in = copied_stores("merge_torn");
  merge_stores({in / "a", in / "b", in / "c"}, in / "all", false);
  const store::ObjectStore all = store::read_store(in / "all");
  fs::resize_file(all.forest_file(2), 1000);
  std::vector<store::GroupFault> faults;
  std::vector<std::string> names;
  for (const Forest& forest : load_whole_forests(all, 2, faults)) names.push_back(forest.classes.front().name);
  EXPECT_EQ(names, (std::vector<std::string>{all.objects[0].name, all.objects[2].name}));
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].group, 2);
  EXPECT_NE(faults[0].problem.find("forests/000002"), std::string::npos) << faults[0].problem;
  EXPECT_EQ(error_of([&] { load_store_forests(all, 2); }), faults[0].problem) << "nobody loads a part unasked";
  fs::resize_file(all.forest_file(1), 0);
  fs::resize_file(all.forest_file(3), 0);
  faults.clear();
  EXPECT_NE(error_of([&] { load_whole_forests(all, 2, faults); }).find("forests/000001"), std::string::npos);
}

TEST(StoreMerge, TheStoreHoldsWhatItsPartsHold) {
  const fs::path in = copied_stores("merge_whole");
  const FileContents before = files_in(in);
  merge_stores({in / "a", in / "b", in / "c"}, in / "all", false);
  const store::ObjectStore all = store::read_store(in / "all");
  ASSERT_EQ(all.objects.size(), 3U);
  EXPECT_EQ(all.groups(), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(all.objects[0].name, "arm") << "the first by name keeps the id that all were taught with";
  EXPECT_EQ(all.objects[1].taught_id, 1);
  EXPECT_EQ(all.settings, store::read_store(in / "a").settings);
  const std::map<std::string, Mesh> meshes = store::load_store_meshes(all);
  EXPECT_FALSE(meshes.at("arm").texture.empty());
  for (const auto& [name, object] : std::map<std::string, std::string>{{"a", "bracket"}, {"b", "arm"}, {"c", "grey"}}) {
    const store::ObjectStore part = store::read_store(in / name);
    EXPECT_EQ(read_text(all.forest_file(store::find_object(all, object).group)), read_text(part.forest_file(1)));
    EXPECT_EQ(all.quality().at(object), part.quality().at(object));
    EXPECT_EQ(meshes.at(object).vertices, store::load_store_meshes(part).at(object).vertices) << object;
  }
  std::vector<int> ids;
  for (const Forest& forest : load_store_forests(all, 2)) ids.push_back(forest.classes.front().class_id);
  EXPECT_EQ(ids, (std::vector<int>{1, 2, 3})) << "the store's, whatever the forests' files say";
  std::error_code error;
  fs::remove_all(in / "all", error);
  EXPECT_TRUE(files_in(in) == before) << "the parts stay as they are";
}

TEST(StoreMerge, ATextureGoesByTheIdOfItsObject) {
  const fs::path in = copied_stores("merge_texture");
  rename_in_store(in / "b", "arm", "z_arm");
  merge_stores({in / "a", in / "b"}, in / "all", false);
  const store::ObjectStore all = store::read_store(in / "all");
  EXPECT_EQ(store::find_object(all, "z_arm").id, 2);
  EXPECT_FALSE(store::load_store_meshes(all).at("z_arm").texture.empty());
  EXPECT_TRUE(fs::exists(all.models_folder() / "obj_000002.png"));
  EXPECT_FALSE(fs::exists(all.models_folder() / "obj_000001.png"));
}

TEST(StoreMerge, GroupsAreSearchedTogether) {
  const fs::path in = copied_stores("merge_found");
  merge_stores({in / "a", in / "b", in / "c"}, in / "all", false);
  ObjectFinder finder(in / "all");
  RgbdFrame frame = plain_frame(320, 240);
  EXPECT_NO_THROW(finder.find(frame));
  FinderOptions options;
  options.precision = 0.5;
  EXPECT_NO_THROW(ObjectFinder(in / "all", options).find(frame)) << "each group has practised";
  options.min_quality = 0.5F;
  EXPECT_EQ(error_of([&] { ObjectFinder(in / "all", options); }),
            "precision beside threshold or min_quality, expected it in their place");
}

/// Returns the error of a merge of a changed copy of "b" to "a"; nothing may be written.
std::string error_after(const std::string& name, const std::function<void(const fs::path& folder)>& change) {
  const fs::path in = copied_stores("merge_bad_" + name);
  change(in);
  const FileContents before = files_in(in);
  const std::string error = error_of([&] { merge_stores({in / "a", in / "b"}, in / "all", false); });
  EXPECT_TRUE(files_in(in) == before) << name;
  EXPECT_FALSE(fs::exists(in / "all")) << name;
  EXPECT_EQ(std::distance(fs::directory_iterator(in), {}), 3) << "nothing is left beside it: " << name;
  return error;
}

TEST(StoreMerge, WhatDoesNotFitIsRefusedInOneLine) {
  expect_says(error_after("name", [](const fs::path& in) { rename_in_store(in / "b", "arm", "bracket"); }),
              {"/b: has a 'bracket' as ", "/a has, expected one of each name"});
  expect_says(error_after("mesh",
                          [](const fs::path& in) {
                            fs::remove_all(in / "b");
                            fs::copy(in / "a", in / "b", fs::copy_options::recursive);
                            rename_in_store(in / "b", "bracket", "support");
                          }),
              {"/b: 'support' has the mesh of 'bracket' in ", "expected each object once"});
  expect_says(error_after("version",
                          [](const fs::path& in) {
                            replace_in_file(in / "b" / "store.json", "\"houghstream_store\": 3",
                                            "\"houghstream_store\": 9");
                          }),
              {"store.json: object store of version 9", "newer than this program"});
  expect_says(
      error_after("seed",
                  [](const fs::path& in) { replace_in_file(in / "b" / "store.json", "\"seed\": 1", "\"seed\": 4"); }),
      {"b/store.json: taught with seed 4, expected 1 as ", "/a"});
  expect_says(error_after("torn",
                          [](const fs::path& in) {
                            fs::resize_file(in / "b" / "forest", fs::file_size(in / "b" / "forest") / 2);
                          }),
              {"b/forest"});
  expect_says(error_after("settings",
                          [](const fs::path& in) {
                            Forest forest = load_forest(in / "b" / "forest");
                            forest.features.min_max_px += 2;
                            save_forest(forest, in / "b" / "forest");
                          }),
              {"b/forest: taught with other settings", "a/forest, expected the same"});
  expect_says(error_after("terms",
                          [](const fs::path& in) {
                            replace_in_file(in / "b" / "store.json", "\"print\": 0", "\"ink\": 0");
                            replace_in_file(in / "b" / "store.json", "\"bias\"", "\"bius\"");
                          }),
              {"b/store.json object 'arm'"});
  const fs::path in = taught_apart();
  EXPECT_EQ(error_of([&] { merge_stores({in / "a"}, in / "all", false); }), "1 store, expected at least two to merge");
  EXPECT_EQ(error_of([&] {
              merge_stores({in / "a", in / "none"}, in / "all", false);
            }).find((in / "none").string()),
            0U);
  EXPECT_FALSE(fs::exists(in / "all"));
}

TEST(StoreMerge, AStoreThatIsThereIsOnlyReplacedWhereThatIsAskedFor) {
  const fs::path in = copied_stores("merge_replace");
  const FileContents before = files_in(in);
  EXPECT_EQ(error_of([&] {
              merge_stores({in / "a", in / "b"}, in / "c", false);
            }),
            (in / "c").string() +
                ": holds 1 object, expected --add to add to it, or --replace to put a new one in its place");
  EXPECT_TRUE(files_in(in) == before);
  merge_stores({in / "a", in / "b"}, in / "a", true);
  EXPECT_EQ(store::read_store(in / "a").objects.size(), 2U) << "one of the parts, too";
}

/// Makes the grouped store "all" of the three objects.
fs::path merged_copy(const std::string& name) {
  const fs::path in = copied_stores(name);
  merge_stores({in / "a", in / "b", in / "c"}, in / "all", false);
  return in;
}

TEST(StoreMerge, AddedObjectsLeaveTheFilesOfOtherGroups) {
  const fs::path in = merged_copy("merge_add");
  const auto before = forests_in(in / "all");
  save_ply(crooked_part(0.16F), in / "wedge.ply");
  TeachOptions more = quick_teaching(in, "wedge.ply", "all");
  more.add = true;
  more.max_group_objects = 1;
  teach_meshes(more);
  auto after = forests_in(in / "all");
  EXPECT_EQ(store::read_store(in / "all").groups(), (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(after.erase("wedge"), 1U);
  EXPECT_TRUE(after == before) << "bit for bit";
  EXPECT_EQ(stored_quality(store::read_store(in / "all"), {}).size(), 4U);

  save_ply(crooked_part(0.18F), in / "block.ply");
  TeachOptions grown = quick_teaching(in, "block.ply", "all");
  grown.add = true;
  teach_meshes(grown);
  after = forests_in(in / "all");
  const store::ObjectStore list = store::read_store(in / "all");
  EXPECT_EQ(store::find_object(list, "block").group, store::find_object(list, "wedge").group) << "which had room";
  for (const auto& [name, forest] : before) EXPECT_TRUE(after.at(name) == forest) << name;
  EXPECT_EQ(stored_quality(list, {}).size(), 5U);
}

TEST(StoreMerge, ManyObjectsAreTaughtInGroups) {
  const fs::path in = fresh_folder("merge_many");
  save_ply(crooked_part(0.08F), in / "a.ply");
  save_ply(crooked_part(0.15F), in / "b.ply");
  TeachOptions options = quick_teaching(in, "a.ply", "store");
  options.meshes.sources.push_back((in / "b.ply").string());
  options.max_group_objects = 1;
  teach_meshes(options);
  EXPECT_EQ(store::read_store(options.out).groups(), (std::vector<int>{1, 2}));
  options.out = in / "serial";
  options.threads = 1;
  teach_meshes(options);
  EXPECT_TRUE(files_in(in / "serial") == files_in(in / "store")) << "on any number of threads";
}

TEST(StoreMerge, RemovingAndRenamingLeaveTheFilesOfOtherGroups) {
  const fs::path in = merged_copy("merge_change");
  const auto before = forests_in(in / "all");
  rename_in_store(in / "all", "bracket", "support");
  auto after = forests_in(in / "all");
  EXPECT_EQ(after.count("support"), 1U);
  EXPECT_TRUE(after.at("arm") == before.at("arm"));
  EXPECT_TRUE(after.at("grey") == before.at("grey"));
  rename_in_store(in / "all", "support", "bracket");
  EXPECT_TRUE(forests_in(in / "all") == before);

  remove_from_store(in / "all", "arm");
  after = forests_in(in / "all");
  EXPECT_EQ(after.size(), 2U);
  EXPECT_TRUE(after.at("bracket") == before.at("bracket"));
  remove_from_store(in / "all", "bracket");
  EXPECT_TRUE(forests_in(in / "all").at("grey") == before.at("grey"));
  EXPECT_TRUE(fs::exists(in / "all" / "forest")) << "one group is left";
  EXPECT_FALSE(fs::exists(in / "all" / "forests"));
  EXPECT_NE(error_of([&] { remove_from_store(in / "all", "grey"); }), "") << "the only one";
}

TEST(StoreMerge, PractisingOneGroupLeavesTheOthers) {
  const fs::path in = merged_copy("merge_practise");
  const auto before = forests_in(in / "all");
  const auto qualities = store::read_store(in / "all").quality();
  CalibrationSettings calibration;
  calibration.scenes = 3;
  calibrate_store(in / "all", calibration, {"arm"});
  const auto after = forests_in(in / "all");
  EXPECT_FALSE(after.at("arm") == before.at("arm"));
  EXPECT_TRUE(after.at("bracket") == before.at("bracket"));
  EXPECT_TRUE(after.at("grey") == before.at("grey"));
  EXPECT_EQ(store::read_store(in / "all").quality().at("grey"), qualities.at("grey"));
}

TEST(StoreMerge, ATornGroupIsNamedAndNothingIsWritten) {
  const fs::path in = merged_copy("merge_torn");
  const fs::path file = store::read_store(in / "all").forest_file(2);
  fs::resize_file(file, fs::file_size(file) / 2);
  const FileContents before = files_in(in);
  CalibrationSettings calibration;
  calibration.scenes = 3;
  for (const std::string& error :
       {error_of([&] { calibrate_store(in / "all", calibration); }),
        error_of([&] { remove_from_store(in / "all", "arm"); }), error_of([&] { ObjectFinder finder(in / "all"); })})
    expect_says(error, {file.string()});
  EXPECT_TRUE(files_in(in) == before);
}

}  // namespace
}  // namespace houghstream::teach
