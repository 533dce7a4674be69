#include "drivers/store/store_watcher.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <houghstream/status_t.hpp>
#include <new>

#include "pipeline/base/log_line.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/process/detect_process.hpp"
#include "tests/drivers/store/small_store.hpp"
#include "tests/pipeline/process_test.hpp"

namespace houghstream::store {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

constexpr milliseconds kPeriod(10);

/// Loads the name of the store's second object.
using Second = StoreWatcher<std::string>;

std::shared_ptr<const std::string> load_second(const ObjectStore& store) {
  load_store_meshes(store);
  return std::make_shared<const std::string>(store.objects.at(1).name);
}

bool comes_true(const std::function<bool()>& what) {
  for (int i = 0; i < 1000 && !what(); ++i) std::this_thread::sleep_for(milliseconds(5));
  return what();
}

std::vector<std::string> names_of(const KnownObjects& known) {
  std::vector<std::string> names;
  for (const KnownObject& object : known.objects) names.push_back(object.name);
  return names;
}

/// Returns how often the words occur in the text.
int count_of(const std::string& text, const std::string& words) {
  int count = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
  return count;
}

TEST(StoreWatcher, WhatIsAddedRenamedAndRemovedIsThere) {
  const fs::path folder = whole_store("watch_change");
  Second watch(folder, load_second);
  watch.follow(kPeriod);
  const KnownObjects first = watch.known();
  EXPECT_EQ(first.store, folder.string());
  EXPECT_EQ(names_of(first), (std::vector<std::string>{"mug", "brick"}));
  EXPECT_GT(first.since_utime, 1600000000000000);
  EXPECT_EQ(first.objects[0].since_utime, first.since_utime);
  const std::shared_ptr<const std::string> in_use = watch.current();

  exchange(folder, "bowl");
  ASSERT_TRUE(comes_true([&] { return *watch.current() == "bowl"; }));
  const KnownObjects second = watch.known();
  EXPECT_EQ(names_of(second), (std::vector<std::string>{"mug", "bowl"}));
  EXPECT_EQ(second.objects[0].since_utime, first.objects[0].since_utime) << "it was known all the time";
  EXPECT_EQ(second.objects[1].since_utime, second.since_utime);
  EXPECT_GT(second.since_utime, first.since_utime);
  EXPECT_EQ(second.problem, "");
  EXPECT_EQ(*in_use, "brick") << "who uses the old one may finish";
}

TEST(StoreWatcher, AChangeIsSaid) {
  const fs::path folder = whole_store("watch_said");
  start_log("drivers_tests", LogLevel::kInfo);
  testing::internal::CaptureStderr();
  {
    Second watch(folder, load_second);
    watch.follow(kPeriod);
    exchange(folder, "bowl");
    EXPECT_TRUE(comes_true([&] { return *watch.current() == "bowl"; }));
  }
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("2 objects from here on; new: bowl; gone: brick"), std::string::npos) << said;
}

TEST(StoreWatcher, LoadingDoesNotKeepAProcessFromEnding) {
  const fs::path folder = whole_store("watch_end");
  std::atomic<int> done{0};
  {
    bool first = true;
    Second watch(folder, [&](const ObjectStore& store) {
      if (!std::exchange(first, false)) {
        parallel_for(2, 3000, [&](int) {
          std::this_thread::sleep_for(milliseconds(10));
          ++done;
        });
      }
      return load_second(store);
    });
    watch.follow(kPeriod);
    exchange(folder, "bowl");
    ASSERT_TRUE(comes_true([&] { return done > 2; }));
  }
  EXPECT_LT(done, 2000) << "half a minute of work is given up";
}

TEST(StoreWatcher, WithoutFollowingItStays) {
  const fs::path folder = whole_store("watch_still");
  const Second watch(folder, load_second);
  exchange(folder, "bowl");
  std::this_thread::sleep_for(milliseconds(100));
  EXPECT_EQ(*watch.current(), "brick");
  EXPECT_NE(error_of([&] { const Second none(folder.parent_path(), load_second); }), "")
      << "at the start a fault ends it";
}

TEST(StoreWatcher, ABadOneKeepsTheOldAndIsSaidOnce) {
  const fs::path folder = whole_store("watch_bad");
  start_log("drivers_tests", LogLevel::kInfo);
  testing::internal::CaptureStderr();
  {
    Second watch(folder, load_second);
    watch.follow(kPeriod);
    write_text(folder / "models" / "obj_000005.ply", "ply\n");
    ASSERT_TRUE(comes_true([&] { return !watch.known().problem.empty(); }));
    EXPECT_NE(watch.known().problem.find("obj_000005.ply"), std::string::npos) << watch.known().problem;
    EXPECT_EQ(*watch.current(), "brick");
    EXPECT_EQ(names_of(watch.known()), (std::vector<std::string>{"mug", "brick"}));
    std::this_thread::sleep_for(10 * kPeriod);

    const std::string text = read_text(folder / "store.json");
    write_text(folder / "store.json", text.substr(0, text.size() / 2));
    ASSERT_TRUE(comes_true([&] { return watch.known().problem.find("cut short") != std::string::npos; }));
    fs::rename(folder, folder.parent_path() / "elsewhere");
    ASSERT_TRUE(comes_true([&] { return watch.known().problem.find("no such folder") != std::string::npos; }));
    EXPECT_EQ(*watch.current(), "brick");

    fs::create_directories(folder);
    fill_store(folder, "bowl");
    ASSERT_TRUE(comes_true([&] { return *watch.current() == "bowl"; }));
    EXPECT_TRUE(comes_true([&] { return watch.known().problem.empty(); }));
  }
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(count_of(said, "what was known stays"), 3) << said;
  EXPECT_EQ(count_of(said, "obj_000005.ply"), 1) << said;
  EXPECT_EQ(count_of(said, "2 objects from here on; new: bowl; gone: brick"), 1) << said;
}

/// Makes a store of two groups, in a folder of its own; the bricks' forest is torn.
fs::path store_with_torn_group(const std::string& name) {
  const fs::path folder = whole_store(name);
  ObjectStore store = read_store(folder);
  for (StoredObject& object : store.objects) object.group = object.id;
  fs::create_directories(store.forests_folder());
  write_text(store.forest_file(2), "a forest");
  write_text(store.forest_file(5), "a fo");
  write_store_json(store);
  return folder;
}

/// Loads the names of the objects whose groups' forests are whole.
Loaded<std::string> load_whole_groups(const ObjectStore& store) {
  std::string names;
  std::vector<GroupFault> faults;
  for (const StoredObject& object : store.objects) {
    const fs::path file = store.forest_file(object.group);
    if (read_text(file) == "a forest") {
      names += object.name + " ";
    } else {
      faults.push_back({object.group, file.string() + ": torn"});
    }
  }
  return {std::make_shared<const std::string>(names), faults};
}

TEST(StoreWatcher, ATornGroupIsSaidAndTheOthersAreKnown) {
  const fs::path folder = store_with_torn_group("watch_torn");
  StoreWatcher<std::string> watch(folder, load_whole_groups);
  EXPECT_EQ(*watch.current(), "mug ");
  EXPECT_EQ(names_of(watch.known()), std::vector<std::string>{"mug"});
  EXPECT_NE(watch.known().problem.find("forests/000005: torn; without it brick"), std::string::npos)
      << watch.known().problem;
  EXPECT_NE(error_of([&] { watch.require_store(); }).find("forests/000005: torn"), std::string::npos);
  watch.follow(kPeriod);
  write_text(read_store(folder).forest_file(5), "a forest");
  ASSERT_TRUE(comes_true([&] { return *watch.current() == "mug brick "; }));
  EXPECT_TRUE(comes_true([&] { return watch.known().problem.empty(); }));
  EXPECT_EQ(names_of(watch.known()), (std::vector<std::string>{"mug", "brick"}));
  write_text(read_store(folder).forest_file(2), "");
  ASSERT_TRUE(comes_true([&] { return !watch.known().problem.empty(); }));
  EXPECT_EQ(*watch.current(), "mug brick ") << "what was known of the torn group stays";
}

TEST(StoreWatcher, OneThatIsNotThereYetIsAwaited) {
  const fs::path folder = fresh_folder("watch_awaited") / "store";
  Second watch(folder, load_second);
  watch.follow(kPeriod);
  EXPECT_EQ(watch.current(), nullptr);
  EXPECT_TRUE(watch.known().objects.empty());
  EXPECT_NE(watch.known().problem.find("not there yet"), std::string::npos) << watch.known().problem;
  exchange(folder, "bowl");
  ASSERT_TRUE(comes_true([&] { return watch.current() != nullptr; }));
  EXPECT_EQ(*watch.current(), "bowl");
  ASSERT_TRUE(comes_true([&] { return watch.known().problem.empty(); }));
  EXPECT_EQ(names_of(watch.known()), (std::vector<std::string>{"mug", "bowl"}));
  EXPECT_NE(error_of([&] { const Second none(folder / "no" / "such", load_second); }), "") << "nor could it be made";
}

TEST(StoreWatcher, WhatCannotBeLoadedForAMomentIsTriedAgain) {
  const fs::path folder = whole_store("watch_transient");
  start_log("drivers_tests", LogLevel::kInfo);
  testing::internal::CaptureStderr();
  {
    std::atomic<int> failures{0};
    Second watch(folder, [&](const ObjectStore& store) {
      if (store.objects.at(1).name == "bowl" && failures++ < 3) {
        if (failures == 1) throw std::bad_alloc();
        fail("{}: Too many open files", store.forest_file(2).string());
      }
      return load_second(store);
    });
    watch.follow(kPeriod);
    exchange(folder, "bowl");
    ASSERT_TRUE(comes_true([&] { return failures >= 3; }));
    EXPECT_EQ(*watch.current(), "brick");
    EXPECT_TRUE(comes_true([&] { return *watch.current() == "bowl"; })) << "nothing has changed but the memory";
    EXPECT_TRUE(comes_true([&] { return watch.known().problem.empty(); }));
  }
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(count_of(said, "not enough memory"), 1) << said;
  EXPECT_EQ(count_of(said, "Too many open files"), 1) << "the second time is not said: " << said;
}

TEST(StoreWatcher, OneThatIsMissingIsSaidToBeMissingOnceMoreWithWhatLiesNear) {
  const fs::path folder = whole_store("watch_near");
  fs::rename(folder, folder.parent_path() / "my_store");
  fs::copy(folder.parent_path() / "my_store", folder.parent_path() / "old.store", fs::copy_options::recursive);
  fs::create_directories(folder.parent_path() / "recordings");
  fs::create_directories(folder.parent_path() / ".my_store.partial-1");
  write_text(folder.parent_path() / "store.json", "{}");
  start_log("drivers_tests", LogLevel::kInfo);
  testing::internal::CaptureStderr();
  {
    Second watch(folder, load_second);
    watch.follow(milliseconds(1));
    EXPECT_TRUE(comes_true([&] { return watch.known().problem.find("my_store, old.store") != std::string::npos; }));
    std::this_thread::sleep_for(milliseconds(100));
    fs::rename(folder.parent_path() / "my_store", folder);
    EXPECT_TRUE(comes_true([&] { return watch.current() != nullptr; }));
  }
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(count_of(said, "not there yet"), 1) << said;
  EXPECT_EQ(count_of(said, "still not there"), 1) << said;
  EXPECT_NE(said.find("in " + folder.parent_path().string() + " lies my_store, old.store\n"), std::string::npos)
      << said;
}

TEST(StoreWatcher, OfTwoStoresAtOnceNothingIsTaken) {
  const fs::path folder = whole_store("watch_mixed");
  std::atomic<bool> exchanges{false};
  Second watch(folder, [&](const ObjectStore& store) {
    if (exchanges.exchange(false)) exchange(folder, "plate");  // after the list was read
    return load_second(store);
  });
  watch.follow(kPeriod);
  exchanges = true;
  exchange(folder, "bowl");
  ASSERT_TRUE(comes_true([&] { return *watch.current() != "brick"; }));
  EXPECT_EQ(*watch.current(), "plate") << "the list of one with the meshes of another is no store";
}

/// Frames at 30 Hz while stores are exchanged and loaded, which takes a third of a second: none waits for it.
TEST(StoreWatcher, NoFrameIsLostAndHardlyOnePassedOverWhileAStoreIsReplaced) {
  const fs::path folder = whole_store("watch_stream");
  Second watch(folder, [](const ObjectStore& store) {
    std::this_thread::sleep_for(milliseconds(330));
    return load_second(store);
  });
  watch.follow(kPeriod);
  ProcessOnMemq test({channel::kDetections, channel::kStatus, channel::kKnownObjects});
  DetectProcessOptions options;
  options.objects = [&] { return watch.known(); };
  test.start([&](LcmBus& bus) {
    run_detect_process(bus, options, [&](const RgbdFrame& frame) {
      Detection detection;
      detection.class_id = 1;
      detection.class_name = *watch.current();
      detection.box_px = {1, 2, 3, 4};
      return Detections{frame.id, {detection}, frame.stages};
    });
  });
  constexpr std::int64_t kFrames = 75;
  for (std::int64_t i = 0; i < kFrames; ++i) {
    if (i == 15) exchange(folder, "bowl");
    if (i == 45) exchange(folder, "plate");
    test.bus.publish(channel::kFrame, to_message(make_test_frame(1000 + i), WireFormat{}, i));
    std::this_thread::sleep_for(milliseconds(33));
  }
  ASSERT_TRUE(test.wait_for(channel::kDetections, kFrames - 2));
  const auto name_in = [&](std::size_t i) {
    return test.at<detections_t>(channel::kDetections, i).detections[0].class_name;
  };
  EXPECT_EQ(name_in(0), "brick");
  EXPECT_EQ(name_in(test.count(channel::kDetections) - 1), "plate");
  test.stop();
  test.bus.handle(milliseconds(50));  // receives messages sent after the last status
  const auto status = test.last<status_t>(channel::kStatus);
  EXPECT_EQ(status.frames_lost, 0);
  EXPECT_EQ(status.frames_refused, 0);
  EXPECT_LE(status.frames_skipped, 2);
  EXPECT_EQ(status.frames_received, kFrames);
  const auto known = test.last<known_objects_t>(channel::kKnownObjects);
  EXPECT_EQ(known.process, "hs-detect");
  EXPECT_EQ(known.pid, getpid());
  ASSERT_EQ(known.n_objects, 2);
  EXPECT_EQ(known.object_names[1], "plate");
  EXPECT_GT(known.object_since_utimes[1], known.object_since_utimes[0]);
}

}  // namespace
}  // namespace houghstream::store
