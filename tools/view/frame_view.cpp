#include "tools/view/frame_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

namespace houghstream {
namespace {

constexpr int kPanelHeight = 112;  // pixels
constexpr int kTitleWidth = 250;   // pixels
constexpr int kColumnWidth = 200;  // pixels, of one column of stages
constexpr int kRowHeight = 20;     // pixels
constexpr int kRows = 5;
const cv::Scalar kPanelColour(38, 34, 32);
const cv::Scalar kBarColour(150, 110, 60);
const cv::Scalar kMutedText(190, 190, 190);

std::string latency_line(const char* what, const std::optional<double>& latency_ms) {
  return latency_ms ? fmt::format("{} after {:.1f} ms", what, *latency_ms) : fmt::format("{} not yet", what);
}

void draw_title(cv::Mat& panel, const ViewedFrame& viewed) {
  const auto valid_poses = viewed.poses
                               ? std::count_if(viewed.poses->poses.begin(), viewed.poses->poses.end(),
                                               [](const ObjectPose& p) { return p.T_camera_object.has_value(); })
                               : 0;
  const std::vector<std::string> lines = {
      fmt::format("frame {:.3f} s", static_cast<double>(viewed.frame.utime) * 1e-6),
      fmt::format("{} objects, {} poses", viewed.detections.detections.size(), valid_poses),
      latency_line("detections", viewed.detect_latency_ms), latency_line("poses", viewed.pose_latency_ms)};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    draw_text(panel, lines[i], {8, 20 + static_cast<int>(i) * 24}, 0.5, i == 0 ? kMutedText : cv::Scalar::all(255));
  }
}

// One row per stage with a bar as long as its share of the longest; columns until the panel is full.
void draw_stages(cv::Mat& panel, const std::vector<StageTime>& stages) {
  std::int64_t longest = 1;
  for (const StageTime& stage : stages) longest = std::max(longest, stage.duration_us);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const int x = kTitleWidth + static_cast<int>(i) / kRows * kColumnWidth;
    const int y = 8 + static_cast<int>(i) % kRows * kRowHeight;
    if (x + kColumnWidth > panel.cols) return;
    const double share =
        static_cast<double>(std::max<std::int64_t>(stages[i].duration_us, 0)) / static_cast<double>(longest);
    const int length = std::max(1, static_cast<int>(std::lround(share * (kColumnWidth - 12))));
    cv::rectangle(panel, cv::Rect(x, y, length, kRowHeight - 3), kBarColour, cv::FILLED);
    draw_text(panel, fmt::format("{} {:.1f} ms", stages[i].stage, static_cast<double>(stages[i].duration_us) * 1e-3),
              {x + 3, y + 13}, 0.4);
  }
}

cv::Mat draw_panel(const ViewedFrame& viewed, int width) {
  cv::Mat panel(kPanelHeight, width, CV_8UC3, kPanelColour);
  draw_title(panel, viewed);
  draw_stages(panel, viewed.poses ? viewed.poses->stages : viewed.detections.stages);
  return panel;
}

}  // namespace

cv::Mat colour_depth(const cv::Mat& depth, float near, float far) {
  cv::Mat warmth(depth.size(), CV_8UC1);
  cv::Mat missing(depth.size(), CV_8UC1);
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      const float z = depth.at<float>(y, x);
      const float share = std::isnan(z) ? 0.0F : std::clamp((far - z) / (far - near), 0.0F, 1.0F);
      warmth.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(std::lround(share * 255.0F));
      missing.at<std::uint8_t>(y, x) = std::isnan(z) ? 255 : 0;
    }
  }
  cv::Mat image;
  cv::applyColorMap(warmth, image, cv::COLORMAP_TURBO);
  image.setTo(cv::Scalar::all(0), missing);
  return image;
}

ViewedFrame without_weak(ViewedFrame viewed, float min_score) {
  std::vector<Detection> strong;
  std::vector<int> new_index(viewed.detections.detections.size(), -1);
  for (std::size_t i = 0; i < new_index.size(); ++i) {
    if (viewed.detections.detections[i].score < min_score) continue;
    new_index[i] = static_cast<int>(strong.size());
    strong.push_back(std::move(viewed.detections.detections[i]));
  }
  viewed.detections.detections = std::move(strong);
  if (!viewed.poses) return viewed;
  std::vector<ObjectPose> poses;
  for (ObjectPose& pose : viewed.poses->poses) {
    const bool known = pose.detection_index >= 0 && pose.detection_index < static_cast<int>(new_index.size());
    if (known && new_index[static_cast<std::size_t>(pose.detection_index)] < 0) continue;
    if (known) pose.detection_index = new_index[static_cast<std::size_t>(pose.detection_index)];
    poses.push_back(std::move(pose));
  }
  viewed.poses->poses = std::move(poses);
  return viewed;
}

cv::Mat draw_frame_view(const ViewedFrame& all, const ClassModels& models, const FrameViewSettings& settings) {
  const ViewedFrame viewed = without_weak(all, settings.min_score);
  cv::Mat picture = draw_overlay(viewed.frame, viewed.detections, viewed.poses, models);
  if (settings.show_depth) {
    cv::hconcat(picture, colour_depth(viewed.frame.depth, settings.depth_near, settings.depth_far), picture);
  }
  cv::vconcat(picture, draw_panel(viewed, picture.cols), picture);
  cv::copyMakeBorder(picture, picture, 0, picture.rows % 2, 0, picture.cols % 2, cv::BORDER_REPLICATE);
  return picture;
}

}  // namespace houghstream
