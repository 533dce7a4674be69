#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/openni/camera_source.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/drivers/openni/virtual_camera.hpp"

namespace houghstream::openni {
namespace {

struct Recording {
  std::filesystem::path file;
  std::vector<RgbdFrame> seen;        ///< frames of the live source meanwhile
  std::vector<std::int64_t> numbers;  ///< the device's numbers of those
};

Recording record(const VirtualCamera& camera, int frames, bool jpeg) {
  Recording recording;
  recording.file = camera.folder() / "recorded.oni";
  CameraOptions options;
  options.mode = {320, 240, 30};
  options.record = recording.file.string();
  options.record_jpeg = jpeg;
  CameraListener listener;
  listener.on_depth_number = [&](std::int64_t number) { recording.numbers.push_back(number); };
  const auto source = open_camera_source("", options, listener);
  for (int i = 0; i < frames; ++i) recording.seen.push_back(source->next().value());
  return recording;
}

std::vector<RgbdFrame> replay(const std::filesystem::path& file) {
  const auto source = open_oni_source(file.string(), CameraOptions{});
  EXPECT_FALSE(source->is_live());
  EXPECT_EQ(source->rate_hz(), 30.0);
  std::vector<RgbdFrame> frames;
  while (std::optional<RgbdFrame> frame = source->next()) frames.push_back(std::move(*frame));
  EXPECT_FALSE(source->next().has_value()) << "it has ended";
  return frames;
}

double depth_difference(const RgbdFrame& a, const RgbdFrame& b) {
  return cv::norm(depth_to_millimetres(a.depth), depth_to_millimetres(b.depth), cv::NORM_INF);
}

/// Returns the mean of the channels' differences.
double colour_difference(const RgbdFrame& a, const RgbdFrame& b) {
  return cv::norm(a.colour, b.colour, cv::NORM_L1) / static_cast<double>(3 * a.colour.total());
}

/// Returns the device's number of a frame, which runs through the pattern's images.
std::int64_t number_of(const RgbdFrame& frame) {
  const std::vector<virtual_camera::CameraImage> images = virtual_camera::make_test_pattern(frame.camera).images;
  const cv::Mat depth_mm = depth_to_millimetres(frame.depth);
  std::size_t k = 0;
  while (k < images.size() && cv::norm(images[k].depth_mm, depth_mm, cv::NORM_INF) > 0.0) ++k;
  return static_cast<std::int64_t>(k);
}

/// Every image that the camera took is in the file, also one that a busy machine kept from the live run.
void expect_same(const Recording& recording, const std::vector<RgbdFrame>& replayed, bool jpeg) {
  ASSERT_FALSE(replayed.empty());
  const std::int64_t first = number_of(replayed[0]);
  ASSERT_LT(first, 30) << "recording starts a moment after the camera";
  for (std::size_t i = 0; i < recording.seen.size(); ++i) {
    if (recording.numbers[i] < first) continue;
    const auto number = static_cast<std::size_t>(recording.numbers[i] - first);
    ASSERT_LT(number, replayed.size());
    const RgbdFrame& frame = replayed[number];
    EXPECT_EQ(depth_difference(frame, recording.seen[i]), 0.0) << i;
    EXPECT_LE(colour_difference(frame, recording.seen[i]), jpeg ? 20.0 : 0.0) << i;
    EXPECT_EQ(jpeg, colour_difference(frame, recording.seen[i]) > 0.0) << i;
    EXPECT_TRUE(frame.camera == recording.seen[i].camera);
  }
  for (std::size_t i = 1; i < replayed.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(replayed[i].id.utime - replayed[i - 1].id.utime), 33'333.0, 100.0)
        << "none is missing";
  }
}

TEST(OniSource, GivesEveryFrameAsItWasSeen) {
  for (const bool jpeg : {false, true}) {
    const VirtualCamera camera("oni", "size 320x240\n");
    const Recording recording = record(camera, 50, jpeg);
    expect_same(recording, replay(recording.file), jpeg);
  }
}

// OpenNI2 would wait for images that never come.
TEST(OniSource, ADamagedOneIsRefusedBeforeItIsPlayed) {
  const VirtualCamera camera("oni_damaged", "size 320x240\n");
  const Recording recording = record(camera, 20, false);
  {
    std::fstream file(recording.file, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(recording.file) / 8));
    file << std::string(std::filesystem::file_size(recording.file) / 10, '\0');
  }
  EXPECT_THROW(open_oni_source(recording.file.string(), CameraOptions{}), InputError);
}

TEST(OniSource, EndsSoonWhenAsked) {
  const VirtualCamera camera("oni_stop", "size 320x240\n");
  const Recording recording = record(camera, 20, false);
  bool stop = false;
  const auto source = open_oni_source(recording.file.string(), CameraOptions{}, [&] { return stop; });
  EXPECT_TRUE(source->next().has_value());
  stop = true;
  EXPECT_FALSE(source->next().has_value());
}

TEST(OniSource, BadFilesAreRefused) {
  const VirtualCamera camera("oni_bad", "size 320x240\n");
  const Recording recording = record(camera, 20, true);
  EXPECT_THROW(open_oni_source((camera.folder() / "none.oni").string(), CameraOptions{}), InputError);
  write_text(camera.folder() / "text.oni", "no recording");
  EXPECT_THROW(open_oni_source((camera.folder() / "text.oni").string(), CameraOptions{}), InputError);
  EXPECT_THROW(open_oni_source("houghstream-virtual://1", CameraOptions{}), InputError) << "a camera, no file";
  std::filesystem::copy(recording.file, camera.folder() / "cut.oni");
  std::filesystem::resize_file(camera.folder() / "cut.oni", std::filesystem::file_size(recording.file) / 5);
  EXPECT_THROW(open_oni_source((camera.folder() / "cut.oni").string(), CameraOptions{}), InputError);
  CameraOptions options;
  options.camera = Camera{640, 480, 525.0, 525.0, 320.0, 240.0};
  EXPECT_THROW(open_oni_source(recording.file.string(), options), InputError) << "another size";
}

TEST(OniSource, APlaceThatCannotBeWrittenIsAnError) {
  const VirtualCamera camera("oni_nowhere", "");
  CameraOptions options;
  options.record = (camera.folder() / "none" / "a.oni").string();
  EXPECT_THROW(open_camera_source("", options, {}), InputError);
}

}  // namespace
}  // namespace houghstream::openni
