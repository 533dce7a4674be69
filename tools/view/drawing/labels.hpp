#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace houghstream::view {

/// Names a thing in an image.
struct Label {
  std::string text;
  cv::Rect thing;         ///< pixels that the label belongs to
  cv::Scalar background;  ///< BGR
  int class_id = 0;       ///< class of the thing
};

/// Returns where labels of these sizes stand in an image: along a side of the thing, above it where there is space, so
/// that they cover no other label's thing; where that cannot be, near it in the open, else on a neighbour, else as near
/// as the image and the labels before it allow. A label is inside the image, and covers none of `occupied` and of the
/// labels before it, as long as the image has space for it; where it has none, its rectangle is empty. A label wider
/// than the image is as wide as the image.
std::vector<cv::Rect> place_labels(const std::vector<Label>& labels, const std::vector<cv::Size>& sizes,
                                   const cv::Size& image, std::vector<cv::Rect> occupied = {});

/// Draws the labels, those first in the list next to their things; one that stands apart has a line to its thing. Text
/// that does not fit the image is cut off, and a label without space is left out. No label is drawn over `occupied`.
void draw_labels(cv::Mat& image, const std::vector<Label>& labels, const std::vector<cv::Rect>& occupied = {});

}  // namespace houghstream::view
