#pragma once

#include <memory>
#include <opencv2/rgbd/linemod.hpp>
#include <string>
#include <vector>

#include "pipeline/types/training_view.hpp"
#include "tools/studies/baselines/linemod_settings.hpp"

namespace houghstream {

/// Data of a template that cv::linemod does not keep. Pixels count from the position of a match.
struct LinemodTemplate {
  struct DepthSample {
    cv::Point at_px;
    float depth = 0.0F;  ///< metres
  };
  int class_id = 0;
  std::string class_name;
  float distance = 0.0F;             ///< distance of the object frame's origin, metres
  cv::Rect box_px;                   ///< bounding box of the mask
  cv::Point2f origin_px;             ///< pixel of the object frame's origin
  std::vector<DepthSample> samples;  ///< evenly spread over the mask, never empty
  int rank = 0;                      ///< order by view, then distance; decides between equal matches
};

struct LinemodMatch {
  float similarity = 0.0F;                 ///< percent
  const LinemodTemplate* shape = nullptr;  ///< lives as long as the LinemodTemplates
  cv::Point at_px;
};

/// Holds the outcome of the training views.
struct LinemodTraining {
  int templates = 0;
  int refused_templates = 0;  ///< too small or too plain for the number of features
  int refused_views = 0;      ///< views without a template: no mask, no depth, or refused at each distance
};

class LinemodShare;

/// Templates of views at a row of distances (Hinterstoisser et al. 2011), made and matched by cv::linemod with colour
/// gradients and depth normals.
class LinemodTemplates {
 public:
  /// Background views are passed over. Throws InputError for settings out of range, where no template can be made, and
  /// for a view whose images disagree.
  LinemodTemplates(const std::vector<TrainingView>& views, const LinemodTemplateSettings& settings);
  ~LinemodTemplates();
  LinemodTemplates(LinemodTemplates&&) noexcept;

  /// Matches the templates, strongest first, in an order that depends on views, settings and frame alone.
  std::vector<LinemodMatch> match(const RgbdFrame& frame, float threshold) const;

  const LinemodTraining& training() const { return training_; }

 private:
  std::vector<LinemodShare> shares_;
  LinemodTraining training_;
};

/// Holds the templates of one thread, since cv::linemod itself uses only one.
class LinemodShare {
 public:
  explicit LinemodShare(const LinemodTemplateSettings& settings);

  /// Makes a template and counts it; returns whether that succeeded. `rank` as in LinemodTemplate.
  bool add(const TrainingView& view, double distance, int rank);
  void count_refused_view() { ++training_.refused_views; }

  /// Returns the matches in no particular order. `images` are those of linemod_images().
  std::vector<LinemodMatch> match(const std::vector<cv::Mat>& images, float threshold) const;

  cv::Size largest() const { return largest_; }  ///< width and height of the templates, each the greatest, pixels
  const LinemodTraining& training() const { return training_; }

 private:
  cv::Ptr<cv::linemod::Detector> linemod_;
  std::vector<LinemodTemplate> templates_;  // in the order of cv::linemod's numbers
  cv::Size largest_;
  LinemodTraining training_;
  float focal_px_;
};

}  // namespace houghstream
