#include "detector/baseline/hough_images.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "detector/baseline/baseline_scales.hpp"
#include "detector/baseline/gall_profile.hpp"
#include "detector/training/forest_trainer.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream::baseline {
namespace {

constexpr int kRings = 1;

Forest quickly_trained(const std::string& profile_name) {
  Profile profile = make_profile(profile_name);
  profile.training.trees = 5;
  profile.training.max_depth = 14;
  profile.training.tests_per_node = 80;
  profile.training.patches_per_view = 150;
  profile.training.min_distance = 0.5F;
  profile.training.max_distance = 1.2F;
  profile.training.validation_frames = 24;
  return training::train_forest(
      toy::training_views(), profile, [](const auto&) {}, scales_of(profile.features));
}

const Forest& normalised_forest() {
  static const Forest forest = quickly_trained("realtime");
  return forest;
}

const Forest& scale_space_forest() {
  static const Forest forest = quickly_trained("gall");
  return forest;
}

cv::Mat image_of(const Forest& forest, int class_index, const RgbdFrame& frame) {
  const DetectionSettings settings = detection_settings_of(forest);
  const ForestIndex index(forest);
  return hough_image({index, settings}, class_index, frame);
}

cv::Point strongest(const cv::Mat& image) {
  cv::Point at;
  cv::minMaxLoc(image, nullptr, nullptr, nullptr, &at);
  return at;
}

/// Returns the position of the strongest votes for a tile that was put at (u, v), relative to its centre.
cv::Point error_of(const Forest& forest, double u_px, double v_px, double distance) {
  RgbdFrame frame = toy::background(77);
  toy::put_tile(kRings, u_px, v_px, distance, frame);
  const cv::Mat image = image_of(forest, kRings, frame);
  EXPECT_EQ(image.type(), CV_32FC1);
  EXPECT_EQ(image.size(), frame.colour.size());
  return strongest(image) - cv::Point(cvRound(u_px), cvRound(v_px));
}

TEST(HoughImages, DepthNormalisedVotesMeetAtTheCentre) {
  EXPECT_LE(cv::norm(error_of(normalised_forest(), 90, 110, 0.7)), 5.0);
  EXPECT_LE(cv::norm(error_of(normalised_forest(), 230, 150, 1.0)), 5.0);
}

TEST(HoughImages, VotesOfAScaleSpaceMeetAtTheCentre) {
  EXPECT_LE(cv::norm(error_of(scale_space_forest(), 90, 110, 0.7)), 5.0);
  EXPECT_LE(cv::norm(error_of(scale_space_forest(), 230, 150, 1.0)), 5.0);
}

TEST(HoughImages, FrameOfOddSizeIsCoveredToo) {
  RgbdFrame frame = toy::background(77);
  toy::put_tile(kRings, 230, 110, 0.7, frame);
  const cv::Rect part(0, 0, 317, 233);
  frame.colour = frame.colour(part).clone();
  frame.depth = frame.depth(part).clone();
  frame.camera.width = part.width;
  frame.camera.height = part.height;
  const cv::Mat image = image_of(normalised_forest(), kRings, frame);
  EXPECT_EQ(image.size(), part.size());
  EXPECT_LE(cv::norm(strongest(image) - cv::Point(230, 110)), 5.0);
}

TEST(HoughImages, AnotherClassGetsFewerVotes) {
  RgbdFrame frame = toy::background(77);
  toy::put_tile(kRings, 159.5, 119.5, 0.7, frame);
  for (const Forest* forest : {&normalised_forest(), &scale_space_forest()}) {
    const cv::Point centre(160, 120);
    EXPECT_LT(image_of(*forest, 1 - kRings, frame).at<float>(centre),
              0.5F * image_of(*forest, kRings, frame).at<float>(centre));
  }
}

}  // namespace
}  // namespace houghstream::baseline
