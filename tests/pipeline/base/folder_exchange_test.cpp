#include "pipeline/base/folder_exchange.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "pipeline/base/log_line.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

bool is_own(const fs::path& relative) {
  return relative == "list" || relative == "parts" || relative == "parts/1";
}

/// A folder that a program has made, with this text in its own files.
void make_folder(const fs::path& folder, const std::string& text) {
  fs::create_directories(folder / "parts");
  write_text(folder / "list", text);
  write_text(folder / "parts" / "1", text);
}

class FolderExchange : public testing::Test {
 protected:
  FolderExchange() : root(fresh_folder("folder_exchange")), place(root / "place"), made(root / ".made") {
    make_folder(place, "old");
    make_folder(made, "new");
  }

  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(root), fs::directory_iterator()));
  }

  fs::path root;
  fs::path place;
  fs::path made;
};

TEST_F(FolderExchange, TakesForeignEntriesAlong) {
  write_text(place / "notes", "mine");
  write_text(place / "parts" / "2", "mine");
  fs::create_directories(place / "mine" / "list");
  write_text(place / "mine" / "list" / "list", "mine");
  struct stat before {};
  ASSERT_EQ(stat((place / "notes").c_str(), &before), 0);
  exchange_folder(made, place, is_own);
  EXPECT_EQ(read_text(place / "list"), "new");
  EXPECT_EQ(read_text(place / "parts" / "1"), "new");
  EXPECT_EQ(read_text(place / "parts" / "2"), "mine");
  EXPECT_EQ(read_text(place / "mine" / "list" / "list"), "mine") << "in a foreign folder all is foreign";
  struct stat after {};
  ASSERT_EQ(stat((place / "notes").c_str(), &after), 0);
  EXPECT_EQ(after.st_ino, before.st_ino) << "it is the same file";
  EXPECT_EQ(after.st_nlink, 1U);
  EXPECT_EQ(entries(), 1U);
}

TEST_F(FolderExchange, MakesAPlaceWhereNoneIs) {
  fs::remove_all(place);
  exchange_folder(made, place, is_own);
  EXPECT_EQ(read_text(place / "list"), "new");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(FolderExchange, KeepsWhatItCannotTakeAlongAndReportsIt) {
  write_text(place / "mine", "a file");
  fs::create_directories(made / "mine");  // by a later version of the program, say
  start_log("folder_exchange_test", LogLevel::kInfo);
  testing::internal::CaptureStderr();
  exchange_folder(made, place, is_own);
  const std::string said = testing::internal::GetCapturedStderr();
  expect_says(said.substr(0, said.find('\n')), {(made / "mine").string(), place.string(), "by hand"});
  EXPECT_EQ(read_text(place / "list"), "new");
  EXPECT_EQ(read_text(made / "mine"), "a file");
  expect_says(error_of([&] { remove_replaced(made, place, is_own); }), {(made / "mine").string()});
  EXPECT_EQ(read_text(made / "mine"), "a file");
}

TEST_F(FolderExchange, OfTwoVersionsTheNewerOneStays) {
  const fs::path left = root / ".left";
  make_folder(left, "older");
  const auto put = [](const fs::path& file, const std::string& text, int seconds) {
    write_text(file, text);
    const timespec times[2] = {{seconds, 0}, {seconds, 0}};
    ASSERT_EQ(utimensat(AT_FDCWD, file.c_str(), times, 0), 0);
  };
  put(place / "edited", "today", 2000000);
  put(left / "edited", "yesterday", 1000000);
  put(place / "saved", "yesterday", 1000000);
  put(left / "saved", "today", 2000000);
  put(left / "lost", "yesterday", 1000000);
  remove_replaced(left, place, is_own);
  EXPECT_EQ(read_text(place / "edited"), "today");
  EXPECT_EQ(read_text(place / "saved"), "today");
  EXPECT_EQ(read_text(place / "lost"), "yesterday");
  EXPECT_EQ(read_text(place / "list"), "old");
  EXPECT_FALSE(fs::exists(left));
}

TEST_F(FolderExchange, IsBroughtBackAfterACrashBetweenTwoMoves) {
  fs::rename(place, root / ".place.before");
  EXPECT_TRUE(has_replaced(place));
  restore_replaced(place, is_own);
  EXPECT_EQ(read_text(place / "list"), "old");
  fs::rename(place, root / ".place.before");
  write_text(root / ".place.before" / "notes", "mine");
  fs::rename(made, place);
  restore_replaced(place, is_own);
  EXPECT_EQ(read_text(place / "list"), "new");
  EXPECT_EQ(read_text(place / "notes"), "mine");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(FolderExchange, ALinkStaysALink) {
  const fs::path elsewhere = fresh_folder("folder_exchange_elsewhere");
  write_text(elsewhere / "data", "not ours");
  fs::create_directory_symlink(elsewhere, place / "linked");
  fs::remove_all(place / "parts");
  fs::create_directory_symlink(elsewhere, place / "parts");  // a link to a folder in its place
  exchange_folder(made, place, is_own);
  EXPECT_TRUE(fs::is_symlink(place / "linked"));
  EXPECT_FALSE(fs::is_symlink(place / "parts"));
  EXPECT_EQ(read_text(elsewhere / "data"), "not ours");
  EXPECT_EQ(entries(), 1U);
}

}  // namespace
}  // namespace houghstream
