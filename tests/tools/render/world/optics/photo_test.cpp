#include "tools/render/world/optics/photo.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(Photo, ExposureBringsDarkAndBrightRoomsCloser) {
  const PhotoSettings settings;
  const auto mean = [&](double level) {
    return cv::mean(take_photo(cv::Mat(60, 80, CV_32FC3, cv::Scalar::all(level)), settings, 1))[1];
  };
  EXPECT_GT(mean(0.05), 60.0);
  EXPECT_LT(mean(1.0), 190.0);
  EXPECT_LT(mean(0.05), mean(1.0));
}

TEST(Photo, NoiseFollowsTheSeed) {
  const cv::Mat grey(60, 80, CV_32FC3, cv::Scalar::all(0.2));
  const cv::Mat first = take_photo(grey, {}, 1);
  EXPECT_EQ(cv::norm(first, take_photo(grey, {}, 1), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(first, take_photo(grey, {}, 2), cv::NORM_INF), 0.0);
  cv::Scalar mean;
  cv::Scalar deviation;
  PhotoSettings silent;
  silent.shot_noise = silent.read_noise = silent.vignetting = 0.0;
  cv::meanStdDev(take_photo(grey, silent, 1), mean, deviation);
  EXPECT_EQ(deviation[0], 0.0);
}

}  // namespace
}  // namespace houghstream
