#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>

#include "pipeline/geometry/renderer.hpp"
#include "pose/seen/colour_discriminant.hpp"
#include "pose/seen/region.hpp"

namespace houghstream {

/// Tells whether a pixel shows the object or what lies beside it, by depth and by the colours of both, where poses
/// differ too little in their surface for a score of the whole. The observation must outlive it.
class ForegroundEvidence {
 public:
  /// Learns the object's colours where depth agrees with the model, rendered at a registered pose, and the colours
  /// beside it outside of the model where `may_be_object` is false: pixels in question teach nothing. Without such a
  /// function depth decides alone.
  ForegroundEvidence(const ObjectObservation& observation, RenderedRegion rendered, const DepthTolerance& tolerance,
                     const std::function<bool(const cv::Point&)>& may_be_object);

  /// Returns the evidence that a pixel of the frame shows the object at a depth, -1 to 1; 0 where something nearer
  /// occludes it. `is_beyond_model`: the model at the registered pose does not cover the pixel.
  double at(const cv::Point& at_px, double model_depth, bool is_beyond_model) const;

  const RenderedRegion& rendered() const { return rendered_; }  ///< the model at the registered pose

 private:
  std::optional<ColourDiscriminant> compare_colours(const std::function<bool(const cv::Point&)>& may_be_object) const;
  double colour_evidence(const cv::Point& at_px) const;

  const ObjectObservation& observation_;
  DepthTolerance tolerance_;
  RenderedRegion rendered_;
  std::optional<ColourDiscriminant> colours_;  ///< nothing where the colours of both hardly differ
};

}  // namespace houghstream
