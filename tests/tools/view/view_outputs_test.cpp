#include "tools/view/view_outputs.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/base/checks.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream::view {
namespace {

namespace fs = std::filesystem;

cv::Mat grey(int level) {
  return cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(level));
}

int level_of(const fs::path& file) {
  return static_cast<int>(cv::imread(file.string()).at<cv::Vec3b>(0, 0)[0]);
}

TEST(ViewOutputs, SnapshotIsTheImageAskedForAndThenAllIsDone) {
  const fs::path folder = fresh_folder("view_outputs_snapshot");
  OutputSettings settings;
  settings.snapshot = folder / "shot.png";
  settings.snapshot_after = 2;
  ViewOutputs outputs(settings);
  outputs.add(grey(10), 1, 0);
  EXPECT_FALSE(outputs.complete());
  outputs.add(grey(20), 2, 1);
  EXPECT_TRUE(outputs.complete());
  outputs.add(grey(30), 3, 2);
  outputs.finish();
  EXPECT_EQ(level_of(settings.snapshot), 20);
}

TEST(ViewOutputs, AFolderThatIsNotThereIsNotMadeForAFile) {
  const fs::path folder = fresh_folder("view_outputs_no_folder");
  OutputSettings snapshot;
  snapshot.snapshot = folder / "nosuch" / "dir" / "x.png";
  OutputSettings video;
  video.video = folder / "nosuch" / "x.mp4";
  OutputSettings images;
  images.images = folder / "nosuch" / "pictures";
  for (const OutputSettings& settings : {snapshot, video, images})
    expect_says(error_of([&] { ViewOutputs{settings}; }), {"nosuch", "found no folder", "expected one that is there"});
  EXPECT_FALSE(fs::exists(folder / "nosuch"));
  images.images = folder / "pictures/";
  const ViewOutputs outputs(images);
  EXPECT_TRUE(fs::is_directory(folder / "pictures"));
}

TEST(ViewOutputs, AVideoThatNobodyCanPlayIsRefused) {
  OutputSettings settings;
  for (const char* name : {"x.bmp", "x.png", "x", "x.mp3"}) {
    settings.video = fresh_folder("view_outputs_no_video") / name;
    expect_says(error_of([&] { ViewOutputs{settings}; }),
                {name, "no name of a video, expected one that ends with .mp4"});
    EXPECT_FALSE(fs::exists(settings.video));
  }
}

TEST(ViewOutputs, SnapshotOfAShortStreamIsItsLastImage) {
  OutputSettings settings;
  settings.snapshot = fresh_folder("view_outputs_short") / "shot.png";
  settings.snapshot_after = 100;
  ViewOutputs outputs(settings);
  outputs.add(grey(10), 1, 0);
  outputs.add(grey(20), 2, 1);
  outputs.finish();
  EXPECT_EQ(level_of(settings.snapshot), 20);
}

TEST(ViewOutputs, VideoAndImagesGoOnAfterTheSnapshot) {
  const fs::path folder = fresh_folder("view_outputs_all");
  OutputSettings settings;
  settings.snapshot = folder / "shot.png";
  settings.video = folder / "video.mp4";
  settings.images = folder / "pictures";
  ViewOutputs outputs(settings);
  outputs.add(grey(10), 111, 0);
  EXPECT_FALSE(outputs.complete());
  outputs.add(grey(20), 222, 1);
  outputs.finish();
  EXPECT_NEAR(level_of(settings.images / "222.jpg"), 20, 2);
  EXPECT_GT(fs::file_size(settings.video), 0U);
}

TEST(ViewOutputs, WhatIsThereStays) {
  const fs::path folder = fresh_folder("view_outputs_again");
  OutputSettings settings;
  settings.snapshot = folder / "shot.png";
  settings.video = folder / "video.mp4";
  settings.images = folder / "pictures";
  for (const int level : {10, 60, 110}) {
    settings.replace = level == 110;
    ViewOutputs outputs(settings);
    outputs.add(grey(level), 222, 0);
    outputs.finish();
  }
  EXPECT_NEAR(level_of(settings.images / "222.jpg"), 110, 2);
  EXPECT_NEAR(level_of(settings.images / "222_2.jpg"), 60, 2);
  EXPECT_EQ(level_of(settings.snapshot), 110);
  EXPECT_EQ(level_of(folder / "shot_2.png"), 60);
  EXPECT_FALSE(fs::exists(folder / "shot_3.png"));
  EXPECT_TRUE(fs::exists(settings.video) && fs::exists(folder / "video_2.mp4"));
  EXPECT_FALSE(fs::exists(folder / "video_3.mp4"));
}

TEST(ViewOutputs, NoFrameAtAllOrABadPathIsAnError) {
  OutputSettings settings;
  settings.snapshot = fresh_folder("view_outputs_bad") / "shot.png";
  EXPECT_THROW(ViewOutputs(settings).finish(), InputError);
  settings.snapshot = fresh_folder("view_outputs_bad") / "shot.nosuchformat";
  EXPECT_THROW(ViewOutputs{settings}, InputError);
  settings.snapshot = "/proc/nowhere/shot.png";
  EXPECT_THROW(ViewOutputs{settings}, InputError);
  const fs::path folder = fresh_folder("view_outputs_bad");
  fs::create_directories(folder / "folder.png");
  settings.snapshot = folder / "folder.png";
  EXPECT_THROW(ViewOutputs{settings}, InputError);
  settings.snapshot.clear();
  settings.video = folder / "noext";
  EXPECT_THROW(ViewOutputs{settings}, InputError);
}

}  // namespace
}  // namespace houghstream::view
