#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "drivers/datasets/open_frame_source.hpp"
#include "tests/pipeline/test_frame.hpp"
#include "tests/test_files.hpp"

// Bags that ROS's own library writes, of messages that its own headers serialise.

namespace houghstream {
namespace {

constexpr int kFrames = 6;

RgbdFrame frame_number(int i) {
  RgbdFrame frame = make_test_frame(1'600'000'000'000'000 + 33'333 * i);
  frame.depth.at<float>(1, 1) = static_cast<float>(700 + i) * 1e-3F;
  return frame;
}

sensor_msgs::Image image_of(const RgbdFrame& frame, const cv::Mat& pixels, const char* encoding) {
  sensor_msgs::Image image;
  image.header.stamp.fromNSec(static_cast<std::uint64_t>(frame.id.utime) * 1000);
  image.header.frame_id = "camera_rgb_optical_frame";
  image.width = static_cast<std::uint32_t>(pixels.cols);
  image.height = static_cast<std::uint32_t>(pixels.rows);
  image.encoding = encoding;
  image.step = static_cast<std::uint32_t>(pixels.step);
  image.data.assign(pixels.datastart, pixels.dataend);
  return image;
}

sensor_msgs::CameraInfo info_of(const RgbdFrame& frame) {
  sensor_msgs::CameraInfo info;
  info.width = static_cast<std::uint32_t>(frame.camera.width);
  info.height = static_cast<std::uint32_t>(frame.camera.height);
  info.K = {frame.camera.fx, 0.0, frame.camera.cx, 0.0, frame.camera.fy, frame.camera.cy, 0.0, 0.0, 1.0};
  return info;
}

std::string write_take(rosbag::CompressionType compression) {
  const std::string file = (fresh_folder("rosbag_library") / "take.bag").string();
  rosbag::Bag bag(file, rosbag::bagmode::Write);
  bag.setCompression(compression);
  bag.setChunkThreshold(20'000);  // about one frame
  for (int i = 0; i < kFrames; ++i) {
    const RgbdFrame frame = frame_number(i);
    ros::Time received;
    received.fromNSec(static_cast<std::uint64_t>(frame.id.utime) * 1000 + 40'000'000);
    bag.write("/camera/rgb/camera_info", received, info_of(frame));
    bag.write("/camera/depth_registered/image_raw", received,
              image_of(frame, depth_to_millimetres(frame.depth), "16UC1"));
    bag.write("/camera/rgb/image_color", received, image_of(frame, frame.colour, "bgr8"));
  }
  bag.close();
  return file;
}

TEST(RosbagLibrary, ItsBagsAreReadBitByBit) {
  for (const auto compression :
       {rosbag::compression::Uncompressed, rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const auto source = open_frame_source("bag:" + write_take(compression));
    EXPECT_NEAR(source->rate_hz(), 30.0, 0.01);
    for (int i = 0; i < kFrames; ++i) {
      const std::optional<RgbdFrame> frame = source->next();
      ASSERT_TRUE(frame.has_value()) << compression << " " << i;
      EXPECT_EQ(frame->id.utime, frame_number(i).id.utime);
      EXPECT_EQ(frame->camera, frame_number(i).camera);
      EXPECT_TRUE(same_depth(frame->depth, frame_number(i).depth));
      EXPECT_EQ(cv::norm(frame->colour, frame_number(i).colour, cv::NORM_INF), 0.0);
    }
    EXPECT_FALSE(source->next().has_value());
  }
}

}  // namespace
}  // namespace houghstream
