#include "pose/reconstruction/tracking/motion_classification.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "pose/reconstruction/map/frame_alignment.hpp"

namespace houghstream::reconstruction {
namespace {

/// Returns the fraction of the first image's edge pixels inside `mask` whose intensity is unchanged.
double unchanged_fraction(const cv::Mat& intensity, const cv::Mat& first, const cv::Mat& mask) {
  constexpr float kEdge_sq = 0.16F;
  constexpr float kSame = 0.4F;
  int edges = 0;
  int same = 0;
  for (int y = 1; y + 1 < first.rows; ++y) {
    for (int x = 1; x + 1 < first.cols; ++x) {
      if (mask.at<std::uint8_t>(y, x) == 0) continue;
      const float gx = first.at<float>(y, x + 1) - first.at<float>(y, x - 1);
      const float gy = first.at<float>(y + 1, x) - first.at<float>(y - 1, x);
      if (gx * gx + gy * gy < kEdge_sq) continue;
      ++edges;
      same += std::abs(intensity.at<float>(y, x) - first.at<float>(y, x)) < kSame ? 1 : 0;
    }
  }
  return edges > 0 ? static_cast<double>(same) / edges : 1.0;
}

}  // namespace

MotionClassifier::MotionClassifier(FlowFrame first, const FrameLevels& levels, const cv::Mat& on_object,
                                   const Eigen::Isometry3d& T_camera_world, std::size_t min_corners)
    : first_(std::move(first)),
      first_intensity_(levels.levels[0].intensity),
      T_first_(T_camera_world),
      min_corners_(min_corners) {
  cv::dilate(on_object, about_object_, cv::getStructuringElement(cv::MORPH_ELLIPSE, {5, 5}));
  cv::dilate(on_object, away_from_object_, cv::getStructuringElement(cv::MORPH_ELLIPSE, {41, 41}));
  away_from_object_ = away_from_object_ == 0;
  cv::Mat away;
  cv::resize(away_from_object_, away, first_.frame.colour.size(), 0.0, 0.0, cv::INTER_NEAREST);
  corners_ = detect_flow_corners(first_, away);
  rest_ = choose_points(levels, away_from_object_, {});
  const Eigen::Isometry3f T_world_camera = T_first_.inverse().cast<float>();
  for (std::vector<SurfacePoint>& level : rest_) {
    for (SurfacePoint& point : level) {
      point.point = T_world_camera * point.point;
      point.normal = T_world_camera.linear() * point.normal;
    }
  }
}

bool MotionClassifier::camera_is_still(const FlowFrame& now, const FrameLevels& levels,
                                       const Eigen::Isometry3d& T_moved) const {
  constexpr double kMoved = 0.003;  // radians, of half of the corners
  constexpr double kBetter = 0.01;  // fraction of intensity
  const std::optional<LandmarkMatch> flow = track_corners(first_, corners_, now);
  if (flow && flow->inliers.size() >= min_corners_) {
    const auto moved = std::count_if(flow->inliers.begin(), flow->inliers.end(), [&](const auto& pair) {
      return bearing_error({pair.first, pair.second}, Eigen::Isometry3d::Identity()) > kMoved;
    });
    return 2 * static_cast<std::size_t>(moved) < flow->inliers.size();
  }
  const double as_moved = compare_frame(rest_, levels, T_moved, 0).photometric_rms;
  const double as_still = compare_frame(rest_, levels, T_first_, 0).photometric_rms;
  return as_still < as_moved + kBetter;
}

Motion MotionClassifier::classify(const FlowFrame& now, const FrameLevels& levels, Eigen::Isometry3d& T_camera_world) {
  constexpr int kSure = 3;
  constexpr double kLess = 0.2;  // share of edges
  const bool is_still = camera_is_still(now, levels, T_camera_world);
  const double around = unchanged_fraction(levels.levels[0].intensity, first_intensity_, away_from_object_);
  const double on_it = unchanged_fraction(levels.levels[0].intensity, first_intensity_, about_object_);
  camera_moves_ = is_still ? 0 : camera_moves_ + 1;
  object_moves_ = is_still && on_it < around - kLess ? object_moves_ + 1 : 0;
  if (is_still) T_camera_world = T_first_;
  if (camera_moves_ >= kSure) return Motion::kCamera;
  return object_moves_ >= kSure ? Motion::kObject : Motion::kUnknown;
}

void StaticShadingDetector::mark_static_intensity(const cv::Mat& on_object, FrameLevels& levels) {
  constexpr std::size_t kFramesAgo = 5;
  constexpr float kSame = 0.3F;
  constexpr double kRests = 0.03;
  std::vector<cv::Mat> now;
  for (const FrameLevel& level : levels.levels) now.push_back(level.intensity);
  intensities_.push_back(std::move(now));
  if (intensities_.size() <= kFramesAgo) return;
  const double changed = 1.0 - unchanged_fraction(levels.levels[0].intensity, intensities_.front()[0], on_object);
  if (changed > kRests) {
    for (std::size_t l = 0; l < levels.levels.size(); ++l) {
      cv::Mat difference;
      cv::absdiff(levels.levels[l].intensity, intensities_.front()[l], difference);
      levels.levels[l].static_mask = difference < kSame;
      cv::erode(levels.levels[l].static_mask, levels.levels[l].static_mask,
                cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
    }
  }
  intensities_.pop_front();
}

}  // namespace houghstream::reconstruction
