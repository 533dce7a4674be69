#pragma once

#include <vector>

#include "pipeline/types/detection.hpp"
#include "tools/studies/baselines/linemod_templates.hpp"

namespace houghstream {

/// Returns whether the scene has the template's depth where the template matched: the median difference is within
/// `tolerance` times the template's distance. True where the scene has no depth there.
bool depth_agrees(const LinemodMatch& match, const cv::Mat& depth, float tolerance);

/// Selects the strongest of the matches (given strongest first) as detections: score is similarity / 100, the box that
/// of the template's mask inside the frame, the centre the template's.
std::vector<Detection> select_detections(const std::vector<LinemodMatch>& matches, const RgbdFrame& frame,
                                         const LinemodSelection& selection);

/// Implements the baseline that the paper compares with (Haensch et al. 2017, Section 6): LINEMOD (Hinterstoisser et
/// al. 2011) as in OpenCV. OpenCV's colour features lie on the outline only, and matching ignores distance: the check
/// of depth is ours, off by default.
class LinemodDetector {
 public:
  /// See LinemodTemplates for what is refused.
  LinemodDetector(const std::vector<TrainingView>& views, const LinemodTemplateSettings& settings,
                  const LinemodSelection& selection);

  /// Detects objects, the strongest first. Its stages are "linemod.match" and "linemod.select". Throws InputError for
  /// an invalid frame.
  Detections detect(const RgbdFrame& frame) const;

  const LinemodTraining& training() const { return templates_.training(); }

 private:
  LinemodTemplates templates_;
  LinemodSelection selection_;
};

}  // namespace houghstream
