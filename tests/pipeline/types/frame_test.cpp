#include "pipeline/types/frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "tests/pipeline/test_frame.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

TEST(Depth, MissingIsZeroOnTheWireAndNoNumberInMemory) {
  const cv::Mat wire = (cv::Mat_<std::uint16_t>(1, 3) << 0, 1, 65535);
  const cv::Mat metres = depth_from_millimetres(wire);
  EXPECT_TRUE(std::isnan(metres.at<float>(0)));
  EXPECT_EQ(metres.at<float>(1), 0.001F);
  EXPECT_EQ(metres.at<float>(2), 65.535F);
  EXPECT_EQ(cv::norm(depth_to_millimetres(metres), wire, cv::NORM_INF), 0.0);
}

TEST(Depth, EveryMillimetreComesBackAsItWas) {
  cv::Mat wire(1, 65536, CV_16UC1);
  for (int i = 0; i < wire.cols; ++i) wire.at<std::uint16_t>(i) = static_cast<std::uint16_t>(i);
  EXPECT_EQ(cv::norm(depth_to_millimetres(depth_from_millimetres(wire)), wire, cv::NORM_INF), 0.0);
}

TEST(Depth, WhatTheWireCannotHoldIsNone) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const cv::Mat metres = (cv::Mat_<float>(1, 6) << kNone, kInfinite, -kInfinite, -1.0F, 65.6F, 0.0004F);
  EXPECT_EQ(cv::countNonZero(depth_to_millimetres(metres)), 0);
}

TEST(Depth, OfAnotherTypeIsAnError) {
  EXPECT_THROW(depth_from_millimetres(cv::Mat(2, 2, CV_32FC1)), InputError);
  EXPECT_THROW(depth_to_millimetres(cv::Mat(2, 2, CV_16UC1)), InputError);
}

std::string complaint(const RgbdFrame& frame) {
  return error_of([&] { check_frame(frame, "shelf"); });
}

TEST(CheckFrame, NamesTheSourceAndWhatIsWrong) {
  const RgbdFrame good = make_test_frame(1);
  EXPECT_EQ(complaint(good), "");
  RgbdFrame grey = good;
  grey.colour = cv::Mat(good.colour.size(), CV_8UC1);
  EXPECT_NE(complaint(grey).find("shelf: colour"), std::string::npos);
  RgbdFrame wire = good;
  wire.depth = cv::Mat(good.depth.size(), CV_16UC1);
  EXPECT_NE(complaint(wire).find("shelf: depth"), std::string::npos);
  RgbdFrame small = good;
  small.depth = cv::Mat(24, 32, CV_32FC1);
  EXPECT_NE(complaint(small).find("64x48 and depth 32x24"), std::string::npos) << complaint(small);
  RgbdFrame other = good;
  other.camera = Camera{32, 24, 30.0, 30.0, 16.0, 12.0};
  EXPECT_NE(complaint(other).find("camera 32x24"), std::string::npos) << complaint(other);
  RgbdFrame blind = good;
  blind.camera.fx = 0.0;
  EXPECT_NE(complaint(blind), "");
}

}  // namespace
}  // namespace houghstream
