#include "pose/reconstruction/model/silhouette_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/parallel.hpp"
#include "pipeline/geometry/renderer.hpp"

namespace houghstream::reconstruction {
namespace {

constexpr int kMaxShift_px = 12;

/// Returns the model's depth in the view, with a margin so that it may be shifted.
cv::Mat render_with_margin(const Mesh& mesh, const TrainingView& view) {
  const Camera& camera = view.frame.camera;
  const cv::Size size(camera.width + 2 * kMaxShift_px, camera.height + 2 * kMaxShift_px);
  return render_depth(mesh, view.T_camera_object, camera.cropped(-kMaxShift_px, -kMaxShift_px, size.width, size.height),
                      {{}, size});
}

double iou_at(const cv::Mat& outline, const cv::Mat& mask, const cv::Point& shift) {
  const cv::Mat shifted = outline({kMaxShift_px - shift.x, kMaxShift_px - shift.y, mask.cols, mask.rows});
  const int both = cv::countNonZero(shifted & mask);
  const int either = cv::countNonZero(shifted | mask);
  return either > 0 ? static_cast<double>(both) / either : 0.0;
}

/// Returns the shift of the model's outline that fits best. It climbs from no shift in steps of a pixel, and of equal
/// shifts keeps the first.
cv::Point best_shift(const cv::Mat& outline, const cv::Mat& mask) {
  cv::Point best;
  double maximum = iou_at(outline, mask, best);
  for (bool moved = true; moved;) {
    moved = false;
    for (const cv::Point& step : {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)}) {
      const cv::Point shift = best + step;
      if (std::max(std::abs(shift.x), std::abs(shift.y)) > kMaxShift_px) continue;
      const double iou = iou_at(outline, mask, shift);
      if (iou <= maximum) continue;
      maximum = iou;
      best = shift;
      moved = true;
    }
  }
  return best;
}

/// Returns the median of measured minus rendered depth; 0 where there is none.
double depth_offset(const cv::Mat& model, const cv::Point& shift, const TrainingView& view) {
  std::vector<float> offsets;
  for (int y = 0; y < view.mask.rows; ++y) {
    for (int x = 0; x < view.mask.cols; ++x) {
      const float offset =
          view.frame.depth.at<float>(y, x) - model.at<float>(y - shift.y + kMaxShift_px, x - shift.x + kMaxShift_px);
      if (view.mask.at<std::uint8_t>(y, x) != 0 && std::isfinite(offset)) offsets.push_back(offset);
    }
  }
  if (offsets.empty()) return 0.0;
  const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
  std::nth_element(offsets.begin(), middle, offsets.end());
  return *middle;
}

void align_view(const Mesh& mesh, TrainingView& view) {
  const cv::Mat model = render_with_margin(mesh, view);
  const cv::Mat outline = model == model;
  const cv::Point shift = best_shift(outline, view.mask);
  const double depth_change = depth_offset(model, shift, view);
  Eigen::Vector3d at = view.T_camera_object.translation();
  const double z = at.z();
  at.x() += shift.x * z / view.frame.camera.fx;
  at.y() += shift.y * z / view.frame.camera.fy;
  view.T_camera_object.translation() = at * ((z + depth_change) / z);
}

}  // namespace

double silhouette_iou(const Mesh& mesh, const TrainingView& view) {
  const cv::Mat model = render_with_margin(mesh, view);
  return iou_at(model == model, view.mask, {});
}

void align_silhouettes(const Mesh& mesh, int threads, std::vector<TrainingView>& views) {
  constexpr int kRounds = 3;
  parallel_for(threads, static_cast<int>(views.size()), [&](int i) {
    for (int round = 0; round < kRounds; ++round) align_view(mesh, views[static_cast<std::size_t>(i)]);
  });
}

}  // namespace houghstream::reconstruction
