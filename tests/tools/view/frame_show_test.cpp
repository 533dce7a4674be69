#include "tools/view/frame_show.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "pipeline/base/checks.hpp"
#include "tests/drivers/test_files.hpp"
#include "tests/tools/view/watched_bus.hpp"

namespace houghstream::view {
namespace {

ShowSettings to_pictures(const std::string& name) {
  ShowSettings settings;
  settings.outputs.pictures = fresh_folder("frame_show_" + name);
  return settings;
}

TEST(FrameShow, DrawsAFrameToTheFilesAskedFor) {
  WatchedBus watched;
  ShowSettings settings = to_pictures("draws");
  FrameShow frame_show(settings);
  frame_show.show(matched_frame(5), watched.watcher);
  frame_show.finish();
  const cv::Mat picture = cv::imread((settings.outputs.pictures / "5.jpg").string());
  const RgbdFrame frame = make_test_frame(5);
  EXPECT_GE(picture.cols, 2 * frame.colour.cols) << "colour, and depth beside it";
  EXPECT_GT(picture.rows, frame.colour.rows) << "and a panel below";
  EXPECT_TRUE(frame_show.handle_keys(watched.watcher)) << "without a window nobody asks to end";
  EXPECT_EQ(watched.last_words().frames_processed, 1);
}

TEST(FrameShow, APausedFrameIsSkipped) {
  WatchedBus watched;
  ShowSettings settings = to_pictures("paused");
  settings.picture.paused = true;
  FrameShow frame_show(settings);
  frame_show.show(matched_frame(5), watched.watcher);
  EXPECT_TRUE(std::filesystem::is_empty(settings.outputs.pictures));
  EXPECT_EQ(watched.last_words().frames_skipped, 1);
}

TEST(FrameShow, WhatCannotBeUnderstoodIsRefusedAndTheNextOneIsShown) {
  WatchedBus watched;
  ShowSettings settings = to_pictures("refused");
  FrameShow frame_show(settings);
  MatchedFrame cut = matched_frame(5);
  cut.frame_bytes.resize(cut.frame_bytes.size() / 2);
  frame_show.show(cut, watched.watcher);
  frame_show.show(matched_frame_without_camera(6), watched.watcher);
  EXPECT_TRUE(std::filesystem::is_empty(settings.outputs.pictures));
  frame_show.show(matched_frame(7), watched.watcher);
  EXPECT_TRUE(std::filesystem::exists(settings.outputs.pictures / "7.jpg"));
  const status_t status = watched.last_words();
  EXPECT_EQ(status.frames_refused, 2);
  EXPECT_EQ(status.frames_processed, 1);
}

TEST(FrameShow, ACameraMayBeGivenForFramesWithoutOne) {
  WatchedBus watched;
  ShowSettings settings = to_pictures("camera");
  settings.camera = make_test_frame(1).camera;
  FrameShow frame_show(settings);
  frame_show.show(matched_frame_without_camera(6), watched.watcher);
  EXPECT_TRUE(std::filesystem::exists(settings.outputs.pictures / "6.jpg"));
}

TEST(FrameShow, ASnapshotAloneIsSoonComplete) {
  WatchedBus watched;
  ShowSettings settings;
  settings.outputs.snapshot = fresh_folder("frame_show_snapshot") / "shot.png";
  FrameShow frame_show(settings);
  EXPECT_FALSE(frame_show.complete());
  frame_show.show(matched_frame(5), watched.watcher);
  EXPECT_TRUE(frame_show.complete());
}

TEST(FrameShow, NoModelsOrNoPictureAtAllIsAnError) {
  ShowSettings settings = to_pictures("none");
  FrameShow frame_show(settings);
  EXPECT_THROW(frame_show.finish(), InputError);
  settings.models = "/no/such/models";
  EXPECT_THROW(FrameShow{settings}, InputError);
}

}  // namespace
}  // namespace houghstream::view
