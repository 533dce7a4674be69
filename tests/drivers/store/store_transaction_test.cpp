#include "drivers/store/store_transaction.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "tests/drivers/store/small_store.hpp"
#include "tests/expect_says.hpp"

namespace houghstream::store {
namespace {

namespace fs = std::filesystem;

TEST(StoreTransaction, TheOldStoreStaysWholeUntilTheNewOneIs) {
  const fs::path folder = whole_store("store_swap");
  {
    StoreTransaction build(folder);
    fill_store(build.folder(), "bowl");
    EXPECT_EQ(read_store(folder).objects[1].name, "brick") << "before it is published";
    build.commit();
  }
  EXPECT_EQ(read_store(folder).objects[1].name, "bowl");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.parent_path()), {}), 1) << "nothing is left beside it";
}

TEST(StoreTransaction, WhatIsGivenUpLeavesNothing) {
  const fs::path folder = whole_store("store_given_up");
  {
    StoreTransaction build(folder);
    write_text(build.folder() / "forest", "half");
  }
  EXPECT_EQ(read_store(folder).objects[1].name, "brick");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.parent_path()), {}), 1);
}

TEST(StoreTransaction, WhatAnInterruptedTeachingLeftIsRemoved) {
  const fs::path folder = whole_store("store_interrupted");
  const fs::path left = folder.parent_path() / ".store.partial-99999999";
  fs::create_directories(left / "models");
  const StoreTransaction build(folder);
  EXPECT_FALSE(fs::exists(left));
  EXPECT_EQ(read_store(folder).objects[1].name, "brick");
  fs::remove_all(build.folder());
}

TEST(StoreTransaction, AnOldStoreThatWasPutAsideComesBack) {
  const fs::path folder = whole_store("store_aside");
  fs::rename(folder, folder.parent_path() / ".store.before");
  const StoreTransaction build(folder);
  EXPECT_EQ(read_store(folder).objects[1].name, "brick");
}

TEST(StoreTransaction, OneAtATimeAndNothingElseIsReplaced) {
  const fs::path folder = whole_store("store_alone");
  const StoreTransaction first(folder);
  expect_says(error_of([&] { StoreTransaction second(folder); }), {folder.string(), "another teaching"});
  const fs::path other = fresh_folder("store_other");
  write_text(other / "holiday.jpg", "");
  expect_says(error_of([&] { StoreTransaction build(other); }), {other.string(), "not replaced"});
  EXPECT_TRUE(fs::exists(other / "holiday.jpg"));
  EXPECT_NO_THROW(require_place_for_store(folder)) << "whoever works on it";
  expect_says(error_of([&] { require_place_for_store(other); }), {other.string(), "not replaced"});
  expect_says(error_of([&] { require_place_for_store("/dev/null/store"); }), {"/dev/null", "cannot be a folder"});
}

TEST(StoreTransaction, AStoreJsonOfAnybodyElseMakesNoStore) {
  const fs::path shop = fresh_folder("store_shop");
  write_text(shop / "store.json", "{\"opens\": 9}");
  EXPECT_FALSE(is_replaceable(shop));
  expect_says(error_of([&] { StoreTransaction build(shop); }),
              {shop.string(), "holds no store.json of an object store"});
  const fs::path torn = whole_store("store_torn");
  const std::string text = read_text(torn / "store.json");
  write_text(torn / "store.json", text.substr(0, text.size() / 2));
  EXPECT_TRUE(is_replaceable(torn)) << "what is left of a store";
}

/// Runs in another process: writes 'y' where it holds the store, else 'n', and holds it until `accept_poor_model` is
/// closed.
[[noreturn]] void begin_and_tell(const fs::path& folder, int told, int accept_poor_model) {
  const auto tell = [&](char byte) {
    if (write(told, &byte, 1) != 1) _exit(2);
  };
  try {
    const StoreTransaction build(folder);
    tell('y');
    char byte = 0;
    while (read(accept_poor_model, &byte, 1) > 0) continue;
  } catch (const InputError&) {
    tell('n');
  } catch (...) {
    _exit(3);
  }
  _exit(0);
}

TEST(StoreTransaction, OfManyThatBeginTogetherOneWorks) {
  constexpr int kMany = 8;
  const fs::path folder = whole_store("store_together");
  for (int round = 0; round < 20; ++round) {
    int told[2];
    int accept_poor_model[2];
    ASSERT_EQ(pipe(told), 0);
    ASSERT_EQ(pipe(accept_poor_model), 0);
    std::vector<pid_t> children;
    for (int i = 0; i < kMany; ++i) {
      const pid_t child = fork();
      if (child == 0) {
        close(accept_poor_model[1]);
        begin_and_tell(folder, told[1], accept_poor_model[0]);
      }
      children.push_back(child);
    }
    close(told[1]);
    std::string answers;
    for (char byte = 0; static_cast<int>(answers.size()) < kMany && read(told[0], &byte, 1) == 1;) answers += byte;
    for (const int file : {told[0], accept_poor_model[0], accept_poor_model[1]}) close(file);
    for (const pid_t child : children) waitpid(child, nullptr, 0);
    EXPECT_EQ(answers.size(), static_cast<std::size_t>(kMany)) << "round " << round;
    EXPECT_EQ(std::count(answers.begin(), answers.end(), 'y'), 1) << "round " << round;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.parent_path()), {}), 1) << "nothing is left beside it";
}

TEST(StoreTransaction, AStoreThatALinkNamesIsExchangedWhereItLies) {
  const fs::path folder = whole_store("store_linked");
  const fs::path link = folder.parent_path() / "link";
  fs::create_directory_symlink(folder, link);
  exchange(link, "bowl");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_store(folder).objects[1].name, "bowl");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.parent_path()), {}), 2);
  fs::remove_all(folder);
  expect_says(error_of([&] { StoreTransaction build(link); }), {link.string(), "a symbolic link to nothing"});
}

TEST(StoreTransaction, WhoReadsBeforeItsChangesBringsTheOldOneBack) {
  const fs::path folder = whole_store("store_brought_back");
  const fs::path aside = folder.parent_path() / ".store.before";
  fs::rename(folder, aside);
  recover_store(folder);
  EXPECT_FALSE(fs::exists(aside));
  EXPECT_EQ(read_store(folder).objects[1].name, "brick");
  recover_store(folder.parent_path() / "nowhere");
  EXPECT_FALSE(fs::exists(folder.parent_path() / "nowhere")) << "nothing is made";
  const StoreTransaction at_work(folder);
  fs::rename(folder, aside);
  expect_says(error_of([&] { recover_store(folder); }), {folder.string(), "another teaching"});
  EXPECT_TRUE(fs::exists(aside)) << "he puts his own there in a moment";
}

/// Puts foreign files into a store's folder: beside the store's, among them, in folders, and links.
void put_foreign_files(const fs::path& store) {
  fs::create_directories(store / "recordings" / "monday" / "empty");
  write_text(store / "NOTES.txt", "the handle faces left");
  write_text(store / "recordings" / "monday" / "take.lcmlog", "events");
  write_text(store / "recordings" / "store.json", "of a recording");
  write_text(store / "models" / "mug.blend", "source of the mesh");
  write_text(store / ".hidden", "of a tool");
  fs::create_symlink("recordings/monday/take.lcmlog", store / "newest");
  fs::create_directory_symlink("/usr", store / "elsewhere");
  ASSERT_EQ(mkfifo((store / "pipe").c_str(), 0600), 0);
  chmod((store / "recordings").c_str(), 0750);
}

void expect_foreign_files(const fs::path& store) {
  EXPECT_EQ(read_text(store / "NOTES.txt"), "the handle faces left");
  EXPECT_EQ(read_text(store / "recordings" / "monday" / "take.lcmlog"), "events");
  EXPECT_EQ(read_text(store / "recordings" / "store.json"), "of a recording");
  EXPECT_EQ(read_text(store / "models" / "mug.blend"), "source of the mesh");
  EXPECT_EQ(read_text(store / ".hidden"), "of a tool");
  EXPECT_TRUE(fs::is_directory(store / "recordings" / "monday" / "empty"));
  EXPECT_TRUE(fs::is_symlink(store / "newest"));
  EXPECT_EQ(read_text(store / "newest"), "events") << "a relative link leads to where it led";
  EXPECT_EQ(fs::read_symlink(store / "elsewhere"), "/usr");
  EXPECT_TRUE(fs::is_fifo(store / "pipe"));
  EXPECT_EQ(fs::status(store / "recordings").permissions(), fs::perms(0750));
}

TEST(StoreTransaction, SomebodysFilesInAStoreStay) {
  const fs::path folder = whole_store("store_foreign");
  put_foreign_files(folder);
  for (const char* second : {"bowl", "plate", "dish"}) {
    exchange(folder, second);
    EXPECT_EQ(read_store(folder).objects[1].name, second);
    expect_foreign_files(folder);
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.parent_path()), {}), 1) << "nothing is left beside it";
}

TEST(StoreTransaction, WhatIsWrittenIntoAStoreWhileANewOneIsMadeStays) {
  const fs::path folder = whole_store("store_foreign_late");
  fs::create_directories(folder / "recordings");
  std::ofstream growing(folder / "recordings" / "take.partial");
  StoreTransaction build(folder);
  fill_store(build.folder(), "bowl");
  growing << "first " << std::flush;
  write_text(folder / "recordings" / "second", "late");
  build.commit();
  growing << "last" << std::flush;
  EXPECT_EQ(read_text(folder / "recordings" / "take.partial"), "first last") << "who writes it goes on";
  EXPECT_EQ(read_text(folder / "recordings" / "second"), "late");
}

TEST(StoreTransaction, PartsOfTheOldStoreDoNotStay) {
  const fs::path folder = whole_store("store_own_parts");
  write_text(folder / "models" / "obj_000009.ply", "of an object that was removed");
  write_text(folder / "models" / "obj_000009.png", "its texture");
  fs::create_directories(folder / "views");
  write_text(folder / "views" / "obj_000009.png", "its views");
  write_text(folder / "forest.partial", "of a killed writer");
  exchange(folder, "bowl");
  for (const char* file : {"models/obj_000009.ply", "models/obj_000009.png", "views/obj_000009.png", "forest.partial"})
    EXPECT_FALSE(fs::exists(folder / file)) << file;
}

TEST(StoreTransaction, SomebodysFilesInWhatAnInterruptedTeachingLeftComeBack) {
  const fs::path folder = whole_store("store_foreign_left");
  const fs::path left = folder.parent_path() / ".store.partial-99999999";
  for (const fs::path& old : {left, folder.parent_path() / ".store.before"}) {
    fs::create_directories(old);
    fill_store(old, "bowl");
    write_text(old / "NOTES.txt", "the handle faces left");
    fs::create_directories(old / "recordings");
    write_text(old / "recordings" / (old.filename().string() + ".lcmlog"), "events");
  }
  write_text(left / "forest.partial", "half");
  { const StoreTransaction build(folder); }
  EXPECT_EQ(read_store(folder).objects[1].name, "brick");
  EXPECT_EQ(read_text(folder / "NOTES.txt"), "the handle faces left");
  EXPECT_EQ(read_text(folder / "recordings" / ".store.partial-99999999.lcmlog"), "events");
  EXPECT_EQ(read_text(folder / "recordings" / ".store.before.lcmlog"), "events");
  EXPECT_FALSE(fs::exists(folder / "forest.partial"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.parent_path()), {}), 1) << "nothing is left beside it";
}

/// Returns the error of a StoreTransaction for a store in a folder without write permission, for a user who is not
/// root.
std::string said_of_shut_folder() {
  const fs::path folder = whole_store("store_foreign_shut");
  fs::create_directories(folder / "recordings");
  fs::permissions(folder / "recordings", fs::perms(0500));
  const std::string said = error_of([&] { const StoreTransaction build(folder); });
  fs::permissions(folder / "recordings", fs::perms(0700));
  const std::string later = error_of([&] { const StoreTransaction build(folder); });
  return said + "\n" + later;
}

TEST(StoreTransaction, WhatCannotBeTakenAlongIsRefusedBeforeTheWork) {
  constexpr uid_t kNobody = 65534;
  fs::remove_all(fresh_folder("store_foreign_shut"));
  int told[2];
  ASSERT_EQ(pipe(told), 0);
  const pid_t child = fork();
  if (child == 0) {
    if (geteuid() == 0 && setresuid(kNobody, kNobody, kNobody) != 0) _exit(2);  // root may do everything
    const std::string said = said_of_shut_folder();
    _exit(write(told[1], said.data(), said.size()) == static_cast<ssize_t>(said.size()) ? 0 : 3);
  }
  close(told[1]);
  std::string said(4096, '\0');
  said.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read(told[0], said.data(), said.size()))));
  close(told[0]);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  const std::size_t end = said.find('\n');
  expect_says(said.substr(0, end), {"store/recordings", "Permission denied", "expected"});
  EXPECT_EQ(said.substr(std::min(end, said.size())), "\n") << "and then it is not";
}

TEST(StoreTransaction, WhoeverIsKilledAtAnyMomentLeavesSomebodysFiles) {
  const fs::path folder = whole_store("store_foreign_killed");
  put_foreign_files(folder);
  for (int i = 0; i < 60; ++i) {
    const std::string second = "thing_" + std::to_string(i);
    const pid_t child = fork();
    if (child == 0) {
      exchange(folder, second);
      _exit(0);
    }
    usleep(static_cast<useconds_t>(i * 60));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    expect_foreign_files(folder);
    if (HasFailure()) return;
  }
  exchange(folder, "last");
  expect_foreign_files(folder);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.parent_path()), {}), 1) << "nothing is left beside it";
}

/// Returns the name of the second object; throws where any part of the store is missing or of another one.
std::string second_of(const fs::path& folder) {
  const ObjectStore store = read_store(folder);
  load_store_meshes(store);
  return store.objects.at(1).name;
}

TEST(StoreTransaction, WhoeverIsKilledAtAnyMomentLeavesAWholeStore) {
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
