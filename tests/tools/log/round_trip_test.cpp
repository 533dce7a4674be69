#include <gtest/gtest.h>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/datasets/bop_writer.hpp"
#include "drivers/files/image_file.hpp"
#include "drivers/frame_source.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/drivers/ros_bag/test_bag.hpp"
#include "tests/test_files.hpp"
#include "tests/tools/log/recordings.hpp"
#include "tools/log/export_frames.hpp"
#include "tools/log/recording.hpp"

// Whatever is imported and exported again is what it was: depth always, colour where nothing compressed it with loss.

namespace houghstream::log_tools {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 3;
const Camera kCamera = make_test_frame(0).camera;

/// Converts the source to a log, and the log to a BOP folder and to PNGs; both are compared with numbered_frame().
void expect_round_trip(const std::string& source, const fs::path& folder, bool lossless_colour) {
  fs::remove_all(folder / "bop");
  fs::remove_all(folder / "png");
  LossReport losses;
  RecordingSettings settings;
  settings.source = source;
  settings.camera = kCamera;
  ASSERT_EQ(import_log(settings, "FRAMES", folder / "imported.lcmlog", losses), kFrames);
  RecordingSettings imported;
  imported.source = (folder / "imported.lcmlog").string();
  ASSERT_EQ(export_bop(imported, folder / "bop", losses), kFrames);
  ASSERT_EQ(export_pngs(imported, folder / "png", losses), kFrames);
  EXPECT_EQ(losses.line(), "");
  const BopScene scene(folder / "bop");
  ASSERT_EQ(scene.images().size(), static_cast<std::size_t>(kFrames));
  for (int i = 0; i < kFrames; ++i) {
    const RgbdFrame frame = numbered_frame(i);
    const RgbdFrame back = scene.read_frame(static_cast<std::size_t>(i));
    EXPECT_TRUE(same_depth(back.depth, frame.depth)) << source << " frame " << i;
    EXPECT_EQ(back.camera, kCamera);
    const cv::Mat depth_mm = read_depth_image(folder / "png" / fmt::format("{:06d}_depth.png", i));
    EXPECT_EQ(cv::norm(depth_mm, depth_to_millimetres(frame.depth), cv::NORM_INF), 0.0);
    const cv::Mat colour = read_colour_image(folder / "png" / fmt::format("{:06d}_color.png", i));
    EXPECT_EQ(cv::norm(colour, back.colour, cv::NORM_INF), 0.0);
    const double difference = cv::norm(colour, frame.colour, cv::NORM_L1) / static_cast<double>(3 * colour.total());
    EXPECT_LE(difference, lossless_colour ? 0.0 : 8.0) << source << " frame " << i;
  }
}

TEST(RoundTrip, BotCoreLog) {
  const fs::path folder = fresh_folder("trip_bot_core");
  expect_round_trip(log_of(folder, kFrames, "OPENNI_FRAME", foreign_images), folder, true);
}

TEST(RoundTrip, KinectLog) {
  const fs::path folder = fresh_folder("trip_kinect");
  const auto raw = +[](const RgbdFrame& frame) { return kinect_message(frame, false); };
  expect_round_trip(log_of(folder, kFrames, "KINECT_FRAME", raw), folder, true);
  const auto compressed = +[](const RgbdFrame& frame) { return kinect_message(frame, true); };
  expect_round_trip(log_of(folder, kFrames, "KINECT_FRAME", compressed), folder, false);
}

TEST(RoundTrip, DrakeLog) {
  const fs::path folder = fresh_folder("trip_drake");
  expect_round_trip(log_of(folder, kFrames, "DRAKE_RGBD_CAMERA_IMAGES", drake_message), folder, true);
}

TEST(RoundTrip, Klg) {
  const fs::path folder = fresh_folder("trip_klg");
  for (const bool compressed : {false, true}) {
    KlgWriter writer(kFrames);
    for (int i = 0; i < kFrames; ++i) writer.add(numbered_frame(i), compressed);
    writer.save(folder / "a.klg");
    expect_round_trip((folder / "a.klg").string(), folder, !compressed);
  }
}

TEST(RoundTrip, BopFolder) {
  const fs::path folder = fresh_folder("trip_bop");
  BopWriter writer(folder / "original");
  for (int i = 0; i < kFrames; ++i) writer.add(numbered_frame(i), {}, {});
  writer.finish();
  expect_round_trip("bop:" + (folder / "original").string(), folder, true);
}

TEST(RoundTrip, RosBag) {
  const fs::path folder = fresh_folder("trip_bag");
  ros_bag::TestBag bag("lz4");
  for (int i = 0; i < kFrames; ++i) {
    const RgbdFrame frame = numbered_frame(i);
    const std::int64_t utime = std::int64_t{1'600'000'000'000'000} + 33'333 * i;
    const ros_bag::MessageHeader header = {utime, "camera"};
    bag.add("/rgb/camera_info", ros_bag::kCameraInfoType, ros_bag::camera_info_bytes(header, kCamera), utime);
    bag.add("/rgb/image", ros_bag::kImageType, ros_bag::image_bytes(header, frame.colour, "bgr8"), utime);
    bag.add("/depth/image", ros_bag::kImageType, ros_bag::image_bytes(header, frame.depth, "32FC1"), utime);
  }
  bag.save((folder / "a.bag").string());
  expect_round_trip((folder / "a.bag").string(), folder, true);
  expect_round_trip("bag:" + (folder / "a.bag").string() + ",depth=/depth/image", folder, true);
}

TEST(RoundTrip, UwFolderIsWhatPngExportWrites) {
  const fs::path folder = fresh_folder("trip_uw");
  expect_round_trip(log_of(folder, kFrames, "OPENNI_FRAME", foreign_images), folder, true);
  fs::rename(folder / "png", folder / "original");
  expect_round_trip("uw:" + (folder / "original").string() + ",64x48,57.6,57.6,32,24", folder, true);
}

}  // namespace
}  // namespace houghstream::log_tools
