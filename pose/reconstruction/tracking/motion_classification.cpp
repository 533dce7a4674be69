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
  int unchanged = 0;
  for (int y = 1; y + 1 < first.rows; ++y) {
    for (int x = 1; x + 1 < first.cols; ++x) {
      if (mask.at<std::uint8_t>(y, x) == 0) continue;
      const float gx = first.at<float>(y, x + 1) - first.at<float>(y, x - 1);
      const float gy = first.at<float>(y + 1, x) - first.at<float>(y - 1, x);
      if (gx * gx + gy * gy < kEdge_sq) continue;
      ++edges;
      unchanged += std::abs(intensity.at<float>(y, x) - first.at<float>(y, x)) < kSame ? 1 : 0;
    }
  }
  return edges > 0 ? static_cast<double>(unchanged) / edges : 1.0;
}

}  // namespace

MotionClassifier::MotionClassifier(FlowFrame first, const FrameLevels& levels, const cv::Mat& on_object,
                                   const Eigen::Isometry3d& T_camera_world, std::size_t min_landmarks)
    : first_(std::move(first)),
      first_intensity_(levels.levels[0].intensity),
      T_first_(T_camera_world),
      min_landmarks_(min_landmarks) {
  cv::dilate(on_object, object_mask_, cv::getStructuringElement(cv::MORPH_ELLIPSE, {5, 5}));
  cv::dilate(on_object, background_mask_, cv::getStructuringElement(cv::MORPH_ELLIPSE, {41, 41}));
  background_mask_ = background_mask_ == 0;
  cv::Mat background;
  cv::resize(background_mask_, background, first_.frame.colour.size(), 0.0, 0.0, cv::INTER_NEAREST);
  corners_ = detect_flow_corners(first_, background);
  surroundings_ = choose_points(levels, background_mask_, {});
  const Eigen::Isometry3f T_world_camera = T_first_.inverse().cast<float>();
  for (std::vector<SurfacePoint>& level : surroundings_) {
    for (SurfacePoint& point : level) {
      point.point = T_world_camera * point.point;
      point.normal = T_world_camera.linear() * point.normal;
    }
  }
}

bool MotionClassifier::is_camera_static(const FlowFrame& now, const FrameLevels& levels,
                                        const Eigen::Isometry3d& T_moved) const {
  constexpr double kMoved = 0.003;  // radians, of half of the corners
  constexpr double kBetter = 0.01;  // fraction of intensity
  const std::optional<LandmarkMatch> flow = track_corners(first_, corners_, now);
  if (flow && flow->inliers.size() >= min_landmarks_) {
    const auto moved = std::count_if(flow->inliers.begin(), flow->inliers.end(), [&](const auto& pair) {
      return bearing_error({pair.first, pair.second}, Eigen::Isometry3d::Identity()) > kMoved;
    });
    return 2 * static_cast<std::size_t>(moved) < flow->inliers.size();
  }
  const double moved_rms = compare_frame(surroundings_, levels, T_moved, 0).photometric_rms;
  const double static_rms = compare_frame(surroundings_, levels, T_first_, 0).photometric_rms;
  return static_rms < moved_rms + kBetter;
}

Motion MotionClassifier::classify(const FlowFrame& now, const FrameLevels& levels, Eigen::Isometry3d& T_camera_world) {
  constexpr int kMinFrames = 3;
  constexpr double kMinDifference = 0.2;  // share of edges
  const bool is_static = is_camera_static(now, levels, T_camera_world);
  const double background_unchanged =
      unchanged_fraction(levels.levels[0].intensity, first_intensity_, background_mask_);
  const double object_unchanged = unchanged_fraction(levels.levels[0].intensity, first_intensity_, object_mask_);
  moving_camera_frames_ = is_static ? 0 : moving_camera_frames_ + 1;
  moving_object_frames_ =
      is_static && object_unchanged < background_unchanged - kMinDifference ? moving_object_frames_ + 1 : 0;
  if (is_static) T_camera_world = T_first_;
  if (moving_camera_frames_ >= kMinFrames) return Motion::kCamera;
  return moving_object_frames_ >= kMinFrames ? Motion::kObject : Motion::kUnknown;
}

void StaticShadingDetector::mark_static_intensity(const cv::Mat& on_object, FrameLevels& levels) {
  constexpr std::size_t kLagFrames = 5;
  constexpr float kSame = 0.3F;
  constexpr double kMinChanged = 0.03;
  std::vector<cv::Mat> latest;
  for (const FrameLevel& level : levels.levels) latest.push_back(level.intensity);
  intensities_.push_back(std::move(latest));
  if (intensities_.size() <= kLagFrames) return;
  const double changed = 1.0 - unchanged_fraction(levels.levels[0].intensity, intensities_.front()[0], on_object);
  if (changed > kMinChanged) {
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
