#include "pose/verification/pose_decision.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/base/logit.hpp"

namespace houghstream {
namespace {

/// Presence probability below which a detection is taken back: the score from which it was reported, by default. In 80
/// images of furnished rooms, with 21 objects, 34 detections without a pose stay reported from 0.5 on, 25 of them
/// false, and 27 from 0.65 on, with the same true ones.
constexpr float kRefutedBelow = 0.65F;

/// Sets the status by the qualities, and returns whether the pose is published. Otherwise it is kRefuted, or for the
/// caller to give a reason.
bool update_status(bool reported, const QualitySettings& quality, ObjectPose& pose) {
  const float minimum = reported ? quality.min_quality : quality.min_candidate_quality;
  if (pose.shape_quality >= minimum) {
    pose.status = pose.quality >= minimum ? PoseStatus::kValid : PoseStatus::kValidUpToSymmetry;
    return true;
  }
  const float presence = presence_probability(pose.detection_score, pose.shape_quality, quality.presence);
  pose.status = reported && presence < kRefutedBelow ? PoseStatus::kRefuted : PoseStatus::kInvalid;
  return false;
}

/// Returns the distance of an object's measured chroma from what a surer one of its model lets expect, over the spread
/// of plain surfaces in changing light. The surer one's chroma is brought to the object's lightness (where a light
/// scales X, Y and Z, chroma goes with L* + 16), and to the side that the object shows, as the camera renders colours.
double instance_difference(const ChromaPair& surer, const ChromaPair& pair, const ChromaMap& camera) {
  constexpr double kPlainStddev = 10.0;     // of a* and b*, as for a comparison with the model
  constexpr double kGainUncertainty = 0.5;  // of the camera's saturation
  constexpr double kMaxRatio = 2.0;
  const double ratio =
      std::clamp(chroma_scale(pair.lightness) / chroma_scale(surer.lightness), 1.0 / kMaxRatio, kMaxRatio);
  const Eigen::Vector2d other_side =
      camera.apply(pair.model, pair.lightness) - camera.apply(surer.model, pair.lightness);
  const double stddev = std::hypot(kPlainStddev, kGainUncertainty * other_side.norm());
  return (pair.measured - ratio * surer.measured - other_side).norm() / stddev;
}

}  // namespace

void decide_status(const PoseEvidence& evidence, const Eigen::Isometry3d& T_camera_object, bool reported,
                   const QualitySettings& quality, ObjectPose& pose) {
  const QualityTerms terms = quality_terms(evidence, quality);
  pose.visible_fraction = evidence.depth.visible_fraction();
  pose.free_space_violation = evidence.depth.free_space_violation();
  pose.shape_quality = shape_quality(terms, quality);
  pose.quality = pose.shape_quality * evidence.texture_probability;
  const bool published = update_status(reported, quality, pose);
  if (published) {
    pose.T_camera_object = T_camera_object;
  } else if (pose.status != PoseStatus::kRefuted) {
    pose.status = find_rejection_reason(terms, quality, evidence.colour.has_value());
  }
}

void compare_with_instance(const ObjectPose& surer, bool reported, const QualitySettings& quality, ObjectPose& pose) {
  const double excess = instance_difference(*surer.chroma, *pose.chroma, pose.camera_colours) +
                        quality.mean_of_correct.chroma_difference;  // negated mean
  const double penalty = std::max(0.0, quality.weights.chroma_difference * excess);
  const double log_odds = logit(static_cast<double>(pose.shape_quality), kQualityMargin) - penalty;
  const float texture = texture_probability_of(pose);
  pose.shape_quality = static_cast<float>(logistic(log_odds));
  pose.quality = pose.shape_quality * texture;
  if (update_status(reported, quality, pose)) return;
  if (pose.status != PoseStatus::kRefuted) pose.status = PoseStatus::kRejectedByColour;
  pose.T_camera_object.reset();
}

float texture_probability_of(const ObjectPose& pose) {
  return pose.shape_quality > 0.0F ? pose.quality / pose.shape_quality : 1.0F;
}

void copy_registration_evidence(const RegistrationResult& result, ObjectPose& pose) {
  pose.converged = result.converged;
  pose.iterations = result.iterations;
  pose.inliers = result.inliers;
  pose.inlier_fraction = result.inlier_fraction;
  pose.residual = result.residual;
}

}  // namespace houghstream
