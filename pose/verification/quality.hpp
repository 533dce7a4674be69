#pragma once

#include <array>
#include <optional>
#include <string>

#include "pipeline/base/settings_fields.hpp"
#include "pipeline/types/object_pose.hpp"
#include "pose/seen/colour_score.hpp"
#include "pose/seen/region.hpp"
#include "pose/verification/presence.hpp"
#include "pose/verification/verification.hpp"

namespace houghstream {

/// Holds the evidence for and against a pose.
struct PoseEvidence {
  float detection_score = 0.0F;
  Verification depth;
  std::optional<ColourComparison> colour;  ///< empty where the model has no colours
  /// Probability that the pose is the correct one of those that are equivalent by shape; 1 where there are no others.
  float texture_probability = 1.0F;
};

/// Renders the model at the pose and compares its depth and its colours with what is seen.
PoseEvidence gather_evidence(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                             float detection_score, const VerificationSettings& settings);

/// Brings the model's colours to the camera's before they are compared.
void bring_to_camera(const ChromaMap& camera, PoseEvidence& evidence);

/// Holds a number for each term of the regression: a pose's evidence, the larger the better, or a weight of it.
struct QualityTerms {
  double detection_logit = 0.0;  ///< log odds of the detection's score
  /// Logarithm of the fraction of free-space violations among these and the depth inliers (negated).
  double free_space_violation = 0.0;
  double visible = 0.0;            ///< log of the visible fraction
  double outline = 0.0;            ///< log of how much of the outline ends what is seen over how much does not
  double chroma_difference = 0.0;  ///< see ColourComparison (negated)
  /// Fraction of the observed colours' variance that is explained, of as much as shading alone can cause and more:
  /// uniform objects agree with little. Clipped points count as uniform. At least -0.5.
  double texture = 0.0;
  double unexplained_variance = 0.0;  ///< log of the variance of the seen colours that is left over (negated)
  /// Logarithm of the variance of the model's colours there (negated): the contrast with which to agree.
  double model_contrast = 0.0;
};

/// The terms in the order in which they are summed, and their names.
inline constexpr std::array<double QualityTerms::*, 8> kQualityTerms = {&QualityTerms::detection_logit,
                                                                        &QualityTerms::free_space_violation,
                                                                        &QualityTerms::visible,
                                                                        &QualityTerms::outline,
                                                                        &QualityTerms::chroma_difference,
                                                                        &QualityTerms::texture,
                                                                        &QualityTerms::unexplained_variance,
                                                                        &QualityTerms::model_contrast};
inline constexpr std::array<const char*, kQualityTerms.size()> kQualityTermNames = {
    "detection_log_odds", "seen_through", "visible", "outline", "chroma_conflict", "print", "left_over", "contrast"};

/// Returns the terms of a list of values, in the order of kQualityTerms.
inline QualityTerms terms_of(const std::array<double, kQualityTerms.size()>& values) {
  QualityTerms terms;
  for (std::size_t i = 0; i < values.size(); ++i) terms.*kQualityTerms[i] = values[i];
  return terms;
}

template <typename Visit>
void fields(const QualityTerms& /*settings*/, const Visit& visit) {
  for (std::size_t i = 0; i < kQualityTerms.size(); ++i)
    visit(number(kQualityTermNames[i], kQualityTerms[i], -1e6, 1e6));
}

/// The probability that one of the poses that are equivalent by shape is correct is a logistic regression on its
/// texture's margin (TextureComparison::margin). The default takes the margin as it is. Settings that hs-teach learns
/// of an object replace it.
struct TextureSettings {
  double bias = 0.0;
  double margin_weight = 1.0;
};

template <typename Visit>
void fields(const TextureSettings& /*settings*/, const Visit& visit) {
  using S = TextureSettings;
  visit(number("bias", &S::bias, -1e6, 1e6));
  visit(number("of_margin", &S::margin_weight, -1e6, 1e6));
}

/// Returns a probability in (0, 1).
float texture_probability(double margin, const TextureSettings& settings);

/// The probability that a pose is correct up to its shape's symmetries is a logistic regression on the evidence.
/// hs-study quality (tools/studies/quality) learns these numbers, and reports how many poses are correct from which
/// `min_quality` on in scenes that the fit has not seen (a quarter in turn). They are of 1279 poses of detections from
/// score 0.1 on in 14 frames each of development_world_0 to 13, every other world seen by the time-of-flight camera;
/// 678 were correct. In scenes that the fit has not seen 642 of 653 are correct from `min_quality` on. The weight of
/// `free_space_violation` is older: it is not learnt. Settings that hs-teach learns of an object replace them.
struct QualitySettings {
  double bias = -5.54;
  QualityTerms weights = terms_of({1.56, 0.45, 1.18, 2.87, 2.79, 7.25, 1.42, -0.27});
  /// Means of correct poses: the term farthest below its mean is the reason for "no pose". Those of colour are also
  /// used for a model without colours.
  QualityTerms mean_of_correct = terms_of({1.95, 3.06, -0.17, 2.89, -0.23, 0.80, -5.29, -5.29});
  float min_quality = 0.75F;            ///< poses of lower quality are not published...
  float min_candidate_quality = 0.75F;  ///< ...nor are these of candidates (Detection::reported): most are false
  PresenceSettings presence;            ///< presence of the object as a function of score and quality
  TextureSettings texture;              ///< choice between poses that are equivalent by shape
};

template <typename Visit>
void fields(const QualitySettings& /*settings*/, const Visit& visit) {
  using S = QualitySettings;
  visit(number("bias", &S::bias, -1e6, 1e6));
  visit(group("weights", &S::weights));
  visit(group("typical", &S::mean_of_correct));
  visit(number("least", &S::min_quality, 0, 1));
  visit(number("min_candidate_quality", &S::min_candidate_quality, 0, 1));
  visit(group("presence", &S::presence));
  visit(group("print", &S::texture));
}

QualityTerms quality_terms(const PoseEvidence& evidence, const QualitySettings& settings);

/// Returns the probability in [0, 1] that the pose is correct up to the symmetries of its shape: the object is the one
/// that was detected, and its ADD-S error is below a tenth of the diameter.
float shape_quality(const QualityTerms& terms, const QualitySettings& settings);

/// Returns the chroma that the evidence shows of the camera where it was not clipped; nothing where the model has no
/// colours. Its probability is the quality that the pose would have with the usual chroma.
std::optional<ChromaPair> chroma_pair(const std::string& class_name, const PoseEvidence& evidence,
                                      const QualitySettings& settings);

/// Returns the status that names the term with the strongest evidence against the pose.
PoseStatus find_rejection_reason(const QualityTerms& terms, const QualitySettings& settings, bool colours_known = true);

// The names of before, for one release.
using PrintSettings [[deprecated("is TextureSettings now")]] = TextureSettings;

}  // namespace houghstream
