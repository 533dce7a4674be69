#include "tools/teach/mesh/teach_jobs.hpp"

#include <gtest/gtest.h>

#include "detector/forest/forest_file.hpp"
#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/files/image_file.hpp"
#include "drivers/store/object_store.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "tests/drivers/store/small_store.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"
#include "tests/tools/teach/shapes.hpp"
#include "tools/finder/stored_quality.hpp"
#include "tools/teach/mesh/store_rename.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;

/// Few views, rooms and trees: what is learnt is worth nothing, but it is learnt as ever.
TeachOptions quick_options(const fs::path& folder, const std::string& mesh) {
  TeachOptions options;
  options.meshes.sources = {(folder / mesh).string()};
  options.out = folder / "store";
  options.backgrounds.cache = fs::temp_directory_path() / "houghstream_teach_jobs_test_cache";
  options.backgrounds.count = 5;
  options.views.views_per_attitude = 3;
  options.profile.training.trees = 2;
  options.profile.training.tests_per_node = 100;
  options.profile.training.patches_per_view = 60;
  options.profile.training.composites_per_view = 1;
  options.calibration.scenes = 3;
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

/// Somebody's own files in a store.
void put_notes(const fs::path& store) {
  write_text(store / "NOTES.txt", "the handle faces left");
  fs::create_directories(store / "models" / "sources");
  write_text(store / "models" / "sources" / "bracket.step", "of a CAD program");
}

void expect_notes(const fs::path& store, const std::string& after) {
  EXPECT_EQ(read_text(store / "NOTES.txt"), "the handle faces left") << after;
  EXPECT_EQ(read_text(store / "models" / "sources" / "bracket.step"), "of a CAD program") << after;
}

TEST(TeachJobs, ObjectsAreTaughtAddedAndRemoved) {
  const fs::path folder = folder_of_meshes("teach_whole");
  TeachOptions options = quick_options(folder, "bracket.ply");
  options.dump_views = folder / "views";
  fs::create_directory(options.out);  // in the place of another store
  store::fill_store(options.out, "brick");
  put_notes(options.out);
  options.replace = true;
  testing::internal::CaptureStdout();
  teach_meshes(options);
  const std::string summary = testing::internal::GetCapturedStdout();
  for (const std::string& part :
       {options.out.string() + ": 1 object; look at " + (options.out / "contact_sheet.jpg").string() + "\n  bracket ",
        std::string(" mm "), std::string(" practice views"),
        "\nnext: hs-stream --source openni2 --objects " + options.out.string() + "\n"})
    EXPECT_NE(summary.find(part), std::string::npos) << part << " in\n" << summary;
  EXPECT_GT(summary.find("next: "), summary.find("teach_seconds ")) << "what to type next stands last";
  expect_notes(options.out, "mesh --replace");
  const store::ObjectStore first = store::read_store(options.out);
  ASSERT_EQ(first.objects.size(), 1U);
  EXPECT_EQ(first.objects[0].name, "bracket");
  EXPECT_GT(first.objects[0].views, 3);
  EXPECT_TRUE(fs::exists(first.contact_sheet()));
  EXPECT_EQ(static_cast<int>(read_bop_training_views(options.dump_views).size()), first.objects[0].views);

  EXPECT_EQ(first.tone.min_mean, kCalibrationBrightness.min_mean) << "hs-pose reads it here";
  EXPECT_EQ(load_forest(first.forest_file(1)).features.tone.max_deviation, kCalibrationBrightness.max_deviation);

  EXPECT_EQ(first.shape_symmetries().count("bracket"), 1U);
  const nlohmann::json learnt = first.objects[0].quality;
  EXPECT_EQ(stored_quality(first, {}).count("bracket"), 1U);

  TeachOptions more = quick_options(folder, "grey.ply");
  more.add = true;
  start_log("teach_tests", LogLevel::kInfo);
  testing::internal::CaptureStderr();
  teach_meshes(more);
  expect_notes(options.out, "mesh --add");
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("'bracket' and 'grey' can hardly be told apart"), std::string::npos) << said;
  const store::ObjectStore both = store::read_store(options.out);
  ASSERT_EQ(both.objects.size(), 2U);
  EXPECT_FALSE(both.objects[1].coloured);
  EXPECT_EQ(both.objects[1].id, 2);
  EXPECT_EQ(both.tone.max_mean, kCalibrationBrightness.max_mean);
  EXPECT_EQ(both.objects[0].quality, learnt) << "what was learnt of an older object stays";
  EXPECT_EQ(both.shape_symmetries().size(), 2U);
  EXPECT_EQ(stored_quality(both, {}).count("grey"), 1U);
  EXPECT_EQ(forest_names(options.out), (std::vector<std::string>{"bracket", "grey"}));
  EXPECT_EQ(error_of([&] { teach_meshes(more); }).find((folder / "grey.ply").string()), 0U) << "known already";

  store::ObjectStore confused = both;
  confused.objects[1].practice->taken_for = {{"bracket", 4}, {"mug", 1}};
  store::write_store_json(confused);
  remove_from_store(options.out, "bracket");
  EXPECT_EQ(store::read_store(options.out).objects[0].practice->taken_for, (std::map<std::string, int>{{"mug", 1}}));
  expect_notes(options.out, "remove");
  EXPECT_EQ(forest_names(options.out), std::vector<std::string>{"grey"});
  EXPECT_EQ(store::load_store_meshes(store::read_store(options.out)).count("grey"), 1U);
  EXPECT_NE(error_of([&] { remove_from_store(options.out, "bracket"); }), "");
  expect_says(error_of([&] { remove_from_store(options.out, "grey"); }),
              {"'grey' is its only object", "--replace", "rm -r " + options.out.string()});
  EXPECT_EQ(store::read_store(options.out).objects.size(), 1U) << "a refusal loses nothing";
}

TEST(TeachJobs, NothingJoinsAStoreWhoseQualitiesAreOfOtherTerms) {
  const fs::path folder = folder_of_meshes("teach_other_terms");
  teach_meshes(quick_options(folder, "bracket.ply"));
  TeachOptions more = quick_options(folder, "grey.ply");
  more.add = true;
  std::string list = read_text(more.out / "store.json");
  const std::string term = "\"print\"";
  for (std::size_t at = list.find(term); at != std::string::npos; at = list.find(term))
    list.replace(at, term.size(), "\"ink\"");
  write_text(more.out / "store.json", list);
  const std::map<std::string, std::string> before = store::files_of(more.out);
  expect_says(error_of([&] { teach_meshes(more); }), {"has no 'print'", "hs-teach practise"});
  EXPECT_TRUE(store::files_of(more.out) == before);
}

/// Names in all places where they stand.
void expect_named(const fs::path& folder, const std::string& name) {
  const store::ObjectStore store = store::read_store(folder);
  ASSERT_EQ(store.objects.size(), 1U);
  EXPECT_EQ(store.objects[0].name, name);
  EXPECT_EQ(store::load_store_meshes(store).count(name), 1U);
  EXPECT_EQ(forest_names(folder), std::vector<std::string>{name});
}

TEST(TeachJobs, ARenamedObjectIsTheSame) {
  const fs::path folder = folder_of_meshes("teach_rename");
  const TeachOptions options = quick_options(folder, "bracket.ply");
  teach_meshes(options);
  store::ObjectStore before = store::read_store(options.out);
  before.objects[0].shape_symmetry->nearly_round = ContinuousSymmetry{};
  before.objects[0].practice->taken_for = {{"bracket", 2}, {"mug", 1}};
  store::write_store_json(before);
  const std::string forest = read_text(before.forest_file(1));
  const cv::Mat views = read_colour_image(before.view_image(1));
  put_notes(options.out);
  rename_in_store(options.out, "bracket", "shelf_support");
  expect_notes(options.out, "rename");
  expect_named(options.out, "shelf_support");
  const store::ObjectStore after = store::read_store(options.out);
  EXPECT_EQ(after.objects[0].id, before.objects[0].id);
  EXPECT_EQ(after.objects[0].views, before.objects[0].views);
  EXPECT_EQ(after.objects[0].quality, before.objects[0].quality);
  EXPECT_EQ(after.objects[0].practice->taken_for, (std::map<std::string, int>{{"mug", 1}, {"shelf_support", 2}}));
  EXPECT_TRUE(after.shape_symmetries().at("shelf_support").nearly_round.has_value());
  EXPECT_EQ(after.settings, before.settings);
  EXPECT_EQ(after.tone.max_mean, before.tone.max_mean);
  EXPECT_TRUE(fs::exists(after.contact_sheet()));
  cv::Mat difference;
  cv::absdiff(read_colour_image(after.view_image(1)), views, difference);
  EXPECT_GT(cv::sum(difference.rowRange(0, 26))[0], 0.0) << "another title";
  EXPECT_EQ(cv::sum(difference.rowRange(26, difference.rows)), cv::Scalar()) << "above the same views";

  EXPECT_NE(error_of([&] { rename_in_store(options.out, "bracket", "x"); }).find("expected one of shelf_support"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              rename_in_store(options.out, "shelf_support", "shelf_support");
            }).find("has a 'shelf_support' already"),
            std::string::npos);
  EXPECT_NE(error_of([&] { rename_in_store(options.out, "shelf_support", ""); }).find("expected a word"),
            std::string::npos);
  for (const std::string& none : {std::string("a/b"), std::string("../x"), std::string("x,y"), std::string(300, 'x')}) {
    EXPECT_NE(error_of([&] {
                rename_in_store(options.out, "shelf_support", none);
              }).find("store.json: the name '" + none + "', expected a word"),
              std::string::npos)
        << none;
  }
  EXPECT_NE(error_of([&] {
              rename_in_store(options.out, "shelf_support", "m\xfcg");
            }).find("store.json: the name 'm\\xfcg' is not UTF-8"),
            std::string::npos);
  rename_in_store(options.out, "shelf_support", "bracket");
  expect_named(options.out, "bracket");
  EXPECT_EQ(read_text(before.forest_file(1)), forest) << "byte for byte";
  EXPECT_EQ(std::distance(fs::directory_iterator(options.out.parent_path()), {}), 3) << "nothing is left beside it";
}

TEST(TeachJobs, AStoreIsOnlyReplacedWhereThatIsAskedFor) {
  const fs::path store = store::whole_store("teach_replaced");
  TeachOptions options = quick_options(store.parent_path(), "nowhere.ply");
  ASSERT_EQ(options.out.string(), store.string());
  const auto before = store::files_of(store.parent_path());
  EXPECT_EQ(
      error_of([&] { teach_meshes(options); }),
      store.string() + ": holds 2 objects, expected --add to add to it, or --replace to put a new one in its place");
  EXPECT_EQ(store::files_of(store.parent_path()), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(store.parent_path()), {}), 1) << "nothing is left beside it";
  options.replace = true;
  EXPECT_EQ(error_of([&] { teach_meshes(options); }).find((store.parent_path() / "nowhere.ply").string()), 0U);
  EXPECT_EQ(store::files_of(store.parent_path()), before) << "until the new one is whole";

  options.replace = false;
  fs::rename(store, store.parent_path() / ".store.before");
  EXPECT_NE(error_of([&] { teach_meshes(options); }).find("holds 2 objects"), std::string::npos) << "put aside";
  EXPECT_EQ(store::files_of(store.parent_path()), before);
}

TEST(TeachJobs, AStoreThatCannotBeReadIsNotReplacedEither) {
  const fs::path store = store::whole_store("teach_unread");
  const TeachOptions options = quick_options(store.parent_path(), "nowhere.ply");
  replace_in_file(store / "store.json", "\"houghstream_store\": 1", "\"houghstream_store\": 7");
  const auto before = store::files_of(store.parent_path());
  const std::string said = error_of([&] { teach_meshes(options); });
  EXPECT_EQ(said.find(store.string() + ": an object store that cannot be read (" + (store / "store.json").string() +
                      ": object store of version 7"),
            0U)
      << said;
  EXPECT_NE(said.find("), expected --replace to put a new one in its place"), std::string::npos) << said;
  EXPECT_EQ(store::files_of(store.parent_path()), before);
}

TEST(TeachJobs, PractisingAnewKeepsTheObjects) {
  const fs::path folder = folder_of_meshes("teach_practise");
  const TeachOptions options = quick_options(folder, "bracket.ply");
  fs::create_directory(options.out);  // an empty folder is no store
  teach_meshes(options);
  store::ObjectStore before = store::read_store(options.out);
  before.objects[0].shape_symmetry.reset();  // taught before they were looked for
  store::write_store_json(before);
  CalibrationSettings other = options.calibration;
  other.seed = 7;
  put_notes(options.out);
  calibrate_store(options.out, other);
  expect_notes(options.out, "practise");
  const store::ObjectStore after = store::read_store(options.out);
  ASSERT_EQ(after.objects.size(), 1U);
  EXPECT_EQ(after.objects[0].name, "bracket");
  EXPECT_EQ(after.objects[0].views, before.objects[0].views);
  EXPECT_EQ(stored_quality(after, {}).count("bracket"), 1U);
  EXPECT_EQ(after.shape_symmetries().count("bracket"), 1U);
  EXPECT_NE(after.objects[0].quality, before.objects[0].quality) << "in other rooms";
  ASSERT_TRUE(after.objects[0].practice.has_value());
  EXPECT_GT(after.objects[0].practice->shown, 0);
  EXPECT_LE(after.objects[0].practice->right, after.objects[0].practice->shown);
  EXPECT_NE(to_json(*after.objects[0].practice), to_json(*before.objects[0].practice)) << "in other rooms";
  EXPECT_EQ(forest_names(options.out), std::vector<std::string>{"bracket"});
  EXPECT_NE(error_of([&] { calibrate_store(folder / "nowhere", other); }).find("expected an object store"),
            std::string::npos);
}

TEST(TeachJobs, PractisingOneLeavesTheOthers) {
  const fs::path folder = folder_of_meshes("teach_practise_one");
  TeachOptions options = quick_options(folder, "bracket.ply");
  options.meshes.sources.push_back((folder / "grey.ply").string());
  teach_meshes(options);
  const store::ObjectStore before = store::read_store(options.out);
  CalibrationSettings other = options.calibration;
  other.seed = 7;
  calibrate_store(options.out, other, {"grey"});
  const store::ObjectStore after = store::read_store(options.out);
  ASSERT_EQ(after.objects.size(), 2U);
  EXPECT_EQ(after.objects[0].quality, before.objects[0].quality);
  EXPECT_NE(after.objects[1].quality, before.objects[1].quality);
  EXPECT_EQ(to_json(*after.objects[0].practice), to_json(*before.objects[0].practice));
  EXPECT_NE(to_json(*after.objects[1].practice), to_json(*before.objects[1].practice));
  EXPECT_EQ(error_of([&] { calibrate_store(options.out, other, {"drill"}); }),
            (options.out / "store.json").string() + ": no 'drill', expected one of bracket, grey");
}

TEST(TeachJobs, WhereTheOriginLiesMakesNoDifference) {
  const fs::path folder = folder_of_meshes("teach_far_origin");
  const Eigen::Vector3f away(0.8F, -0.3F, 0.5F);
  Mesh far = crooked_part();
  for (Eigen::Vector3f& vertex : far.vertices) vertex += away;
  save_ply(far, folder / "far.ply");
  TeachOptions options = quick_options(folder, "far.ply");
  options.dump_views = folder / "views";
  teach_meshes(options);
  const Eigen::Vector3f middle = mesh_bounds(far).center();
  EXPECT_LT((store::read_store(options.out).vote_centres().at("far") - middle).norm(), 1e-5F);
  EXPECT_LT(load_forest(options.out / "forest").classes.at(0).radius, 0.1F) << "votes are for its middle";
  for (const TrainingView& view : read_bop_training_views(options.dump_views))
    EXPECT_LT((view.T_camera_object * middle.cast<double>()).head<2>().norm(), 0.1) << "in the mesh's own frame";
}

TEST(TeachJobs, ViewsAreNotMixedWithOthers) {
  const fs::path folder = folder_of_meshes("teach_mixed");
  TeachOptions options = quick_options(folder, "grey.ply");
  options.dump_views = folder / "views";
  fs::create_directories(options.dump_views / "000001");
  EXPECT_NE(error_of([&] { teach_meshes(options); }).find("views: holds something already"), std::string::npos);
  EXPECT_FALSE(fs::exists(options.out));
}

TEST(TeachJobs, WhatCannotBeReadBackIsNotPublished) {
  const fs::path folder = fresh_folder("teach_unreadable");
  TeachOptions options = quick_options(folder, "");
  options.meshes.sources.clear();
  TaughtMesh taught;
  taught.name = "m\xfcg";  // store.json holds Unicode, the forest any bytes
  taught.file = "shown";
  taught.mesh = crooked_part();
  options.shown = {taught};
  EXPECT_NE(error_of([&] { teach_meshes(options); }).find("expected the objects of"), std::string::npos);
  EXPECT_TRUE(fs::is_empty(folder)) << "neither a store nor what is left of one";
}

TEST(TeachJobs, AStoreThatWasPutAsideIsThereForEveryJob) {
  const fs::path folder = folder_of_meshes("teach_aside");
  const TeachOptions options = quick_options(folder, "bracket.ply");
  teach_meshes(options);
  fs::rename(options.out, folder / ".store.before");
  rename_in_store(options.out, "bracket", "support");
  expect_named(options.out, "support");
  fs::rename(options.out, folder / ".store.before");
  EXPECT_EQ(error_of([&] { remove_from_store(options.out, "drill"); }),
            (options.out / "store.json").string() + ": no 'drill', expected one of support");
  expect_named(options.out, "support");
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
