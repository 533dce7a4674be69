#include "pose/seen/foreground_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace houghstream {

ForegroundEvidence::ForegroundEvidence(const ObjectObservation& observation, RenderedRegion rendered,
                                       const DepthTolerance& tolerance,
                                       const std::function<bool(const cv::Point&)>& may_be_object)
    : observation_(observation),
      tolerance_(tolerance),
      rendered_(std::move(rendered)),
      colours_(compare_colours(may_be_object)) {}

std::optional<ColourDiscriminant> ForegroundEvidence::compare_colours(
    const std::function<bool(const cv::Point&)>& may_be_object) const {
  if (!may_be_object) return std::nullopt;
  const cv::Mat& lab = observation_.colours.lab;
  ColourMoments object;
  ColourMoments beside;
  constexpr double kPixels = 4000.0;  // enough for means and covariances
  const int step = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(lab.total()) / kPixels)));
  for (int y = 0; y < lab.rows; y += step) {
    for (int x = 0; x < lab.cols; x += step) {
      const cv::Point at = cv::Point(x, y) + observation_.colours.origin_px;
      const float model = rendered_.depth_at(at);
      if (std::isnan(model)) {
        if (!may_be_object(at)) beside.add(lab.at<cv::Vec3b>(y, x));
      } else if (std::abs(observation_.frame.depth.at<float>(at) - model) <= tolerance_.at(model)) {
        object.add(lab.at<cv::Vec3b>(y, x));
      }
    }
  }
  return ColourDiscriminant::between(object, beside);
}

double ForegroundEvidence::colour_evidence(const cv::Point& at_px) const {
  const LabRegion& colours = observation_.colours;
  const cv::Point in_region = at_px - colours.origin_px;
  const bool is_known = colours_ && cv::Rect(cv::Point(), colours.lab.size()).contains(in_region);
  return is_known ? colours_->evidence(colours.lab.at<cv::Vec3b>(in_region)) : 0.0;
}

double ForegroundEvidence::at(const cv::Point& at_px, double model_depth, bool is_beyond_model) const {
  // Less than the tolerance of other comparisons, since tables and neighbours touch objects.
  constexpr double kToleranceRatio = 0.4;
  constexpr double kDepthAlone = 0.5;
  constexpr double kColourAlone = 0.5;
  const double limit = kToleranceRatio * tolerance_.at(model_depth);
  const double difference = static_cast<double>(observation_.frame.depth.at<float>(at_px)) - model_depth;
  const double colour = colour_evidence(at_px);
  if (std::isnan(difference)) return is_beyond_model ? kColourAlone * colour : 0.0;
  if (difference < -limit) return 0.0;
  // A depth camera may see past what is thin, where the colours show it.
  if (difference > limit) return is_beyond_model && colour > kColourAlone ? 0.0 : -1.0;
  return colours_ ? colour : kDepthAlone;
}

}  // namespace houghstream
