#pragma once

#include <opencv2/rgbd/linemod.hpp>
#include <vector>

#include "tools/studies/rivals/linemod_templates.hpp"

namespace houghstream {

/// The templates of one thread: cv::linemod itself uses one only.
class LinemodShare {
 public:
  explicit LinemodShare(const LinemodTemplateSettings& settings);

  /// Whether a template could be made; counts it. `rank` as in LinemodTemplate.
  bool add(const TrainingView& view, double distance, int rank);
  void count_refused_view() { ++training_.refused_views; }

  /// In no particular order. `images` as linemod_images() makes them.
  std::vector<LinemodMatch> match(const std::vector<cv::Mat>& images, float threshold) const;

  cv::Size largest() const { return largest_; }  ///< width and height of the templates, each the greatest, pixels
  const LinemodTraining& training() const { return training_; }

 private:
  cv::Ptr<cv::linemod::Detector> linemod_;
  std::vector<LinemodTemplate> templates_;  // by cv::linemod's number
  cv::Size largest_;
  LinemodTraining training_;
  float focal_px_;
};

}  // namespace houghstream
