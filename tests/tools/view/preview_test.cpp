#include "tools/view/preview.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "pipeline/messages/codecs.hpp"

namespace houghstream::view {
namespace {

cv::Mat noise(int width, int height) {
  cv::Mat image(height, width, CV_8UC3);
  cv::theRNG().state = 1;
  cv::randu(image, 0, 256);
  return image;
}

TEST(Preview, AnEasyImageKeepsItsSize) {
  const cv::Mat image(600, 1280, CV_8UC3, cv::Scalar(10, 100, 200));
  const PreviewImage preview = encode_preview(image);
  EXPECT_EQ(preview.width, 1280);
  EXPECT_EQ(preview.height, 600);
  const cv::Mat decoded = decode_jpeg({preview.jpeg.data(), preview.jpeg.size()}, 1280, 600);
  EXPECT_NEAR(decoded.at<cv::Vec3b>(300, 300)[2], 200, 4);
}

TEST(Preview, EvenNoiseFitsTheReceiveBuffer) {
  const PreviewImage preview = encode_preview(noise(1280, 646));
  EXPECT_LE(preview.jpeg.size(), kMaxPreviewBytes);
  EXPECT_GT(preview.width, 200);
  EXPECT_FALSE(decode_jpeg({preview.jpeg.data(), preview.jpeg.size()}, preview.width, preview.height).empty());
}

TEST(Preview, TheSmallestImageIsOne) {
  const PreviewImage preview = encode_preview(noise(1, 1));
  EXPECT_EQ(preview.width, 1);
  EXPECT_EQ(preview.height, 1);
}

TEST(Preview, WhatCannotFitIsAnError) {
  EXPECT_THROW(encode_preview(noise(64, 64), 100), InputError);
}

}  // namespace
}  // namespace houghstream::view
