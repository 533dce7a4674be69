#include "tools/log/export_frames.hpp"

#include <gtest/gtest.h>

#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"
#include "tests/tools/log/recordings.hpp"

namespace houghstream::log_tools {
namespace {

namespace fs = std::filesystem;

RecordingSettings two_frames(const fs::path& folder) {
  RecordingSettings settings;
  settings.source = log_of(folder, 2, "FRAMES", foreign_images);
  return settings;
}

TEST(ExportFrames, PngsHaveAListOfTheirTimesAndNeedNoCamera) {
  const fs::path folder = fresh_folder("export_list");
  LossReport losses;
  EXPECT_EQ(export_pngs(two_frames(folder), folder / "deep/png", losses), 2);
  EXPECT_EQ(read_text(folder / "deep/png/frames.csv"),
            "frame,utime,timestamp\n"
            "000000,1500000000000000,1500000000000000\n"
            "000001,1500000000033000,1500000000066000\n");
  EXPECT_EQ(losses.line(), "");
}

TEST(ExportFrames, ASceneNeedsACameraForEachFrame) {
  const fs::path folder = fresh_folder("export_camera");
  RecordingSettings settings = two_frames(folder);
  LossReport without;
  EXPECT_THROW(export_bop(settings, folder / "none", without), InputError);
  EXPECT_EQ(without.refused(), 2);
  settings.camera = make_test_frame(0).camera;
  LossReport with;
  EXPECT_EQ(export_bop(settings, folder / "bop", with), 2);
  EXPECT_EQ(with.refused(), 0);
  const BopScene scene(folder / "bop");
  ASSERT_EQ(scene.images().size(), 2U);
  EXPECT_EQ(scene.read_frame(1).camera, *settings.camera);
}

TEST(ExportFrames, AFolderThatCannotBeWrittenIsAnError) {
  const fs::path folder = fresh_folder("export_refused");
  write_text(folder / "file", "");
  LossReport losses;
  EXPECT_THROW(export_pngs(two_frames(folder), folder / "file/png", losses), InputError);
  EXPECT_THROW(export_bop(two_frames(folder), folder / "file/bop", losses), InputError);
}

TEST(ExportFrames, NothingIsMixedWithAnotherExport) {
  const fs::path folder = fresh_folder("export_twice");
  RecordingSettings settings = two_frames(folder);
  settings.camera = make_test_frame(0).camera;
  fs::create_directories(folder / "png");
  write_text(folder / "png/notes.txt", "mine");
  LossReport losses;
  EXPECT_EQ(export_pngs(settings, folder / "png", losses), 2) << "what is no picture may be there";
  EXPECT_EQ(export_bop(settings, folder / "bop", losses), 2);
  fs::rename(folder / "png/000001_color.png", folder / "png/000007_color.png");
  EXPECT_THROW(export_pngs(settings, folder / "png", losses), InputError);
  EXPECT_THROW(export_bop(settings, folder / "bop", losses), InputError);
  EXPECT_FALSE(fs::exists(folder / "png/000001_color.png")) << "nothing has changed";
}

}  // namespace
}  // namespace houghstream::log_tools
