#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace houghstream {

/// Holds a box with a few words beside it.
struct NamedBox {
  cv::Rect2f box_px;
  std::string words;
  cv::Scalar colour;  ///< BGR
};

/// The votes for one class, and what was found by them.
struct HoughPanel {
  std::string title;
  cv::Mat votes;                ///< CV_32FC1 of the frame's size, from 0 on
  std::vector<NamedBox> found;  ///< strongest first; those that follow the first few are counted only
};

/// Draws one image: the colour image with the ground-truth boxes, then each class's votes in colours over the darkened
/// image. All panels share one scale, up to the highest value of any; the captions name it. Throws InputError where
/// sizes differ.
cv::Mat draw_hough_panels(const cv::Mat& colour, const std::vector<NamedBox>& truth,
                          const std::vector<HoughPanel>& panels);

}  // namespace houghstream
