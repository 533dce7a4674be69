#include <sys/resource.h>

#include <csignal>
#include <map>

#include "pipeline/base/checks.hpp"
#include "tests/drivers/openni/virtual_camera.hpp"

namespace houghstream::openni {
namespace {

constexpr std::chrono::seconds kImageTimeout(5);
using Sensor = SensorImage::Sensor;

std::filesystem::path recorded_file(const VirtualCamera& camera, int images, bool jpeg) {
  CameraOptions options;
  options.mode = {320, 240, 30};
  options.record = (camera.folder() / "recorded.oni").string();
  options.record_jpeg = jpeg;
  const auto device = OpenniDevice::open_camera("houghstream-virtual://1", options);
  for (int i = 0; i < images; ++i) EXPECT_TRUE(device->wait(kImageTimeout).has_value());
  return options.record;
}

/// Returns a recording's images by their times.
std::map<Sensor, std::map<std::int64_t, cv::Mat>> images_of(const std::filesystem::path& file) {
  const auto device = OpenniDevice::open_file(file.string());
  std::map<Sensor, std::map<std::int64_t, cv::Mat>> images;
  while (!device->ended()) {
    const std::optional<SensorImage> image = device->wait(kImageTimeout);
    if (image) images[image->sensor][static_cast<std::int64_t>(image->device_us)] = image->image;
  }
  return images;
}

/// Returns the step of the pattern that an image shows; JPEG leaves the disc's colour where it was, roughly.
int image_of(const cv::Mat& image, const virtual_camera::CameraImages& pattern) {
  double minimum = 1e9;
  int found = -1;
  for (int k = 0; k < static_cast<int>(pattern.images.size()); ++k) {
    cv::Mat original = pattern.images[k].depth_mm;
    if (image.type() == CV_8UC3) cv::cvtColor(pattern.images[k].colour, original, cv::COLOR_RGB2BGR);
    const double difference = cv::norm(image, original, cv::NORM_L2SQR);
    if (difference < minimum) found = k;
    minimum = std::min(minimum, difference);
  }
  return found;
}

/// Each depth image's colour, by the pattern, lies `apart_us` after it in the file.
void expect_apart(const std::filesystem::path& file, std::int64_t apart_us) {
  const virtual_camera::CameraImages pattern =
      virtual_camera::make_test_pattern({320, 240, 262.5, 262.5, 159.5, 119.5});
  auto images = images_of(file);
  std::map<int, std::int64_t> colour_times;
  for (const auto& [time, image] : images[Sensor::kColour]) colour_times[image_of(image, pattern)] = time;
  int met = 0;
  for (const auto& [time, image] : images[Sensor::kDepth]) {
    const auto colour = colour_times.find(image_of(image, pattern));
    if (colour == colour_times.end()) continue;
    EXPECT_NEAR(static_cast<double>(colour->second - time), static_cast<double>(apart_us), 2.0) << met;
    ++met;
  }
  EXPECT_GE(met, 15);
  EXPECT_EQ(std::min(images[Sensor::kDepth].begin()->first, images[Sensor::kColour].begin()->first), 0);
}

TEST(OpenniRecording, ColourKeepsItsDistanceFromItsDepthHoweverLateItComes) {
  for (const bool jpeg : {false, true}) {
    const VirtualCamera late("recording_late", "size 320x240\ncan_sync no\ncolour_phase_ms 8\ncolour_late_ms 60\n");
    expect_apart(recorded_file(late, 50, jpeg), 8000);
  }
}

TEST(OpenniRecording, ColourThatComesAtOnceIsAtItsDepthsTime) {
  const VirtualCamera camera("recording_prompt", "size 320x240\n");
  expect_apart(recorded_file(camera, 50, false), 0);
}

// The recorder continues silently, as on a full disk.
TEST(OpenniRecording, WhatIsCutStaysBesideAnEarlierOne) {
  const VirtualCamera camera("recording_cut", "size 320x240\n");
  write_text(camera.folder() / "recorded.oni", "an earlier one");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit full = before;
  full.rlim_cur = 100'000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
  const std::filesystem::path file = recorded_file(camera, 50, false);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, SIG_DFL);
  EXPECT_EQ(read_text(file), "an earlier one");
  EXPECT_TRUE(std::filesystem::exists(camera.folder() / "recorded_2.oni.partial.oni"));
}

/// A recorder and a driver that hands over an image must not wait for each other: images come all the time here.
TEST(OpenniRecording, EndsWhileImagesCome) {
  const VirtualCamera camera("recording_ends", "size 320x240\nrate_hz 1000\ncan_sync no\n");
  CameraOptions options;
  options.mode = {320, 240, 1000};
  options.record = (camera.folder() / "recorded.oni").string();
  for (int i = 0; i < 40; ++i) {
    const auto device = OpenniDevice::open_camera("houghstream-virtual://1", options);
    for (int k = 0; k < 5 + i % 10; ++k) EXPECT_TRUE(device->wait(kImageTimeout).has_value());
  }
}

}  // namespace
}  // namespace houghstream::openni
