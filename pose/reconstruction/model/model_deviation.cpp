#include "pose/reconstruction/model/model_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "pipeline/base/parallel.hpp"
#include "pipeline/geometry/renderer.hpp"

namespace houghstream::reconstruction {
namespace {

/// Appends the distances of the measured points on the mask from the model along its normals: those along the line of
/// sight, times the cosine between the two.
void append_distances(const Mesh& mesh, const RgbdFrame& frame, const MaskedKeyframe& view,
                      std::vector<float>& distances) {
  const cv::Rect box = cv::boundingRect(view.mask);
  if (box.empty()) return;
  const cv::Mat model = render_depth(mesh, view.T_camera_object, frame.camera, box);
  for (int y = 1; y + 1 < box.height; y += 2) {
    for (int x = 1; x + 1 < box.width; x += 2) {
      const float z = frame.depth.at<float>(box.y + y, box.x + x);
      const float slope_x = model.at<float>(y, x + 1) - model.at<float>(y, x - 1);
      const float slope_y = model.at<float>(y + 1, x) - model.at<float>(y - 1, x);
      if (view.mask.at<std::uint8_t>(box.y + y, box.x + x) == 0 || !std::isfinite(slope_x + slope_y + z)) continue;
      const auto px = static_cast<float>(2.0 * frame.camera.metres_per_px(z));
      const float facing = 1.0F / std::sqrt(1.0F + (slope_x * slope_x + slope_y * slope_y) / (px * px));
      distances.push_back(std::abs(z - model.at<float>(y, x)) * facing);
    }
  }
}

double median(std::vector<float> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

cv::Mat render_visible_mask(const Mesh& mesh, const RgbdFrame& frame, const Eigen::Isometry3d& T_camera_object) {
  const cv::Mat model =
      render_depth(mesh, T_camera_object, frame.camera, {0, 0, frame.camera.width, frame.camera.height});
  cv::Mat mask = cv::Mat::zeros(frame.depth.size(), CV_8UC1);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      const float z = model.at<float>(y, x);
      if (!std::isfinite(z)) continue;
      const float measured = frame.depth.at<float>(y, x);
      const double tolerance = 0.008 + 3.0 * depth_sigma(z);
      const bool contradicts = measured < z - tolerance || measured > z + 2.0 * tolerance;
      mask.at<std::uint8_t>(y, x) = contradicts ? 0 : 255;
    }
  }
  return mask;
}

double free_space_violation(const Mesh& mesh, const Take& take, const std::vector<MaskedKeyframe>& views, int threads) {
  struct Count {
    double all = 0.0;
    double violations = 0.0;
  };
  std::vector<Count> counts(views.size());
  parallel_for(threads, static_cast<int>(views.size()), [&](int i) {
    const MaskedKeyframe& view = views[static_cast<std::size_t>(i)];
    const RgbdFrame& frame = take.keyframes[static_cast<std::size_t>(view.keyframe)].frame;
    const cv::Rect whole(0, 0, frame.camera.width, frame.camera.height);
    const cv::Mat model = render_depth(mesh, view.T_camera_object, frame.camera, whole);
    // The nearest depth about a pixel is compared, since the outline may be one pixel off.
    cv::Mat nearest = frame.depth.clone();
    // OpenCV's vectorised != may treat two NaN as equal; == does not.
    nearest.setTo(0.0F, ~(nearest == nearest));
    cv::erode(nearest, nearest, cv::Mat());
    Count& count = counts[static_cast<std::size_t>(i)];
    for (int y = 0; y < model.rows; ++y) {
      for (int x = 0; x < model.cols; ++x) {
        const float z = model.at<float>(y, x);
        if (!std::isfinite(z) || !(frame.depth.at<float>(y, x) > 0.0F)) continue;
        count.all += 1.0;
        count.violations += nearest.at<float>(y, x) > z + 0.012 + 3.0 * depth_sigma(z) ? 1.0 : 0.0;
      }
    }
  });
  Count sum;
  for (const Count& count : counts) {
    sum.all += count.all;
    sum.violations += count.violations;
  }
  return sum.all > 0.0 ? sum.violations / sum.all : 0.0;
}

double surface_deviation(const Mesh& mesh, const std::vector<ViewsOfTake>& of_takes, int threads) {
  std::vector<float> all;
  for (const ViewsOfTake& of_take : of_takes) {
    std::vector<std::vector<float>> distances(of_take.views->size());
    parallel_for(threads, static_cast<int>(distances.size()), [&](int i) {
      const auto at = static_cast<std::size_t>(i);
      const MaskedKeyframe& view = (*of_take.views)[at];
      const Keyframe& keyframe = of_take.take->keyframes[static_cast<std::size_t>(view.keyframe)];
      append_distances(mesh, keyframe.frame, view, distances[at]);
    });
    for (const std::vector<float>& of_view : distances) all.insert(all.end(), of_view.begin(), of_view.end());
  }
  return median(std::move(all));
}

}  // namespace houghstream::reconstruction
