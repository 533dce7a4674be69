#include "tools/view/video_file.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "tests/test_files.hpp"

namespace houghstream::view {
namespace {

const cv::Size kSize(64, 48);

TEST(VideoFile, LastsAsLongAsTheStreamThoughSlotsWereSkipped) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "video_file_test.mp4";
  {
    VideoFile video(file, 10.0);
    video.add(cv::Mat(kSize, CV_8UC3, cv::Scalar::all(20)), 5);
    video.add(cv::Mat(kSize, CV_8UC3, cv::Scalar::all(120)), 8);
    video.add(cv::Mat(kSize, CV_8UC3, cv::Scalar::all(220)), 9);
    EXPECT_EQ(video.frames_written(), 5);
    EXPECT_FALSE(std::filesystem::exists(file)) << "before it is whole";
    video.finish();
  }
  cv::VideoCapture written(file.string());
  ASSERT_TRUE(written.isOpened());
  EXPECT_DOUBLE_EQ(written.get(cv::CAP_PROP_FPS), 10.0);
  std::vector<int> levels;
  for (cv::Mat image; written.read(image);) levels.push_back(static_cast<int>(cv::mean(image)[0]));
  ASSERT_EQ(levels.size(), 5U);
  EXPECT_NEAR(levels[2], 20, 6);
  EXPECT_NEAR(levels[3], 120, 6);
  EXPECT_NEAR(levels[4], 220, 6);
  std::filesystem::remove(file);
}

TEST(VideoFile, FitsInWhatHasAnotherSize) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "video_file_test_size.mp4";
  VideoFile video(file, 10.0);
  video.add(cv::Mat(kSize, CV_8UC3, cv::Scalar::all(200)), 0);
  video.add(cv::Mat(cv::Size(31, 48), CV_8UC3, cv::Scalar::all(200)), 1);
  video.add(cv::Mat(cv::Size(1, 1), CV_8UC3, cv::Scalar::all(200)), 2);
  video.finish();
  cv::VideoCapture written(file.string());
  cv::Mat image;
  ASSERT_TRUE(written.read(image) && written.read(image));
  EXPECT_EQ(image.size(), kSize);
  EXPECT_LT(image.at<cv::Vec3b>(24, 2)[0], 60) << "black beside a narrower one";
  EXPECT_GT(image.at<cv::Vec3b>(24, 32)[0], 140);
  std::filesystem::remove(file);
}

TEST(VideoFile, ALongFirstImageLeavesTheNextOnesLegible) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "video_file_test_long.mp4";
  for (const cv::Size size : {cv::Size(32768, 140), cv::Size(2, 16936), cv::Size(1, 1)}) {
    VideoFile video(file, 10.0);
    video.add(cv::Mat(size, CV_8UC3, cv::Scalar::all(200)), 0);
    video.add(cv::Mat(cv::Size(640, 480), CV_8UC3, cv::Scalar::all(200)), 1);
    video.finish();
    cv::VideoCapture written(file.string());
    cv::Mat image;
    ASSERT_TRUE(written.read(image) && written.read(image)) << size;
    EXPECT_LE(std::max(image.cols, image.rows), 8192) << size;
    EXPECT_GE(std::min(image.cols, image.rows), size.area() > 1 ? 1024 : 2) << size;
  }
  std::filesystem::remove(file);
}

/// No file grows beyond so many bytes while it lives: as on a full disk.
class SmallFiles {
 public:
  explicit SmallFiles(rlim_t bytes) : signal_before_(signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallFiles() {
    setrlimit(RLIMIT_FSIZE, &before_);
    signal(SIGXFSZ, signal_before_);
  }
  SmallFiles(const SmallFiles&) = delete;
  SmallFiles& operator=(const SmallFiles&) = delete;

 private:
  rlimit before_{};
  void (*signal_before_)(int);
};

TEST(VideoFile, WhatAFullDiskCutsTakesNobodysPlace) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "video_file_test_full.mp4";
  write_file_atomically(file, "what was there before");
  {
    VideoFile video(file, 10.0);
    const SmallFiles full(2000);
    cv::RNG random(7);
    for (int i = 0; i < 100; ++i) {
      cv::Mat noise(kSize, CV_8UC3);
      random.fill(noise, cv::RNG::UNIFORM, 0, 256);
      video.add(noise, i);
    }
    EXPECT_THROW(video.finish(), InputError);
  }
  EXPECT_EQ(read_file(file, "a video"), "what was there before");
  std::filesystem::remove(file);
}

/// Noise, which does not compress: what a killed program has handed to the encoder reaches the file soon.
cv::Mat noise(int seed) {
  cv::Mat image(kSize, CV_8UC3);
  cv::RNG(static_cast<std::uint64_t>(seed)).fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

TEST(VideoFile, WhatAKilledProgramHasDrawnCanBePlayed) {
  const std::filesystem::path folder = fresh_folder("video_killed");
  const std::filesystem::path file = folder / "video.mp4";
  constexpr int kFrames = 400;
  const pid_t killed = fork();
  if (killed == 0) {
    VideoFile video(file, 10.0, Existing::kRecordingKept);
    for (int i = 0; i < kFrames; ++i) video.add(noise(i), i);
    raise(SIGKILL);
  }
  ASSERT_EQ(waitpid(killed, nullptr, 0), killed);
  VideoFile video(file, 10.0, Existing::kRecordingKept);
  video.add(noise(0), 0);
  video.finish();
  EXPECT_TRUE(std::filesystem::exists(file));
  cv::VideoCapture interrupted((folder / "video.interrupted-1.mkv").string());
  ASSERT_TRUE(interrupted.isOpened());
  int frames = 0;
  for (cv::Mat image; interrupted.read(image); ++frames) EXPECT_EQ(image.size(), kSize);
  EXPECT_GE(frames, kFrames / 2) << "but for the last ten seconds, which encoder and format hold back";
  std::filesystem::remove_all(folder);
}

TEST(VideoFile, EachFormatHoldsAllFramesAtTheRate) {
  const std::filesystem::path folder = fresh_folder("video_formats");
  for (const char* name : {"a.mp4", "a.mkv", "a.avi", "a.mov", "A.M4V"}) {
    for (const double rate_hz : {30.0, 7.5}) {
      VideoFile video(folder / name, rate_hz);
      for (int i = 0; i < 70; ++i) video.add(noise(i), i);
      video.finish();
      cv::VideoCapture written((folder / name).string());
      EXPECT_NEAR(written.get(cv::CAP_PROP_FPS), rate_hz, 0.01) << name;
      int frames = 0;
      for (cv::Mat image; written.read(image);) ++frames;
      EXPECT_EQ(frames, 70) << name << " " << rate_hz;
    }
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()), 5)
      << "nothing else is left";
  std::filesystem::remove_all(folder);
}

TEST(VideoFile, WhatCannotBeWrittenIsRefusedBeforeAnythingIsSeen) {
  const std::filesystem::path folder = testing::TempDir();
  for (const std::filesystem::path& file :
       {std::filesystem::path("/nonexistent/folder/video.mp4"), folder, folder / "noext", folder / "video.png"})
    EXPECT_THROW(VideoFile(file, 10.0), InputError) << file;
  EXPECT_NO_THROW(VideoFile(folder / "VIDEO.MP4", 10.0));
  EXPECT_FALSE(std::filesystem::exists(folder / "VIDEO.MP4")) << "there is nothing to see yet";
}

TEST(VideoRemux, WhatIsNoVideoIsRefusedAndNamed) {
  const std::filesystem::path folder = fresh_folder("video_remux");
  const std::filesystem::path text = folder / "text.mkv";
  write_text(text, "no video, but some words that are long enough to be looked at");
  for (const std::filesystem::path& file : {text, folder / "missing.mkv", folder}) {
    const std::string error = error_of([&] { remux_video(file, folder / "out.mp4", 10.0); });
    EXPECT_EQ(error.substr(0, file.string().size()), file.string()) << error;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out.mp4"));
  std::filesystem::remove_all(folder);
}

}  // namespace

}  // namespace houghstream::view
