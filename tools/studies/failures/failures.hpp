#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tools/evaluate/metrics/detection_metrics.hpp"

namespace houghstream {

/// A false detection, or a true object that was not found.
struct Failure {
  enum class Kind { kFalse, kMissed };
  Kind kind = Kind::kFalse;
  std::string class_name;
  std::size_t frame = 0;  ///< index in the evaluated frames
  cv::Rect2f box_px;      ///< box of the detection, or of the visible part of the object
  double weight = 0.0;    ///< score of the detection, or how much of the object is visible; 0 to 1
};

/// Criteria of a failure, and the number of failures that are drawn.
struct FailureRules {
  DetectionRules detection;
  float operating_score = 0.0F;  ///< minimum score of a counted detection
  std::size_t count = 0;         ///< maximum number
  std::size_t apart = 0;  ///< minimum frames between two of one class and kind, as neighbouring frames fail similarly
};

/// Failures of the listed classes, the gravest of each class and kind first, in turn over classes and kinds.
std::vector<Failure> choose_failures(const std::vector<EvaluatedFrame>& frames, const std::vector<std::string>& classes,
                                     const FailureRules& rules);

/// Returns a part of the frame, four wide and three high where the frame allows it, with the box in its middle.
cv::Rect surroundings(const cv::Rect2f& box, const cv::Size& frame);

/// Draws the failure's surroundings with its box, and a line that names it. `colour` is the whole frame, CV_8UC3.
cv::Mat draw_failure(const Failure& failure, const cv::Mat& colour);

/// Joins tiles of one size side by side, `columns` in a row; without any, it returns a tile that states so.
cv::Mat join_tiles(const std::vector<cv::Mat>& tiles, int columns);

}  // namespace houghstream
