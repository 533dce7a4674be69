#include <gtest/gtest.h>

#include "drivers/bop_dataset.hpp"
#include "drivers/openni/camera_source.hpp"
#include "pipeline/checks.hpp"
#include "tests/drivers/openni/virtual_camera.hpp"

namespace houghstream {
namespace {

struct Recording {
  std::filesystem::path file;
  std::vector<RgbdFrame> seen;        ///< what the live source gave meanwhile
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
  listener.depth_number = [&](std::int64_t number) { recording.numbers.push_back(number); };
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

/// The frame of the recording that shows the disc where the first seen one does; recording starts a moment later.
std::size_t first_common(const std::vector<RgbdFrame>& seen, const RgbdFrame& first_replayed) {
  std::size_t i = 0;
  while (i < seen.size() && depth_difference(seen[i], first_replayed) > 0.0) ++i;
  return i;
}

TEST(OniSource, GivesEveryFrameAsItWasSeen) {
  for (const bool jpeg : {false, true}) {
    const VirtualCamera camera("oni", "size 320x240\n");
    const Recording recording = record(camera, 50, jpeg);
    const std::vector<RgbdFrame> replayed = replay(recording.file);
    ASSERT_FALSE(replayed.empty());
    const std::size_t start = first_common(recording.seen, replayed[0]);
    ASSERT_LE(start, 3U);
    ASSERT_GE(replayed.size(), recording.seen.size() - start) << "all frames that were seen since it began";
    EXPECT_EQ(recording.numbers.back() - recording.numbers.front(), 49) << "the live run lost none";
    for (std::size_t i = start; i < recording.seen.size(); ++i) {
      const RgbdFrame& frame = replayed[i - start];
      EXPECT_EQ(depth_difference(frame, recording.seen[i]), 0.0) << i;
      EXPECT_LE(cv::norm(frame.colour, recording.seen[i].colour, cv::NORM_INF), jpeg ? 120.0 : 0.0) << i;
      EXPECT_TRUE(frame.camera == recording.seen[i].camera);
    }
    for (std::size_t i = 1; i < replayed.size(); ++i) {
      EXPECT_NEAR(static_cast<double>(replayed[i].utime - replayed[i - 1].utime), 33'333.0, 2'000.0);
    }
  }
}

TEST(OniSource, BadFilesAreRefused) {
  const VirtualCamera camera("oni_bad", "size 320x240\n");
  const Recording recording = record(camera, 20, true);
  EXPECT_THROW(open_oni_source((camera.folder() / "none.oni").string(), CameraOptions{}), InputError);
  write_text(camera.folder() / "text.oni", "no recording");
  EXPECT_THROW(open_oni_source((camera.folder() / "text.oni").string(), CameraOptions{}), InputError);
  EXPECT_THROW(open_oni_source("houghstream-virtual://1", CameraOptions{}), InputError) << "a camera, no file";
  CameraOptions options;
  options.camera = Camera{640, 480, 525.0, 525.0, 320.0, 240.0};
  EXPECT_THROW(open_oni_source(recording.file.string(), options), InputError) << "another size";
}

}  // namespace
}  // namespace houghstream
