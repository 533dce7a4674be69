#include "pipeline/base/recording_names.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include "pipeline/base/files.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

class RecordingNames : public testing::Test {
 protected:
  RecordingNames() : folder(fresh_folder("recording_names")), file(folder / "take.oni") {}
  ~RecordingNames() override { fs::remove_all(folder); }

  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
  void record(Existing existing, const std::string& text) const {
    AtomicFile whole(file, kPartialEnding, existing);
    write_text(whole.partial(), text);
    whole.commit();
  }

  fs::path folder;
  fs::path file;
};

TEST_F(RecordingNames, ANumberStandsBeforeTheExtension) {
  EXPECT_EQ(next_recording_name(file), file);
  write_text(file, "first");
  EXPECT_EQ(next_recording_name(file), folder / "take_2.oni");
  fs::create_symlink("nowhere", folder / "take_2.oni");
  EXPECT_EQ(next_recording_name(file), folder / "take_3.oni") << "a link is somebody's";
  write_text(folder / "log", "");
  EXPECT_EQ(next_recording_name(folder / "log"), folder / "log_2");
}

TEST_F(RecordingNames, WhatAKilledProgramLeftIsRenamedAndKept) {
  EXPECT_FALSE(keep_interrupted(file, ".partial"));
  write_text(file.string() + ".partial", "");
  EXPECT_FALSE(keep_interrupted(file, ".partial")) << "nothing was recorded";
  write_text(file.string() + ".partial", "a half");
  EXPECT_EQ(keep_interrupted(file, ".partial"), folder / "take.interrupted-1.oni");
  write_text(file.string() + ".partial", "another half");
  EXPECT_EQ(keep_interrupted(file, ".partial"), folder / "take.interrupted-2.oni");
  EXPECT_EQ(read_text(folder / "take.interrupted-1.oni"), "a half");
  EXPECT_EQ(read_text(folder / "take.interrupted-2.oni"), "another half");
  write_text(file.string() + ".partial.mkv", "of another format");
  EXPECT_EQ(keep_interrupted(file, ".partial.mkv"), folder / "take.interrupted-1.mkv");
}

TEST_F(RecordingNames, WhatIsStillBeingWrittenIsLeftAlone) {
  write_text(file.string() + ".partial", "a half");
  const int writer = open((file.string() + ".partial").c_str(), O_RDWR);
  ASSERT_EQ(flock(writer, LOCK_EX | LOCK_NB), 0);
  EXPECT_FALSE(keep_interrupted(file, ".partial"));
  EXPECT_THROW(record(Existing::kRecordingKept, "new"), InputError) << "another program is writing it";
  EXPECT_EQ(read_text(file.string() + ".partial"), "a half");
  close(writer);
}

TEST_F(RecordingNames, ARecordingLeavesWhatIsThere) {
  record(Existing::kRecordingKept, "first");
  record(Existing::kRecordingKept, "second");
  record(Existing::kRecordingKept, "third");
  EXPECT_EQ(read_text(file), "first");
  EXPECT_EQ(read_text(folder / "take_2.oni"), "second");
  EXPECT_EQ(read_text(folder / "take_3.oni"), "third");
  EXPECT_EQ(entries(), 3U);
}

TEST_F(RecordingNames, ReplacingReplacesWhatIsFinishedAndNothingThatWasInterrupted) {
  record(Existing::kRecordingKept, "first");
  write_text(file.string() + ".partial", "cannot be had again");
  record(Existing::kRecordingReplaced, "second");
  EXPECT_EQ(read_text(file), "second");
  EXPECT_EQ(read_text(folder / "take.interrupted-1.oni"), "cannot be had again");
  EXPECT_EQ(entries(), 2U);
}

TEST_F(RecordingNames, AFileThatComesMeanwhileStays) {
  AtomicFile whole(file, kPartialEnding, Existing::kRecordingKept);
  write_text(whole.partial(), "recorded");
  write_text(file, "of somebody else");
  whole.commit();
  EXPECT_EQ(read_text(file), "of somebody else");
  EXPECT_EQ(whole.file(), folder / "take_2.oni");
  EXPECT_EQ(read_text(whole.file()), "recorded");
}

TEST_F(RecordingNames, ALinkIsFollowedToWhatItNames) {
  fs::create_directory(folder / "disk");
  write_text(folder / "disk" / "real.oni", "first");
  fs::create_symlink(folder / "disk" / "real.oni", file);
  record(Existing::kRecordingKept, "second");
  EXPECT_EQ(read_text(file), "first");
  EXPECT_EQ(read_text(folder / "disk" / "real_2.oni"), "second");
}

TEST_F(RecordingNames, ADeviceIsWrittenAsItIs) {
  const AtomicFile whole("/dev/null", kPartialEnding, Existing::kRecordingKept);
  EXPECT_EQ(whole.partial(), "/dev/null");
}

}  // namespace
}  // namespace houghstream
