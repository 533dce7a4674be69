#include "pose/reconstruction/landmarks.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/random.hpp"
#include "pose/reconstruction/frame_levels.hpp"

namespace houghstream::reconstruction {
namespace {

using Pairs = std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>;

double limit_at(double z) {
  return 0.006 + 3.0 * depth_sigma(z);
}

Pairs like_pairs(const Landmarks& a, const Landmarks& b) {
  constexpr float kClearly = 0.85F;  // nearer than the second (Lowe 2004)
  const cv::BFMatcher matcher(cv::NORM_HAMMING);
  std::vector<std::vector<cv::DMatch>> matches;
  matcher.knnMatch(a.descriptors, b.descriptors, matches, 2);
  Pairs pairs;
  for (const std::vector<cv::DMatch>& two : matches) {
    if (two.size() < 2 || two[0].distance > kClearly * two[1].distance) continue;
    pairs.emplace_back(a.points[static_cast<std::size_t>(two[0].queryIdx)],
                       b.points[static_cast<std::size_t>(two[0].trainIdx)]);
  }
  return pairs;
}

/// The rigid motion that takes the first points to the second (Umeyama 1991).
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

Pairs agreeing(const Pairs& pairs, const Eigen::Isometry3d& T) {
  Pairs inliers;
  for (const auto& pair : pairs) {
    if ((T * pair.first - pair.second).norm() < limit_at(pair.second.z())) inliers.push_back(pair);
  }
  return inliers;
}

}  // namespace

Landmarks find_landmarks(const RgbdFrame& frame, const cv::Mat& mask) {
  constexpr int kMost = 600;
  cv::Mat grey;
  cv::cvtColor(frame.colour, grey, cv::COLOR_BGR2GRAY);
  std::vector<cv::KeyPoint> corners;
  Landmarks landmarks;
  cv::Mat descriptors;
  cv::ORB::create(kMost, 1.2F, 6, 15, 0, 2, cv::ORB::HARRIS_SCORE, 31, 10)
      ->detectAndCompute(grey, mask, corners, descriptors);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const cv::Point px(cvRound(corners[i].pt.x), cvRound(corners[i].pt.y));
    const float z = frame.depth.at<float>(px);
    if (!(z > 0.1F && z < 4.0F)) continue;
    landmarks.points.push_back(frame.camera.backproject(corners[i].pt.x, corners[i].pt.y, z));
    landmarks.descriptors.push_back(descriptors.row(static_cast<int>(i)));
  }
  return landmarks;
}

std::optional<LandmarkMatch> match_landmarks(const Landmarks& a, const Landmarks& b) {
  constexpr int kTrials = 300;
  constexpr std::size_t kFewest = 8;
  if (a.points.size() < kFewest || b.points.size() < kFewest) return std::nullopt;
  const Pairs pairs = like_pairs(a, b);
  if (pairs.size() < kFewest) return std::nullopt;
  Random random(1);
  Pairs best;
  for (int trial = 0; trial < kTrials; ++trial) {
    Pairs three;
    for (int i = 0; i < 3; ++i)
      three.push_back(pairs[static_cast<std::size_t>(random.below(static_cast<int>(pairs.size())))]);
    if ((three[0].first - three[1].first).norm() < 0.02 || (three[0].first - three[2].first).norm() < 0.02) continue;
    Pairs inliers = agreeing(pairs, motion_between(three));
    if (inliers.size() > best.size()) best = std::move(inliers);
  }
  if (best.size() < kFewest) return std::nullopt;
  LandmarkMatch match;
  for (int again = 0; again < 2; ++again) {
    match.T_b_a = motion_between(best);
    best = agreeing(pairs, match.T_b_a);
    if (best.size() < kFewest) return std::nullopt;
  }
  match.inliers = static_cast<int>(best.size());
  return match;
}

}  // namespace houghstream::reconstruction
