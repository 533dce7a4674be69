#include "drivers/store/object_store.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "tests/drivers/store/small_store.hpp"
#include "tests/expect_says.hpp"

namespace houghstream::store {
namespace {

namespace fs = std::filesystem;

std::string error_of_reading(const fs::path& folder) {
  return error_of([&] { read_store(folder); });
}

std::string error_of_loading(const fs::path& folder) {
  return error_of([&] { load_store_meshes(read_store(folder)); });
}

TEST(ObjectStore, WhatIsWrittenIsReadBack) {
  const ObjectStore store = read_store(whole_store("store_read"));
  ASSERT_EQ(store.objects.size(), 2U);
  EXPECT_EQ(store.objects[0].name, "mug");
  EXPECT_EQ(store.objects[0].mesh, "cad/mug.ply");
  EXPECT_TRUE(store.objects[0].coloured);
  EXPECT_EQ(store.objects[1].id, 5);
  EXPECT_EQ(store.objects[1].views, 34);
  EXPECT_EQ(store.objects[1].attitudes, "any");
  EXPECT_FALSE(store.objects[1].coloured);
  EXPECT_EQ(store.quality().size(), 1U);
  EXPECT_EQ(store.quality().at("brick").at("least"), 0.5);
  EXPECT_EQ(store.settings.at("seed"), 1);
  EXPECT_EQ(store.vote_centres().at("brick"), Eigen::Vector3f(0.0F, 0.01F, -0.5F));
  EXPECT_EQ(store.vote_centres().at("mug"), Eigen::Vector3f::Zero());
  EXPECT_EQ(store.symmetries.at(2).discrete.size(), 1U);
  const std::map<std::string, Mesh> meshes = load_store_meshes(store);
  EXPECT_NEAR(mesh_bounds(meshes.at("brick")).sizes().x(), 0.2F, 1e-6F);
  EXPECT_FALSE(meshes.at("mug").colours.empty());
  EXPECT_TRUE(meshes.at("brick").colours.empty()) << "that its file has some does not make them known";
}

TEST(ObjectStore, NamedFramesAreReadBackAndWhatIsNoneIsRefused) {
  const fs::path folder = whole_store("store_frames");
  ObjectStore store = read_store(folder);
  EXPECT_TRUE(store.objects[0].frames.empty());
  const Eigen::Isometry3d handle =
      Eigen::Translation3d(0.05, 0, -0.04) * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX());
  store.objects[0].frames = {{"handle", handle}, {"rim", Eigen::Isometry3d::Identity()}};
  write_store_json(store);
  const std::vector<ObjectFrame> read = read_store(folder).objects[0].frames;
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].name, "handle");
  EXPECT_TRUE(read[0].T_object_frame.isApprox(handle, 1e-12));

  const std::string text = read_text(folder / "store.json");
  const auto refused = [&](const std::string& part, const std::string& other) {
    std::string damaged = text;
    damaged.replace(damaged.find(part), part.size(), other);
    write_text(folder / "store.json", damaged);
    return error_of_reading(folder);
  };
  expect_says(refused("\"rim\"", "\"r im\""), {"object 2 frame 'r im'", "expected a word"});
  expect_says(refused("0.05", "50"), {"frame 'handle'", "expected metres"});
  expect_says(refused("\"translation_m\"", "\"translation_mm\""), {"frame 'handle'", "translation_mm"});
  expect_says(refused("\"rotation\": [\n      1.0", "\"rotation\": [\n      2.0"),
              {"frame 'rim'", "expected a unit quaternion"});
}

TEST(ObjectStore, AnObjectThatIsNotThereIsNamedBesideThoseThatAre) {
  const fs::path folder = whole_store("store_called");
  const ObjectStore store = read_store(folder);
  EXPECT_EQ(find_object(store, "brick").id, 5);
  EXPECT_EQ(error_of([&] { find_object(store, "drill"); }),
            (folder / "store.json").string() + ": no 'drill', expected one of mug, brick");
}

TEST(ObjectStore, AHalfWrittenOneIsRefused) {
  expect_says(error_of_reading("/no/such/store"), {"/no/such/store", "expected an object store"});
  for (const std::string file :
       {"store.json", "forest", "models/models_info.json", "models/names.json", "models/obj_000005.ply"}) {
    const fs::path folder = whole_store("store_half");
    fs::remove(folder / file);
    expect_says(error_of_reading(folder), {(folder / file).string(), "missing", "half written"});
  }
  const fs::path folder = whole_store("store_cut");
  const std::string text = read_text(folder / "store.json");
  write_text(folder / "store.json", text.substr(0, text.size() / 2));
  expect_says(error_of_reading(folder), {"store.json", "cut short"});
}

TEST(ObjectStore, AnotherVersionIsRefused) {
  const fs::path folder = whole_store("store_version");
  replace_in_file(folder / "store.json", "\"houghstream_store\": 1", "\"houghstream_store\": 7");
  expect_says(error_of_reading(folder), {"store.json", "version 7", "expected at most 3", "newer than this program"});
}

/// The mug and the brick, each in a group of its own.
fs::path grouped_store(const std::string& name) {
  const fs::path folder = whole_store(name);
  ObjectStore store = read_store(folder);
  store.objects[1].group = store.objects[1].id;
  fs::remove(folder / "forest");
  fs::create_directories(store.forests_folder());
  for (const int group : store.groups()) write_text(store.forest_file(group), "a forest");
  write_store_json(store);
  return folder;
}

TEST(ObjectStore, OneOfOneGroupIsWrittenAsBeforeThereWereGroups) {
  const fs::path folder = whole_store("store_one_group");
  const std::string text = read_text(folder / "store.json");
  EXPECT_NE(text.find("\"houghstream_store\": 1,"), std::string::npos) << "which older programs read";
  EXPECT_EQ(text.find("group"), std::string::npos);
  const ObjectStore store = read_store(folder);
  EXPECT_EQ(store.groups(), std::vector<int>{2}) << "the smallest id";
  EXPECT_EQ(store.forest_file(2), folder / "forest");
  write_store_json(store);
  EXPECT_EQ(read_text(folder / "store.json"), text);
}

TEST(ObjectStore, PracticeIsOfANewerVersionAndStaysWithItsObject) {
  const fs::path folder = whole_store("store_practice");
  ObjectStore store = read_store(folder);
  EXPECT_FALSE(store.objects[0].practice.has_value()) << "which older programs have written";
  store.objects[1].practice = PracticeRecord();
  store.objects[1].practice->shown = 7;
  store.objects[1].practice->scores = {{0.5, 6, 1}};
  write_store_json(store);
  const std::string text = read_text(folder / "store.json");
  EXPECT_NE(text.find("\"houghstream_store\": 3,"), std::string::npos);
  const ObjectStore read = read_store(folder);
  EXPECT_FALSE(read.objects[0].practice.has_value());
  ASSERT_TRUE(read.objects[1].practice.has_value());
  EXPECT_EQ(read.objects[1].practice->scores.at(0).right, 6);
  write_store_json(read);
  EXPECT_EQ(read_text(folder / "store.json"), text);
  replace_in_file(folder / "store.json", "\"shown\": 7", "\"shown\": -7");
  expect_says(error_of_reading(folder), {"store.json object 5 'practice': 'shown' is -7, expected a count"});
}

TEST(ObjectStore, GroupsHaveAForestEach) {
  const fs::path folder = grouped_store("store_groups");
  EXPECT_NE(read_text(folder / "store.json").find("\"houghstream_store\": 2,"), std::string::npos);
  const ObjectStore store = read_store(folder);
  EXPECT_EQ(store.groups(), (std::vector<int>{2, 5}));
  EXPECT_EQ(store.forest_file(5), folder / "forests" / "000005");
  EXPECT_EQ(error_of([&] { require_same_objects(store, 5, {"brick"}); }), "");
  expect_says(error_of([&] { require_same_objects(store, 2, {"brick"}); }),
              {"forests/000002: knows brick, expected the objects", "mug"});
  EXPECT_TRUE(is_store_entry("forests"));
  EXPECT_TRUE(is_store_entry("forests/000005"));
  EXPECT_TRUE(is_store_entry("forests/000005.partial"));
  EXPECT_FALSE(is_store_entry("forests/oak.txt"));
  fs::remove(store.forest_file(2));
  expect_says(error_of_reading(folder), {store.forest_file(2).string(), "missing", "half written"});
}

TEST(ObjectStore, AGroupIsCalledByTheSmallestOfItsIds) {
  ObjectStore store;
  for (const auto& [id, group] : {std::make_pair(7, 3), std::make_pair(4, 3), std::make_pair(2, 9)}) {
    store.objects.emplace_back();
    store.objects.back().id = id;
    store.objects.back().group = group;
  }
  number_groups(store);
  EXPECT_EQ(store.groups(), (std::vector<int>{2, 4}));
  EXPECT_EQ(store.objects[0].group, 4);
  const fs::path folder = grouped_store("store_group_number");
  replace_in_file(folder / "store.json", "\"group\": 5", "\"group\": 4");
  expect_says(error_of_reading(folder), {"store.json object 5: 'group' is 4, expected 5"});
  replace_in_file(folder / "store.json", "\"group\": 4,", "");
  expect_says(error_of_reading(folder), {"store.json object 5: 'group' is 0, expected 5"});
}

TEST(ObjectStore, AnIdOfTeachingIsKeptBesideThatOfAMerge) {
  const fs::path folder = whole_store("store_taught_id");
  ObjectStore store = read_store(folder);
  store.objects[1].taught_id = 2;
  write_store_json(store);
  EXPECT_NE(read_text(folder / "store.json").find("\"houghstream_store\": 2,"), std::string::npos);
  EXPECT_EQ(read_store(folder).objects[1].taught_id, 2);
  EXPECT_EQ(read_store(folder).objects[0].taught_id, 0);
  replace_in_file(folder / "store.json", "\"taught_id\": 2", "\"taught_id\": -2");
  expect_says(error_of_reading(folder), {"store.json object 5: 'taught_id' is -2, expected an id from 1 on"});
}

TEST(ObjectStore, AVoteCentreIsThreeNumbersOrTheOrigin) {
  const fs::path folder = whole_store("store_centre");
  ObjectStore store = read_store(folder);
  store.objects[1].vote_centre = {0.0F, 60.0F, 0.0F};
  write_store_json(store);
  expect_says(error_of_reading(folder),
              {"store.json object 5", "'vote_centre_m' is [0.0,60.0,0.0]", "expected x, y, z"});
  replace_in_file(folder / "store.json", "60.0", "\"high\"");
  expect_says(error_of_reading(folder), {"'vote_centre_m' holds \"high\"", "expected finite numbers"});
}

ShapeSymmetry of_a_pot() {
  ShapeSymmetry shape;
  shape.symmetries.discrete.emplace_back(Eigen::Translation3d(0.01, 0.0, 0.0) *
                                         Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  shape.nearly_round = ContinuousSymmetry{Eigen::Vector3d(0.6, 0.0, 0.8), Eigen::Vector3d(0.0, 0.002, 0.0)};
  return shape;
}

TEST(ObjectStore, ShapeSymmetriesComeBackWhereTheyAreKnown) {
  const fs::path folder = whole_store("store_shapes");
  ObjectStore store = read_store(folder);
  EXPECT_TRUE(store.shape_symmetries().empty()) << "of a store that was taught before they were looked for";
  store.objects[0].shape_symmetry = of_a_pot();
  store.objects[1].shape_symmetry = ShapeSymmetry{};
  store.objects[1].shape_symmetry->symmetries.continuous.push_back({});
  write_store_json(store);
  const std::map<std::string, ShapeSymmetry> read = read_store(folder).shape_symmetries();
  const ShapeSymmetry& pot = read.at("mug");
  ASSERT_EQ(pot.symmetries.discrete.size(), 1U);
  EXPECT_TRUE(pot.symmetries.discrete[0].isApprox(of_a_pot().symmetries.discrete[0], 1e-12));
  EXPECT_TRUE(pot.symmetries.continuous.empty());
  ASSERT_TRUE(pot.nearly_round.has_value());
  EXPECT_TRUE(pot.nearly_round->axis.isApprox(of_a_pot().nearly_round->axis));
  EXPECT_TRUE(pot.nearly_round->offset.isApprox(of_a_pot().nearly_round->offset));
  EXPECT_EQ(read.at("brick").symmetries.continuous.size(), 1U);
  EXPECT_FALSE(read.at("brick").nearly_round.has_value());
  store.objects[0].shape_symmetry = ShapeSymmetry{};
  write_store_json(store);
  ASSERT_EQ(read_store(folder).shape_symmetries().count("mug"), 1U) << "none is known, too";
  EXPECT_TRUE(read_store(folder).shape_symmetries().at("mug").symmetries.empty());
}

TEST(ObjectStore, BadShapeSymmetriesAreRefusedInOneLine) {
  const fs::path folder = whole_store("store_bad_shapes");
  ObjectStore store = read_store(folder);
  store.objects[0].shape_symmetry = of_a_pot();
  write_store_json(store);
  const std::string good = read_text(folder / "store.json");
  const nlohmann::json list = nlohmann::json::parse(good);
  const auto expect_refused = [&](const std::function<void(nlohmann::json&)>& damage,
                                  const std::vector<std::string>& said) {
    nlohmann::json damaged = list;
    damage(damaged["objects"][0]["shape_symmetries"]);
    write_text(folder / "store.json", damaged.dump());
    const std::string error = error_of_reading(folder);
    expect_says(error, {"store.json object 2"});
    expect_says(error, said);
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  };
  expect_refused([](nlohmann::json& shape) { shape = "round"; }, {"'shape_symmetries' is \"round\", expected lists"});
  expect_refused([](nlohmann::json& shape) { shape["nearly_rounf"] = 1; }, {"'nearly_rounf'", "expected one of"});
  expect_refused([](nlohmann::json& shape) { shape["symmetries_discrete"][0][0] = 2.0; }, {"expected rigid motions"});
  expect_refused(
      [](nlohmann::json& shape) {
        shape["nearly_round"]["axis"] = {0, 0, 0};
      },
      {"'axis' of 'nearly_round' has length 0"});
  expect_refused([](nlohmann::json& shape) { shape["nearly_round"] = 7; }, {"axis"});
}

TEST(ObjectStore, AToneIsARangeOfGreyValuesOrHoldsEveryImage) {
  const fs::path folder = whole_store("store_tone");
  ObjectStore store = read_store(folder);
  EXPECT_EQ(store.tone.min_mean, 0.0F);
  EXPECT_EQ(store.tone.max_mean, 255.0F);
  store.tone = {90.0F, 120.0F, 45.0F};
  write_store_json(store);
  EXPECT_EQ(read_store(folder).tone.max_mean, 120.0F);
  EXPECT_EQ(read_store(folder).tone.max_deviation, 45.0F);
  store.tone.min_mean = 121.0F;
  write_store_json(store);
  expect_says(error_of_reading(folder),
              {"store.json: 'tone': least_mean 121, expected no more than the most_mean of 120"});
  replace_in_file(folder / "store.json", "121.0", "\"dark\"");
  expect_says(error_of_reading(folder), {"store.json", "least_mean"});
  nlohmann::json without = read_json_object(folder / "store.json");
  without.erase("tone");
  write_text(folder / "store.json", without.dump());
  EXPECT_EQ(read_store(folder).tone.max_deviation, 255.0F);
}

// Keys that may be missing would be ignored silently.
TEST(ObjectStore, ADamagedNameOfAValueIsRefused) {
  const std::vector<std::vector<std::string>> damaged = {
      {"store.json", "\"tone\"", "\"tonf\""},
      {"store.json", "\"settings\"", "\"settingc\""},
      {"store.json", "\"vote_centre_m\"", "\"vote_centre_l\""},
      {"store.json", "\"quality\"", "\"qualitx\""},
      {"models/models_info.json", "\"symmetries_discrete\"", "\"symmetries_discretd\""},
      {"models/models_info.json", "\"min_x\"", "\"min_X\""}};
  for (const std::vector<std::string>& change : damaged) {
    const fs::path folder = whole_store("store_names_of_values");
    replace_in_file(folder / change[0], change[1], change[2]);
    const std::string quoted = "'" + change[2].substr(1, change[2].size() - 2) + "'";
    expect_says(error_of_reading(folder), {(folder / change[0]).string(), quoted, "expected one of"});
  }
}

TEST(ObjectStore, ANameIsUtf8) {
  EXPECT_EQ(error_of([] { require_utf8_name("größe 4 \xe6\x9d\xaf", "a.ply"); }), "");
  EXPECT_EQ(error_of([] { require_utf8_name("m\xfcg", "a.ply"); }),
            "a.ply: the name 'm\\xfcg' is not UTF-8, expected one that JSON can hold");
}

TEST(ObjectStore, ANewNameIsAWordThatListsAndFilesCanHold) {
  for (const std::string& good : {std::string("mug"), std::string("tasse-4_größe.b"), std::string(100, 'x')})
    EXPECT_EQ(error_of([&] { require_new_name(good, "a.ply"); }), "") << good;
  const std::vector<std::string> bad = {
      "", " ", "a b", "a,b", "a/b", "a\\b", "a=b", "../x", "a\nb", "a\tb", std::string(101, 'x')};
  for (const std::string& name : bad)
    expect_says(error_of([&] { require_new_name(name, "a.ply"); }),
                {"a.ply: the name '", "expected a word of at most 100"});
  expect_says(error_of([] { require_new_name("m\xfcg", "a.ply"); }), {"is not UTF-8"});
}

TEST(ObjectStore, PartsThatContradictOneAnotherAreRefused) {
  const fs::path names = whole_store("store_names");
  replace_in_file(names / "models" / "names.json", "brick", "stone");
  expect_says(error_of_reading(names), {"names.json", "'stone'", "expected 'brick'"});
  const fs::path number = whole_store("store_number");
  replace_in_file(number / "models" / "models_info.json", "\"2\": {", "\"3\": {");
  expect_says(error_of_reading(number), {"models_info.json", "no object 2", "expected 'mug'"});
  const fs::path twice = whole_store("store_twice");
  replace_in_file(twice / "store.json", "\"brick\"", "\"mug\"");
  expect_says(error_of_reading(twice), {"store.json", "'mug'", "expected one of each name"});
  const fs::path size = whole_store("store_size");
  replace_in_file(size / "models" / "models_info.json", "\"size_x\": 200", "\"size_x\": 300");
  expect_says(error_of_loading(size), {"obj_000005.ply", "200.0 x 200.0 x 200.0 mm", "300.0 x 200.0 x 200.0 mm"});
  const ObjectStore store = read_store(whole_store("store_forest"));
  EXPECT_EQ(error_of([&] { require_same_objects(store, 2, {"brick", "mug"}); }), "");
  expect_says(error_of([&] {
                require_same_objects(store, 2, {"brick", "bowl"});
              }),
              {"forest", "knows bowl, brick", "expected", "brick, mug"});
}

}  // namespace
}  // namespace houghstream::store
