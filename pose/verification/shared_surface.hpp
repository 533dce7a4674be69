#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pipeline/geometry/renderer.hpp"
#include "pipeline/types/frame.hpp"
#include "pose/model/object_model.hpp"
#include "pose/seen/depth_score.hpp"

namespace houghstream {

/// A model at a pose, T_camera_object in metres.
struct PlacedModel {
  const ObjectModel& model;
  const Eigen::Isometry3d& T_camera_object;
};

/// Returns the fraction of the measured pixels that both models explain, of those that the model with fewer explains,
/// 0 to 1: each pixel belongs to one object only (Aldoma et al. 2012, "A Global Hypotheses Verification Method for 3D
/// Object Recognition"). A model explains a pixel where its depth agrees with what was measured; both do where their
/// surfaces coincide, too. Things that touch, or that lie in one another, share nothing. 0 where the models are too far
/// apart to share much, which is told without rendering them.
float shared_surface(const RgbdFrame& frame, const PlacedModel& a, const PlacedModel& b,
                     const DepthTolerance& tolerance);

/// The measured surface that models explain at their poses. The frame must outlive it.
class ExplainedSurface {
 public:
  ExplainedSurface(const RgbdFrame& frame, const DepthTolerance& tolerance) : frame_(frame), tolerance_(tolerance) {}

  void add(const PlacedModel& placed);
  bool is_empty() const { return parts_.empty(); }
  /// Returns the fraction of the visible points of a model, of those that agree with the measured depth, which lie on
  /// the surface of one of the added models, 0 to 1. The model itself is not rendered: its points of the nearest view
  /// tell enough before its pose is exact.
  float fraction_of(const PlacedModel& placed) const;

 private:
  const RgbdFrame& frame_;
  DepthTolerance tolerance_;
  std::vector<RenderedRegion> parts_;
};

}  // namespace houghstream
