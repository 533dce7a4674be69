#include "pose/reconstruction/map/landmarks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "tests/pose/reconstruction/shown_scene.hpp"

namespace houghstream::reconstruction {
namespace {

RgbdFrame seen_from(double azimuth) {
  return test_scene::photograph(test_scene::table_with({}), test_scene::camera_at(azimuth, 0.6, 0.65),
                                test_scene::ShownScene().camera, 1);
}

Eigen::Isometry3d motion_to(double azimuth, double next) {
  return test_scene::camera_at(next, 0.6, 0.65) * test_scene::camera_at(azimuth, 0.6, 0.65).inverse();
}

void expect_motion(const LandmarkMatch& match, const Eigen::Isometry3d& T) {
  EXPECT_GE(match.inliers.size(), 15U);
  EXPECT_LT((match.T_b_a.inverse() * T).translation().norm(), 0.012);
  EXPECT_LT(Eigen::AngleAxisd((match.T_b_a.inverse() * T).linear()).angle(), 0.018);
}

TEST(Landmarks, CornersAreFollowedIntoTheNextFrame) {
  const FlowFrame a = make_flow_frame(seen_from(0.4));
  const FlowFrame b = make_flow_frame(seen_from(0.43));
  const std::optional<LandmarkMatch> match = track_corners(a, detect_flow_corners(a, {}), b);
  ASSERT_TRUE(match);
  expect_motion(*match, motion_to(0.4, 0.43));
  EXPECT_FALSE(track_corners(a, {}, b)) << "no corners";
  const cv::Mat nowhere = cv::Mat::zeros(a.grey.size(), CV_8UC1);
  EXPECT_TRUE(detect_flow_corners(a, nowhere).empty());
}

TEST(Landmarks, FramesThatAreMadeOnceTellWhatTheirImagesDo) {
  const FlowFrame a = make_flow_frame(seen_from(0.4));
  const FlowFrame b = make_flow_frame(seen_from(0.43));
  const std::vector<cv::Point2f> corners = detect_flow_corners(a, {});
  const std::optional<LandmarkMatch> match = track_corners(a, corners, b);
  ASSERT_TRUE(match);
  std::vector<cv::Point2f> there;
  std::vector<std::uint8_t> went;
  std::vector<float> errors;
  cv::calcOpticalFlowPyrLK(a.grey, b.grey, corners, there, went, errors, {21, 21}, 3);
  std::vector<Eigen::Vector3d> expected;
  for (const cv::Point2f& at : there) {
    const cv::Point px(cvRound(at.x), cvRound(at.y));
    if (!cv::Rect({0, 0}, b.frame.depth.size()).contains(px)) continue;
    expected.push_back(b.frame.camera.backproject(at.x, at.y, b.frame.depth.at<float>(px)));
  }
  for (const auto& [before, now] : match->inliers)
    EXPECT_EQ(std::count(expected.begin(), expected.end(), now), 1) << now.transpose();
}

TEST(Landmarks, CornersAreRecognisedFromElsewhere) {
  const Landmarks a = detect_landmarks(seen_from(0.4), {});
  const Landmarks b = detect_landmarks(seen_from(0.6), {});
  const std::optional<LandmarkMatch> match = match_landmarks(a, b);
  ASSERT_TRUE(match);
  expect_motion(*match, motion_to(0.4, 0.6));
  EXPECT_FALSE(match_landmarks(a, {}));
}

}  // namespace
}  // namespace houghstream::reconstruction
