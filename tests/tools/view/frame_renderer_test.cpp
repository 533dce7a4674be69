#include "tools/view/frame_renderer.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "pipeline/base/checks.hpp"
#include "tests/drivers/store/small_store.hpp"
#include "tests/tools/view/watched_bus.hpp"

namespace houghstream::view {
namespace {

FrameRendererSettings to_images(const std::string& name) {
  FrameRendererSettings settings;
  settings.outputs.images = fresh_folder("frame_show_" + name);
  return settings;
}

TEST(FrameRenderer, DrawsAFrameToTheFilesAskedFor) {
  WatchedBus watched;
  FrameRendererSettings settings = to_images("draws");
  FrameRenderer frame_show(settings);
  frame_show.show(matched_frame(5), watched.watcher);
  frame_show.finish();
  const cv::Mat image = cv::imread((settings.outputs.images / "5.jpg").string());
  const RgbdFrame frame = make_test_frame(5);
  EXPECT_GE(image.cols, 2 * frame.colour.cols) << "colour, and depth beside it";
  EXPECT_GT(image.rows, frame.colour.rows) << "and a panel below";
  EXPECT_TRUE(frame_show.handle_keys(watched.watcher)) << "without a window nobody asks to end";
  EXPECT_EQ(watched.last_words().frames_processed, 1);
}

TEST(FrameRenderer, APausedFrameIsSkipped) {
  WatchedBus watched;
  FrameRendererSettings settings = to_images("paused");
  settings.image.paused = true;
  FrameRenderer frame_show(settings);
  frame_show.show(matched_frame(5), watched.watcher);
  EXPECT_TRUE(std::filesystem::is_empty(settings.outputs.images));
  EXPECT_EQ(watched.last_words().frames_skipped, 1);
}

TEST(FrameRenderer, WhatCannotBeUnderstoodIsRefusedAndTheNextOneIsShown) {
  WatchedBus watched;
  FrameRendererSettings settings = to_images("refused");
  FrameRenderer frame_show(settings);
  MatchedFrame cut = matched_frame(5);
  cut.frame_bytes.resize(cut.frame_bytes.size() / 2);
  frame_show.show(cut, watched.watcher);
  frame_show.show(matched_frame_without_camera(6), watched.watcher);
  EXPECT_TRUE(std::filesystem::is_empty(settings.outputs.images));
  frame_show.show(matched_frame(7), watched.watcher);
  EXPECT_TRUE(std::filesystem::exists(settings.outputs.images / "7.jpg"));
  const status_t status = watched.last_words();
  EXPECT_EQ(status.frames_refused, 2);
  EXPECT_EQ(status.frames_processed, 1);
}

TEST(FrameRenderer, ACameraMayBeGivenForFramesWithoutOne) {
  WatchedBus watched;
  FrameRendererSettings settings = to_images("camera");
  settings.camera = make_test_frame(1).camera;
  FrameRenderer frame_show(settings);
  frame_show.show(matched_frame_without_camera(6), watched.watcher);
  EXPECT_TRUE(std::filesystem::exists(settings.outputs.images / "6.jpg"));
}

TEST(FrameRenderer, ASnapshotAloneIsSoonComplete) {
  WatchedBus watched;
  FrameRendererSettings settings;
  settings.outputs.snapshot = fresh_folder("frame_show_snapshot") / "shot.png";
  FrameRenderer frame_show(settings);
  EXPECT_FALSE(frame_show.complete());
  frame_show.show(matched_frame(5), watched.watcher);
  EXPECT_TRUE(frame_show.complete());
}

TEST(FrameRenderer, ARowOrAColumnOfPixelsIsDrawnEverywhereAndEndsNothing) {
  for (const cv::Size size : {cv::Size(16384, 1), cv::Size(1, 16384)}) {
    for (const bool show_3d : {false, true}) {
      WatchedBus watched;
      FrameRendererSettings settings = to_images("long");
      settings.outputs.snapshot = settings.outputs.images / "shot.jpg";
      settings.outputs.video = settings.outputs.images / "video.mp4";
      settings.preview = true;
      settings.image.show_3d = show_3d;
      settings.image.show_world = !show_3d;
      FrameRenderer frame_show(settings);
      MatchedFrame odd = matched_frame(5);
      odd.frame_bytes = encode_message(to_message(make_test_frame(5, size.width, size.height), WireFormat{}, 0));
      odd.slot = 0;
      frame_show.show(odd, watched.watcher);
      MatchedFrame usual = matched_frame(6);
      usual.slot = 1;
      frame_show.show(usual, watched.watcher);
      frame_show.finish();
      for (const char* file : {"shot.jpg", "video.mp4", "5.jpg", "6.jpg"})
        EXPECT_TRUE(std::filesystem::exists(settings.outputs.images / file)) << file << size;
      EXPECT_EQ(watched.last_words().frames_processed, 2) << size;
    }
  }
}

/// Returns the fraction of the image in which two files differ.
double difference(const FrameRendererSettings& settings, int one, int other) {
  const auto read = [&](int utime) {
    return cv::imread((settings.outputs.images / (std::to_string(utime) + ".jpg")).string());
  };
  cv::Mat different;
  cv::absdiff(read(one)(cv::Rect(0, 0, 64, 48)), read(other)(cv::Rect(0, 0, 64, 48)), different);
  return cv::mean(different > 40)[0] / 255.0;
}

TEST(FrameRenderer, AStoreThatChangesIsFollowed) {
  WatchedBus watched;
  FrameRendererSettings settings = to_images("store");
  settings.objects = store::whole_store("frame_show_objects");
  FrameRenderer frame_show(settings);
  const auto show = [&](int utime) {
    MatchedFrame matched = matched_frame(utime);
    Detections detections;
    detections.frame = matched.id;
    detections.detections.resize(1);
    detections.detections[0].class_id = 1;
    detections.detections[0].class_name = "plate";
    detections.detections[0].box_px = {10.0F, 10.0F, 20.0F, 20.0F};
    ObjectPoses poses;
    poses.frame = matched.id;
    poses.poses.resize(1);
    poses.poses[0].class_id = 1;
    poses.poses[0].class_name = "plate";
    poses.poses[0].detection_index = 0;
    poses.poses[0].status = PoseStatus::kValid;
    poses.poses[0].T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.6));
    matched.results.add(std::move(detections));
    matched.results.add(std::move(poses));
    frame_show.show(matched, watched.watcher);
  };
  show(1);
  store::exchange(settings.objects, "plate");
  int utime = 2;
  for (show(utime); difference(settings, 1, utime) == 0.0 && utime < 100; show(++utime))
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_GT(difference(settings, 1, utime), 0.0) << "an outline and axes as long as the model";
  settings.models = settings.objects + "/models";
  EXPECT_THROW(FrameRenderer{settings}, InputError) << "one of both";
}

TEST(FrameRenderer, WithoutModelsWhatIsFollowedIsShownToo) {
  WatchedBus watched;
  FrameRendererSettings settings = to_images("followed");
  FrameRenderer frame_show(settings);
  frame_show.show(matched_frame(1), watched.watcher);
  MatchedFrame matched = matched_frame(2);
  ObjectPoses followed;
  followed.frame = matched.id;
  followed.poses.resize(1);
  followed.poses[0].class_id = 1;
  followed.poses[0].class_name = "plate";
  followed.poses[0].detection_index = -1;
  followed.poses[0].status = PoseStatus::kValid;
  followed.poses[0].T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.6));
  matched.results.add(std::move(followed));
  frame_show.show(matched, watched.watcher);
  EXPECT_GT(difference(settings, 1, 2), 0.0);
}

TEST(FrameRenderer, NoModelsOrNoImageAtAllIsAnError) {
  FrameRendererSettings settings = to_images("none");
  FrameRenderer frame_show(settings);
  EXPECT_THROW(frame_show.finish(), InputError);
  settings.models = "/no/such/models";
  EXPECT_THROW(FrameRenderer{settings}, InputError);
}

}  // namespace
}  // namespace houghstream::view
