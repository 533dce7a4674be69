#include "detector/hough_images.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "detector/scale_space_search.hpp"
#include "detector/seen_patches.hpp"

namespace houghstream {
namespace {

cv::Mat largest_over_sizes(const Forest& forest, int class_index, const RgbdFrame& frame,
                           const DetectionSettings& settings) {
  cv::Mat largest = cv::Mat::zeros(frame.colour.size(), CV_32FC1);
  for (const cv::Mat& image : scale_space_hough_images(forest, class_index, frame, settings)) {
    cv::Mat resized;
    cv::resize(image, resized, largest.size(), 0, 0, cv::INTER_LINEAR);
    cv::max(largest, resized, largest);
  }
  return largest;
}

/// The last row and column of cells may reach over the frame's border.
cv::Mat at_frame_size(const HoughSpace& space, const Camera& working_camera, cv::Size frame_size) {
  const cv::Mat cells = cv::Mat(space.image).reshape(1, space.height);
  const auto enlarged = [&](int count, int working, int frame) {
    return static_cast<int>(std::ceil(static_cast<double>(count) * space.cell_px * frame / working));
  };
  const cv::Size size(enlarged(space.width, working_camera.width, frame_size.width),
                      enlarged(space.height, working_camera.height, frame_size.height));
  cv::Mat image;
  cv::resize(cells, image, size, 0, 0, cv::INTER_LINEAR);
  return image(cv::Rect(cv::Point(), frame_size)).clone();
}

}  // namespace

cv::Mat hough_image(const Forest& forest, int class_index, const RgbdFrame& frame, const DetectionSettings& settings) {
  if (forest.features.handling == ScaleHandling::kScaleSpace) {
    return largest_over_sizes(forest, class_index, frame, settings);
  }
  StageClock clock;
  const SeenPatches seen = classify_patches(forest, frame, settings, clock);
  const HoughSpace space = cast_votes(forest, class_index, seen.grid, seen.leaves, seen.hough_camera, settings);
  return at_frame_size(space, seen.hough_camera, frame.colour.size());
}

}  // namespace houghstream
