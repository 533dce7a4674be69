#include "pose/verification/quality.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/base/logit.hpp"

namespace houghstream {
namespace {

double texture_agreement(const ColourComparison& colour) {
  constexpr double kShading = 250.0;            // variance that highlights, shade and noise make on a plain surface
  constexpr double kUntexturedAgreement = 0.7;  // agreement of most plain surfaces
  constexpr double kMin = -0.5;
  const auto residual_stddev = static_cast<double>(colour.residual_stddev);
  const auto contrast = static_cast<double>(colour.observed_contrast);
  const double agreement = 1.0 - residual_stddev * residual_stddev / (kShading + contrast * contrast);
  const double compared_fraction =
      static_cast<double>(colour.points) / static_cast<double>(colour.points + colour.clipped);
  return compared_fraction * std::max(kMin, agreement) + (1.0 - compared_fraction) * kUntexturedAgreement;
}

}  // namespace

PoseEvidence gather_evidence(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                             float detection_score, const VerificationSettings& settings) {
  const DepthTolerance tolerance{settings.tolerance_m, observation.noise};
  const ProjectedView projected = project_view(observation.frame, observation.model, T_camera_object, settings.points);
  return {detection_score,
          verify_pose(observation.frame, observation.model.mesh, T_camera_object, tolerance, &observation.colours),
          compare_texture(observation, projected, tolerance)};
}

void bring_to_camera(const ChromaMap& camera, PoseEvidence& evidence) {
  if (evidence.colour) evidence.colour->chroma_difference = chroma_difference(evidence.colour->chroma, camera);
}

QualityTerms quality_terms(const PoseEvidence& evidence, const QualitySettings& settings) {
  constexpr double kCameraContrastSq = 0.25;  // cameras show about half of a model's contrast
  // Added to shares, so that none weighs too much where there is little of it.
  constexpr double kMinViolation = 0.01;
  constexpr double kFraction = 0.05;
  constexpr double kNeutral = 0.5;        // an unobserved boundary is neutral
  constexpr double kUnknownColour = 0.8;  // factor of the usual agreement: missing colours prove nothing
  const Verification& depth = evidence.depth;
  const double compared_points = std::max(1, depth.depth_inliers + depth.free_space_violations);
  QualityTerms terms = settings.mean_of_correct;
  terms.detection_logit = logit(static_cast<double>(evidence.detection_score));
  terms.free_space_violation = -std::log(depth.free_space_violations / compared_points + kMinViolation);
  terms.visible = std::log(static_cast<double>(depth.visible_fraction()) + kFraction);
  const double continuation = depth.boundary_samples > 0
                                  ? static_cast<double>(depth.boundary_continuations) / depth.boundary_samples
                                  : kNeutral;
  terms.outline = std::log((1.0 - continuation + kFraction) / (continuation + kFraction));
  if (evidence.colour) {
    terms.chroma_difference = -static_cast<double>(evidence.colour->chroma_difference);
    terms.texture = texture_agreement(*evidence.colour);
    const auto residual_stddev = static_cast<double>(evidence.colour->residual_stddev);
    terms.unexplained_variance = -std::log(residual_stddev * residual_stddev + kUntexturedVariance);
    const auto contrast = static_cast<double>(evidence.colour->model_contrast);
    terms.model_contrast = -std::log(kCameraContrastSq * contrast * contrast + kUntexturedVariance);
  } else {
    terms.texture *= kUnknownColour;
  }
  return terms;
}

float shape_quality(const QualityTerms& terms, const QualitySettings& settings) {
  double sum = settings.bias;
  for (const auto term : kQualityTerms) sum += settings.weights.*term * terms.*term;
  return static_cast<float>(logistic(sum));
}

float texture_probability(double margin, const TextureSettings& settings) {
  constexpr double kMax = 8.0;  // log odds: what is surer has not been learnt from
  return static_cast<float>(logistic(settings.bias + settings.margin_weight * std::clamp(margin, -kMax, kMax)));
}

std::optional<ChromaPair> chroma_pair(const std::string& class_name, const PoseEvidence& evidence,
                                      const QualitySettings& settings) {
  if (!evidence.colour) return std::nullopt;
  QualityTerms terms = quality_terms(evidence, settings);
  terms.chroma_difference = settings.mean_of_correct.chroma_difference;
  const ChromaMeans& chroma = evidence.colour->unclipped_chroma;
  ChromaPair pair;
  pair.class_name = class_name;
  pair.model = chroma.model;
  pair.measured = chroma.measured;
  pair.lightness = chroma.lightness;
  pair.probability = static_cast<double>(shape_quality(terms, settings));
  return pair;
}

PoseStatus find_rejection_reason(const QualityTerms& terms, const QualitySettings& settings, bool colours_known) {
  constexpr std::array<PoseStatus, kQualityTerms.size()> kReasons = {
      PoseStatus::kLowScore,          PoseStatus::kRejectedByDepth,  PoseStatus::kRejectedByDepth,
      PoseStatus::kRejectedByOutline, PoseStatus::kRejectedByColour, PoseStatus::kRejectedByColour,
      PoseStatus::kRejectedByColour,  PoseStatus::kRejectedByColour};
  const auto evidence_against = [&](std::size_t i) {
    const auto term = kQualityTerms[i];
    return settings.weights.*term * (settings.mean_of_correct.*term - terms.*term);
  };
  std::size_t strongest = 0;
  for (std::size_t i = 1; i < kReasons.size(); ++i) {
    if (!colours_known && kReasons[i] == PoseStatus::kRejectedByColour) continue;
    if (evidence_against(i) > evidence_against(strongest)) strongest = i;
  }
  return kReasons[strongest];
}

}  // namespace houghstream
