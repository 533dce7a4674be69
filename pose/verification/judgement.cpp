#include "pose/verification/judgement.hpp"

namespace houghstream {

void judge(const PoseEvidence& evidence, const Eigen::Isometry3d& T_camera_object, bool reported,
           const PoseSettings& settings, ObjectPose& pose) {
  const auto learnt = settings.class_quality.find(pose.class_name);
  const QualitySettings& quality = learnt != settings.class_quality.end() ? learnt->second : settings.quality;
  const QualityTerms terms = quality_terms(evidence, quality);
  pose.visible_fraction = evidence.depth.visible_fraction();
  pose.free_space_violation = evidence.depth.free_space_violation();
  pose.quality = pose_quality(terms, quality);
  if (pose.quality < (reported ? quality.least : quality.least_of_candidates)) {
    pose.status = reason_against(terms, quality, evidence.colour.has_value());
  } else {
    pose.status = PoseStatus::kValid;
    pose.T_camera_object = T_camera_object;
  }
}

void tell_registration(const RegistrationResult& result, ObjectPose& pose) {
  pose.converged = result.converged;
  pose.iterations = result.iterations;
  pose.inliers = result.inliers;
  pose.inlier_fraction = result.inlier_fraction;
  pose.residual = result.residual;
}

}  // namespace houghstream
