#include "pose/reconstruction/map/landmarks.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "pipeline/base/random.hpp"
#include "pose/reconstruction/map/frame_levels.hpp"

namespace houghstream::reconstruction {
namespace {

using Pairs = decltype(LandmarkMatch::inliers);

const cv::Size kFlowWindow(21, 21);  // pixels
constexpr int kFlowLevels = 3;

double max_distance_at(double z) {
  return 0.006 + 3.0 * depth_sigma(z);
}

Pairs match_descriptors(const Landmarks& a, const Landmarks& b) {
  constexpr float kMaxDistanceRatio = 0.85F;  // nearer than the second (Lowe 2004)
  const cv::BFMatcher matcher(cv::NORM_HAMMING);
  std::vector<std::vector<cv::DMatch>> matches;
  matcher.knnMatch(a.descriptors, b.descriptors, matches, 2);
  Pairs pairs;
  for (const std::vector<cv::DMatch>& nearest_two : matches) {
    if (nearest_two.size() < 2 || nearest_two[0].distance > kMaxDistanceRatio * nearest_two[1].distance) continue;
    pairs.emplace_back(a.points[static_cast<std::size_t>(nearest_two[0].queryIdx)],
                       b.points[static_cast<std::size_t>(nearest_two[0].trainIdx)]);
  }
  return pairs;
}

/// Returns the rigid motion that takes the first points to the second (Umeyama 1991).
Eigen::Isometry3d motion_between(const Pairs& pairs) {
  Eigen::Matrix3Xd from(3, pairs.size());
  Eigen::Matrix3Xd to(3, pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = pairs[i].first;
    to.col(static_cast<Eigen::Index>(i)) = pairs[i].second;
  }
  Eigen::Isometry3d T;
  T.matrix() = Eigen::umeyama(from, to, false);
  return T;
}

bool is_inlier(const Pairs::value_type& pair, const Eigen::Isometry3d& T) {
  return (T * pair.first - pair.second).norm() < max_distance_at(pair.second.z());
}

Pairs select_inliers(const Pairs& pairs, const Eigen::Isometry3d& T) {
  Pairs inliers;
  for (const auto& pair : pairs) {
    if (is_inlier(pair, T)) inliers.push_back(pair);
  }
  return inliers;
}

/// Returns the number of inliers of a motion, or 0 as soon as they cannot exceed `maximum`.
std::size_t count_inliers(const Pairs& pairs, const Eigen::Isometry3d& T, std::size_t maximum) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (count + (pairs.size() - i) <= maximum) return 0;
    count += is_inlier(pairs[i], T) ? 1 : 0;
  }
  return count;
}

std::optional<LandmarkMatch> estimate_motion_by_ransac(const Pairs& pairs) {
  constexpr int kTrials = 300;
  constexpr std::size_t kMin = 8;
  if (pairs.size() < kMin) return std::nullopt;
  Random random(1);
  Pairs sample(3);
  std::size_t maximum = 0;
  Eigen::Isometry3d T_best = Eigen::Isometry3d::Identity();
  for (int trial = 0; trial < kTrials && maximum < pairs.size(); ++trial) {
    for (auto& pair : sample) pair = pairs[static_cast<std::size_t>(random.below(static_cast<int>(pairs.size())))];
    if ((sample[0].first - sample[1].first).norm() < 0.02 || (sample[0].first - sample[2].first).norm() < 0.02)
      continue;
    const Eigen::Isometry3d T = motion_between(sample);
    const std::size_t count = count_inliers(pairs, T, maximum);
    if (count <= maximum) continue;
    maximum = count;
    T_best = T;
  }
  if (maximum < kMin) return std::nullopt;
  Pairs best = select_inliers(pairs, T_best);
  LandmarkMatch match;
  for (int iteration = 0; iteration < 2; ++iteration) {
    match.T_b_a = motion_between(best);
    best = select_inliers(pairs, match.T_b_a);
    if (best.size() < kMin) return std::nullopt;
  }
  match.inliers = std::move(best);
  return match;
}

cv::Mat to_grey(const RgbdFrame& frame) {
  cv::Mat grey;
  cv::cvtColor(frame.colour, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

/// Returns the surface point of a pixel with depth within reach, camera frame.
std::optional<Eigen::Vector3d> surface_at(const RgbdFrame& frame, const cv::Point2f& at) {
  const cv::Point px(cvRound(at.x), cvRound(at.y));
  if (!cv::Rect({0, 0}, frame.depth.size()).contains(px)) return std::nullopt;
  const float z = frame.depth.at<float>(px);
  if (!(z > 0.1F && z < 4.0F)) return std::nullopt;
  return frame.camera.backproject(at.x, at.y, z);
}

}  // namespace

Landmarks detect_landmarks(const RgbdFrame& frame, const cv::Mat& mask) {
  constexpr int kMax = 600;
  std::vector<cv::KeyPoint> corners;
  Landmarks landmarks;
  cv::Mat descriptors;
  cv::ORB::create(kMax, 1.2F, 6, 15, 0, 2, cv::ORB::HARRIS_SCORE, 31, 10)
      ->detectAndCompute(to_grey(frame), mask, corners, descriptors);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::optional<Eigen::Vector3d> point = surface_at(frame, corners[i].pt);
    if (!point) continue;
    landmarks.points.push_back(*point);
    landmarks.descriptors.push_back(descriptors.row(static_cast<int>(i)));
  }
  return landmarks;
}

std::optional<LandmarkMatch> match_landmarks(const Landmarks& a, const Landmarks& b) {
  if (a.points.empty() || b.points.empty()) return std::nullopt;
  return estimate_motion_by_ransac(match_descriptors(a, b));
}

FlowFrame make_flow_frame(const RgbdFrame& frame) {
  FlowFrame flow_frame{frame, to_grey(frame), {}};
  cv::buildOpticalFlowPyramid(flow_frame.grey, flow_frame.pyramid, kFlowWindow, kFlowLevels);
  return flow_frame;
}

std::vector<cv::Point2f> detect_flow_corners(const FlowFrame& frame, const cv::Mat& mask) {
  constexpr int kMax = 300;
  constexpr double kMinQuality = 0.01;  // fraction of the best corner's quality
  constexpr double kApart_px = 9.0;
  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(frame.grey, corners, kMax, kMinQuality, kApart_px, mask);
  return corners;
}

std::optional<LandmarkMatch> track_corners(const FlowFrame& a, const std::vector<cv::Point2f>& corners,
                                           const FlowFrame& b) {
  constexpr float kMaxRoundTripError_px = 0.5F;
  if (corners.empty()) return std::nullopt;
  std::vector<cv::Point2f> tracked;
  std::vector<cv::Point2f> tracked_back;
  std::vector<std::uint8_t> is_tracked;
  std::vector<std::uint8_t> is_tracked_back;
  std::vector<float> errors;
  cv::calcOpticalFlowPyrLK(a.pyramid, b.pyramid, corners, tracked, is_tracked, errors, kFlowWindow, kFlowLevels);
  cv::calcOpticalFlowPyrLK(b.pyramid, a.pyramid, tracked, tracked_back, is_tracked_back, errors, kFlowWindow,
                           kFlowLevels);
  Pairs pairs;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const cv::Point2f round_trip = tracked_back[i] - corners[i];
    if (is_tracked[i] == 0 || is_tracked_back[i] == 0 || std::hypot(round_trip.x, round_trip.y) > kMaxRoundTripError_px)
      continue;
    const std::optional<Eigen::Vector3d> from = surface_at(a.frame, corners[i]);
    const std::optional<Eigen::Vector3d> to = surface_at(b.frame, tracked[i]);
    if (from && to) pairs.emplace_back(*from, *to);
  }
  return estimate_motion_by_ransac(pairs);
}

}  // namespace houghstream::reconstruction
