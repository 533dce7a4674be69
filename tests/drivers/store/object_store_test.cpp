#include "drivers/store/object_store.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

#include "tests/drivers/store/small_store.hpp"

namespace houghstream::store {
namespace {

namespace fs = std::filesystem;

std::string error_of_reading(const fs::path& folder) {
  return error_of([&] { read_store(folder); });
}

std::string error_of_loading(const fs::path& folder) {
  return error_of([&] { load_store_meshes(read_store(folder)); });
}

void expect_says(const std::string& error, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_NE(error.find(part), std::string::npos) << part << " in: " << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
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
}

TEST(ObjectStore, AnObjectThatIsNotThereIsNamedBesideThoseThatAre) {
  const fs::path folder = whole_store("store_called");
  const ObjectStore store = read_store(folder);
  EXPECT_EQ(object_called(store, "brick").id, 5);
  EXPECT_EQ(error_of([&] { object_called(store, "drill"); }),
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
  expect_says(error_of_reading(folder), {"store.json", "version 7", "expected 1"});
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

TEST(ObjectStore, AToneIsARangeOfGreyValuesOrHoldsEveryPicture) {
  const fs::path folder = whole_store("store_tone");
  ObjectStore store = read_store(folder);
  EXPECT_EQ(store.tone.least_mean, 0.0F);
  EXPECT_EQ(store.tone.most_mean, 255.0F);
  store.tone = {90.0F, 120.0F, 45.0F};
  write_store_json(store);
  EXPECT_EQ(read_store(folder).tone.most_mean, 120.0F);
  EXPECT_EQ(read_store(folder).tone.most_deviation, 45.0F);
  store.tone.least_mean = 121.0F;
  write_store_json(store);
  expect_says(error_of_reading(folder), {"store.json: 'tone' is {", "121.0", "expected grey values of 0 to 255"});
  replace_in_file(folder / "store.json", "121.0", "\"dark\"");
  expect_says(error_of_reading(folder), {"store.json", "least_mean"});
  replace_in_file(folder / "store.json", "\"tone\": {", "\"old\": {");
  EXPECT_EQ(read_store(folder).tone.most_deviation, 255.0F);
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
  const fs::path twice = whole_store("store_twice");
  replace_in_file(twice / "store.json", "\"brick\"", "\"mug\"");
  expect_says(error_of_reading(twice), {"store.json", "'mug'", "expected one of each name"});
  const fs::path size = whole_store("store_size");
  replace_in_file(size / "models" / "models_info.json", "\"size_x\": 200", "\"size_x\": 300");
  expect_says(error_of_loading(size), {"obj_000005.ply", "200.0 x 200.0 x 200.0 mm", "300.0 x 200.0 x 200.0 mm"});
  const ObjectStore store = read_store(whole_store("store_forest"));
  EXPECT_EQ(error_of([&] { require_same_objects(store, {"brick", "mug"}); }), "");
  expect_says(error_of([&] {
                require_same_objects(store, {"brick", "bowl"});
              }),
              {"forest", "knows bowl, brick", "expected", "brick, mug"});
}

TEST(StoreBuild, TheOldStoreStaysWholeUntilTheNewOneIs) {
  const fs::path folder = whole_store("store_swap");
  {
    StoreBuild build(folder);
    fill_store(build.folder(), "bowl");
    EXPECT_EQ(read_store(folder).objects[1].name, "brick") << "before it is published";
    build.publish();
  }
  EXPECT_EQ(read_store(folder).objects[1].name, "bowl");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.parent_path()), {}), 1) << "nothing is left beside it";
}

TEST(StoreBuild, WhatIsGivenUpLeavesNothing) {
  const fs::path folder = whole_store("store_given_up");
  {
    StoreBuild build(folder);
    write_text(build.folder() / "forest", "half");
  }
  EXPECT_EQ(read_store(folder).objects[1].name, "brick");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.parent_path()), {}), 1);
}

TEST(StoreBuild, WhatAnInterruptedTeachingLeftIsRemoved) {
  const fs::path folder = whole_store("store_interrupted");
  const fs::path left = folder.parent_path() / ".store.partial-99999999";
  fs::create_directories(left / "models");
  const StoreBuild build(folder);
  EXPECT_FALSE(fs::exists(left));
  EXPECT_EQ(read_store(folder).objects[1].name, "brick");
  fs::remove_all(build.folder());
}

TEST(StoreBuild, AnOldStoreThatWasPutAsideComesBack) {
  const fs::path folder = whole_store("store_aside");
  fs::rename(folder, folder.parent_path() / ".store.before");
  const StoreBuild build(folder);
  EXPECT_EQ(read_store(folder).objects[1].name, "brick");
}

TEST(StoreBuild, OneAtATimeAndNothingElseIsReplaced) {
  const fs::path folder = whole_store("store_alone");
  const StoreBuild first(folder);
  expect_says(error_of([&] { StoreBuild second(folder); }), {folder.string(), "another teaching"});
  const fs::path other = fresh_folder("store_other");
  write_text(other / "holiday.jpg", "");
  expect_says(error_of([&] { StoreBuild build(other); }), {other.string(), "not replaced"});
  EXPECT_TRUE(fs::exists(other / "holiday.jpg"));
  EXPECT_NO_THROW(require_place_for_store(folder)) << "whoever works on it";
  expect_says(error_of([&] { require_place_for_store(other); }), {other.string(), "not replaced"});
  expect_says(error_of([&] { require_place_for_store("/dev/null/store"); }), {"/dev/null", "cannot be a folder"});
}

TEST(StoreBuild, AStoreJsonOfAnybodyElseMakesNoStore) {
  const fs::path shop = fresh_folder("store_shop");
  write_text(shop / "store.json", "{\"opens\": 9}");
  EXPECT_FALSE(may_be_replaced(shop));
  expect_says(error_of([&] { StoreBuild build(shop); }), {shop.string(), "holds no store.json of an object store"});
  const fs::path torn = whole_store("store_torn");
  const std::string text = read_text(torn / "store.json");
  write_text(torn / "store.json", text.substr(0, text.size() / 2));
  EXPECT_TRUE(may_be_replaced(torn)) << "what is left of a store";
}

/// Of another process: says 'y' where it works on the store, else 'n', and works until `go_on` is closed.
[[noreturn]] void begin_and_tell(const fs::path& folder, int told, int go_on) {
  const auto tell = [&](char byte) {
    if (write(told, &byte, 1) != 1) _exit(2);
  };
  try {
    const StoreBuild build(folder);
    tell('y');
    char byte = 0;
    while (read(go_on, &byte, 1) > 0) continue;
  } catch (const InputError&) {
    tell('n');
  } catch (...) {
    _exit(3);
  }
  _exit(0);
}

TEST(StoreBuild, OfManyThatBeginTogetherOneWorks) {
  constexpr int kMany = 8;
  const fs::path folder = whole_store("store_together");
  for (int round = 0; round < 20; ++round) {
    int told[2];
    int go_on[2];
    ASSERT_EQ(pipe(told), 0);
    ASSERT_EQ(pipe(go_on), 0);
    std::vector<pid_t> children;
    for (int i = 0; i < kMany; ++i) {
      const pid_t child = fork();
      if (child == 0) {
        close(go_on[1]);
        begin_and_tell(folder, told[1], go_on[0]);
      }
      children.push_back(child);
    }
    close(told[1]);
    std::string answers;
    for (char byte = 0; static_cast<int>(answers.size()) < kMany && read(told[0], &byte, 1) == 1;) answers += byte;
    for (const int file : {told[0], go_on[0], go_on[1]}) close(file);
    for (const pid_t child : children) waitpid(child, nullptr, 0);
    EXPECT_EQ(answers.size(), static_cast<std::size_t>(kMany)) << "round " << round;
    EXPECT_EQ(std::count(answers.begin(), answers.end(), 'y'), 1) << "round " << round;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.parent_path()), {}), 1) << "nothing is left beside it";
}

TEST(StoreBuild, AStoreThatALinkNamesIsExchangedWhereItLies) {
  const fs::path folder = whole_store("store_linked");
  const fs::path link = folder.parent_path() / "link";
  fs::create_directory_symlink(folder, link);
  exchange(link, "bowl");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_store(folder).objects[1].name, "bowl");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.parent_path()), {}), 2);
  fs::remove_all(folder);
  expect_says(error_of([&] { StoreBuild build(link); }), {link.string(), "a symbolic link to nothing"});
}

TEST(StoreBuild, WhoReadsBeforeItsChangesBringsTheOldOneBack) {
  const fs::path folder = whole_store("store_brought_back");
  const fs::path aside = folder.parent_path() / ".store.before";
  fs::rename(folder, aside);
  bring_back_store(folder);
  EXPECT_FALSE(fs::exists(aside));
  EXPECT_EQ(read_store(folder).objects[1].name, "brick");
  bring_back_store(folder.parent_path() / "nowhere");
  EXPECT_FALSE(fs::exists(folder.parent_path() / "nowhere")) << "nothing is made";
  const StoreBuild at_work(folder);
  fs::rename(folder, aside);
  expect_says(error_of([&] { bring_back_store(folder); }), {folder.string(), "another teaching"});
  EXPECT_TRUE(fs::exists(aside)) << "he puts his own there in a moment";
}

/// The name of the second object; throws where any part of the store is missing or of another one.
std::string second_of(const fs::path& folder) {
  const ObjectStore store = read_store(folder);
  load_store_meshes(store);
  return store.objects.at(1).name;
}

TEST(StoreBuild, WhoeverIsKilledAtAnyMomentLeavesAWholeStore) {
  const fs::path folder = whole_store("store_killed");
  int published = 0;
  for (int i = 0; i < 60; ++i) {
    const std::string before = second_of(folder);
    const std::string after = "thing_" + std::to_string(i);
    const pid_t child = fork();
    if (child == 0) {
      exchange(folder, after);
      _exit(0);
    }
    usleep(static_cast<useconds_t>(i * 60));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const std::string now = second_of(folder);
    EXPECT_TRUE(now == before || now == after) << now;
    if (now == after) ++published;
  }
  EXPECT_LT(published, 60) << "some were killed before they were done";
  exchange(folder, "last");
  EXPECT_EQ(second_of(folder), "last");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.parent_path()), {}), 1) << "nothing is left beside it";
}

}  // namespace
}  // namespace houghstream::store
