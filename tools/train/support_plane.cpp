#include "tools/train/support_plane.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/parallel.hpp"
#include "pose/reconstruction/selection/support_planes.hpp"

namespace houghstream {
namespace {

/// Returns the part of the view about the object, with depth beside the object only.
RgbdFrame surroundings_of(const TrainingView& view) {
  constexpr int kMinMargin_px = 40;
  constexpr int kEdge_px = 7;  // of the object, where depth may be either's
  const cv::Rect box = cv::boundingRect(view.mask);
  const int margin = std::max(kMinMargin_px, std::max(box.width, box.height) / 2);
  const cv::Rect around = cv::Rect(box.x - margin, box.y - margin, box.width + 2 * margin, box.height + 2 * margin) &
                          cv::Rect(cv::Point(), view.mask.size());
  cv::Mat object;
  cv::dilate(view.mask(around), object, cv::Mat::ones(kEdge_px, kEdge_px, CV_8UC1));
  RgbdFrame frame;
  frame.camera = view.frame.camera.cropped(around.x, around.y, around.width, around.height);
  frame.colour = view.frame.colour(around);
  frame.depth = view.frame.depth(around).clone();
  frame.depth.setTo(std::numeric_limits<float>::quiet_NaN(), object);
  return frame;
}

/// Returns how high the object's measured points lie above a plane, metres, in ascending order.
std::vector<double> heights_above(const Plane& plane, const TrainingView& view) {
  std::vector<double> heights;
  for (int y = 0; y < view.mask.rows; ++y) {
    for (int x = 0; x < view.mask.cols; ++x) {
      const float z = view.frame.depth.at<float>(y, x);
      if (view.mask.at<std::uint8_t>(y, x) != 0 && std::isfinite(z))
        heights.push_back(plane.signedDistance(view.frame.camera.backproject(x, y, z)));
    }
  }
  std::sort(heights.begin(), heights.end());
  return heights;
}

}  // namespace

std::optional<Plane> find_support(const TrainingView& view) {
  constexpr double kTouches_m = 0.015;  // chosen: thrice the noise of depth at a metre, and a rounded edge
  constexpr double kBehind_m = 0.3;     // a wall farther behind the object carries nothing
  constexpr std::uint64_t kSeed = 1;
  const RgbdFrame around = surroundings_of(view);
  const double farthest = view.T_camera_object.translation().z() + kBehind_m;
  for (const Plane& plane : reconstruction::find_planes(around, farthest, kSeed)) {
    const std::vector<double> heights = heights_above(plane, view);
    if (heights.empty()) continue;
    const double lowest = heights[heights.size() / 20];
    if (std::abs(lowest) < kTouches_m) return plane;
  }
  return std::nullopt;
}

int find_supports(std::vector<TrainingView>& views, int threads) {
  parallel_for(threads, static_cast<int>(views.size()), [&](int i) {
    TrainingView& view = views[static_cast<std::size_t>(i)];
    if (view.class_id > 0) view.support = find_support(view);
  });
  return static_cast<int>(
      std::count_if(views.begin(), views.end(), [](const TrainingView& view) { return view.support.has_value(); }));
}

}  // namespace houghstream
