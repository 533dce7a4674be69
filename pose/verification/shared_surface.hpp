#pragma once

#include <Eigen/Geometry>
#include <vector>

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

/// The surface that models show at their poses, as the points of their nearest views. The models must outlive it.
class ExplainedSurface {
 public:
  void add(const PlacedModel& placed);
  bool is_empty() const { return parts_.empty(); }
  /// Returns the fraction of the visible points of a model, of those that agree with the measured depth, which lie on
  /// the surface of one of the added models, 0 to 1. Nothing is rendered: points tell enough before a pose is exact.
  float fraction_of(const RgbdFrame& frame, const PlacedModel& placed, const DepthTolerance& tolerance) const;

 private:
  struct Part {
    const ModelView* view = nullptr;
    Eigen::Isometry3f T_model_camera = Eigen::Isometry3f::Identity();
    Eigen::Vector3f centre = Eigen::Vector3f::Zero();  ///< ObjectModel::centre
    float radius = 0.0F;                               ///< metres

    bool contains(const Eigen::Vector3f& point_camera, float limit) const;
  };
  std::vector<Part> parts_;
};

}  // namespace houghstream
