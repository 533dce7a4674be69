#include "tools/view/video_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "pipeline/base/checks.hpp"

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
  }
  cv::VideoCapture written(file.string());
  ASSERT_TRUE(written.isOpened());
  EXPECT_DOUBLE_EQ(written.get(cv::CAP_PROP_FPS), 10.0);
  std::vector<int> levels;
  for (cv::Mat picture; written.read(picture);) levels.push_back(static_cast<int>(cv::mean(picture)[0]));
  ASSERT_EQ(levels.size(), 5U);
  EXPECT_NEAR(levels[2], 20, 6);
  EXPECT_NEAR(levels[3], 120, 6);
  EXPECT_NEAR(levels[4], 220, 6);
  std::filesystem::remove(file);
}

TEST(VideoFile, UnwritableFileAndChangedSizeAreRefused) {
  VideoFile nowhere("/nonexistent/folder/video.mp4", 10.0);
  EXPECT_THROW(nowhere.add(cv::Mat(kSize, CV_8UC3), 0), InputError);
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "video_file_test_size.mp4";
  VideoFile video(file, 10.0);
  video.add(cv::Mat::zeros(kSize, CV_8UC3), 0);
  EXPECT_THROW(video.add(cv::Mat::zeros(cv::Size(32, 48), CV_8UC3), 1), InputError);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace houghstream::view
