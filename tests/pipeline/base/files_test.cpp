#include "pipeline/base/files.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  Files() : folder(fs::temp_directory_path() / ("files_test." + std::to_string(getpid()))) {
    fs::remove_all(folder);
    fs::create_directories(folder);
    file = folder / "out.txt";
  }
  ~Files() override { fs::remove_all(folder); }

  void put(const std::string& text) const { std::ofstream(file) << text; }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }

  fs::path folder;
  fs::path file;
};

TEST_F(Files, AreWhatTheyWereUntilThePublishing) {
  put("old");
  AtomicFile whole(file);
  std::ofstream(whole.partial()) << "new";
  EXPECT_EQ(read_file(file, "text"), "old");
  whole.commit();
  EXPECT_EQ(read_file(file, "text"), "new");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(Files, StayWhatTheyWereWhereItFails) {
  put("old");
  { const AtomicFile whole(file); }
  EXPECT_EQ(read_file(file, "text"), "old");
  EXPECT_EQ(entries(), 1U) << "the partial file is left";
  EXPECT_THROW(write_file_atomically(folder / "no" / "such" / "folder", "text"), InputError);
  EXPECT_THROW(write_file_atomically(folder, "text"), InputError);
}

TEST_F(Files, ClearWhatAKilledProgramLeft) {
  std::ofstream(file.string() + ".partial") << "half of an earlier one, longer than what comes";
  write_file_atomically(file, "new");
  EXPECT_EQ(read_file(file, "text"), "new");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(Files, HaveOneWriterAtATime) {
  const AtomicFile first(file);
  EXPECT_THROW(AtomicFile{file}, InputError);
}

TEST_F(Files, MayBeKeptInParts) {
  AtomicFile whole(file);
  std::ofstream(whole.partial()) << "a half";
  whole.keep_partial();
  EXPECT_EQ(read_file(file.string() + ".partial", "text"), "a half");
}

TEST_F(Files, MayBeKeptWhereTheyCannotBePublished) {
  const std::string partial = file.string() + ".partial";
  {
    AtomicFile whole(file);
    std::ofstream(whole.partial()) << "cannot be had again";
    fs::create_directory(file);
    EXPECT_THROW(whole.commit(), InputError);
    EXPECT_TRUE(fs::exists(partial));
    whole.keep_partial();
  }
  EXPECT_EQ(read_file(partial, "text"), "cannot be had again");
  fs::remove(file);
  {
    AtomicFile whole(file);
    fs::create_directory(file);
    EXPECT_THROW(whole.commit(), InputError);
  }
  EXPECT_FALSE(fs::exists(partial)) << "nobody has kept it";
}

TEST_F(Files, KeepLinksAndRights) {
  put("old");
  chmod(file.c_str(), 0640);
  const fs::path link = folder / "link";
  fs::create_symlink(file, link);
  write_file_atomically(link, "new");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_file(file, "text"), "new");
  struct stat is {};
  ASSERT_EQ(stat(file.c_str(), &is), 0);
  EXPECT_EQ(is.st_mode & 0777U, 0640U);
}

TEST_F(Files, EmptyNothingThatALinkBesideThemNames) {
  const fs::path other = folder / "other";
  std::ofstream(other) << "of somebody";
  fs::create_symlink(other, file.string() + ".partial");
  EXPECT_THROW(write_file_atomically(file, "new"), InputError);
  EXPECT_EQ(read_file(other, "text"), "of somebody");
  EXPECT_TRUE(fs::is_symlink(file.string() + ".partial"));
}

TEST_F(Files, NeverReplaceADevice) {
  EXPECT_NO_THROW(write_file_atomically("/dev/null", "text"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_THROW(write_file_atomically("/dev/full", "text"), InputError);
}

TEST_F(Files, AreNotTheirOwnSource) {
  put("old");
  const fs::path link = folder / "link";
  fs::create_symlink(file, link);
  EXPECT_THROW(require_other_file(link, file), InputError);
  EXPECT_NO_THROW(require_other_file(folder / "other", file));
  fs::rename(file, folder / "other.partial");
  EXPECT_THROW(require_other_file(folder / "other", folder / "other.partial"), InputError) << "it would be emptied";
  fs::create_symlink(folder / "target", folder / "linked");
  std::ofstream(folder / "target.partial") << "kept";
  std::ofstream(folder / "target") << "old";
  EXPECT_THROW(require_other_file(folder / "linked", folder / "target.partial"), InputError);
}

TEST_F(Files, DoNotLieInTheirSource) {
  put("old");
  fs::create_directories(folder / "scene" / "rgb");
  fs::create_directory_symlink(folder / "scene", folder / "link");
  for (const char* name : {"scene", "scene/", "scene/new", "scene/rgb/new", "scene/no/such", "link/new"}) {
    EXPECT_THROW(require_other_file(folder / name, folder / "scene"), InputError) << name;
    EXPECT_THROW(require_other_file(folder / name, folder / "link"), InputError) << name;
  }
  for (const char* name : {"", "out.txt", "scene_2", "scene.lcmlog", "no/such"})
    EXPECT_NO_THROW(require_other_file(name[0] == 0 ? fs::path() : folder / name, folder / "scene")) << name;
  EXPECT_NO_THROW(require_other_file(folder / "new", folder / "no such folder"));
  fs::create_symlink(folder / "elsewhere", folder / "scene" / "out");
  std::ofstream(folder / "elsewhere") << "old";
  EXPECT_NO_THROW(require_other_file(folder / "scene" / "out", folder / "scene")) << "it is written elsewhere";
}

TEST_F(Files, AreKnownToBeWritableBeforeTheyAreWritten) {
  put("old");
  for (const fs::path& good : {file, folder / "new", fs::path("new"), fs::path("/dev/null")})
    EXPECT_NO_THROW(require_writable(good)) << good;
  for (const fs::path& bad : {folder, folder / "no" / "new", file / "new", fs::path()})
    EXPECT_THROW(require_writable(bad), InputError) << bad;
  for (const fs::path& good : {folder, folder / "new", folder / "new" / "deep" / "", fs::path("new")})
    EXPECT_NO_THROW(require_writable_folder(good)) << good;
  for (const fs::path& bad : {file, file / "new", file / "", fs::path("/dev/null/new"), fs::path()})
    EXPECT_THROW(require_writable_folder(bad), InputError) << bad;
  EXPECT_EQ(entries(), 1U) << "nothing is made";
  EXPECT_EQ(read_file(file, "text"), "old");
}

TEST_F(Files, AreNoPipes) {
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(read_file(pipe, "text"), InputError);  // and does not wait for a writer
  EXPECT_THROW(read_file(folder, "text"), InputError);
  EXPECT_THROW(read_file(folder / "none", "text"), InputError);
}

}  // namespace
}  // namespace houghstream
