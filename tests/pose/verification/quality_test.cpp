#include "pose/verification/quality.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

/// Returns a pose without any fault.
PoseEvidence good() {
  PoseEvidence evidence;
  evidence.detection_score = 0.9F;
  evidence.depth.rendered = 2000;
  evidence.depth.depth_inliers = 1800;
  evidence.depth.free_space_violations = 20;
  evidence.depth.boundary_samples = 165;
  evidence.depth.boundary_continuations = 2.0F;
  ColourComparison& colour = evidence.colour.emplace();
  colour.points = 400;
  colour.agreement = 0.6F;
  colour.residual_stddev = 14.0F;
  colour.chroma_difference = 0.5F;
  colour.observed_contrast = 24.0F;
  colour.model_contrast = 40.0F;
  return evidence;
}

float quality(const PoseEvidence& evidence) {
  return shape_quality(quality_terms(evidence, {}), {});
}

PoseStatus reason(const PoseEvidence& evidence) {
  return find_rejection_reason(quality_terms(evidence, {}), {});
}

TEST(PoseQuality, IsAProbabilityThatIsHighWhereNothingIsWrong) {
  EXPECT_GT(quality(good()), 0.95F);
  EXPECT_LE(quality(good()), 1.0F);
  PoseEvidence nothing;
  EXPECT_GE(quality(nothing), 0.0F);
  EXPECT_LT(quality(nothing), 0.05F);
}

TEST(PoseQuality, WhatWasSeenThroughSpeaksAgainstAPose) {
  PoseEvidence evidence = good();
  evidence.depth.free_space_violations = 900;
  evidence.depth.depth_inliers = 900;
  EXPECT_EQ(reason(evidence), PoseStatus::kRejectedByDepth);
  PoseEvidence before = good();
  before.detection_score = evidence.detection_score = 0.5F;  // a sure detection leaves little room below 1
  EXPECT_LT(quality(evidence), quality(before) - 0.1F);
}

TEST(PoseQuality, ASurfaceThatGoesOnSpeaksAgainstAPose) {
  PoseEvidence evidence = good();
  evidence.depth.boundary_continuations = 150.0F;
  EXPECT_LT(quality(evidence), quality(good()));
  EXPECT_EQ(reason(evidence), PoseStatus::kRejectedByOutline);
}

/// Returns a typical correct pose.
QualityTerms mean_of_correct() {
  return QualitySettings{}.mean_of_correct;
}

TEST(PoseQuality, AnotherTextureSpeaksAgainstAPose) {
  PoseEvidence evidence = good();
  evidence.colour->residual_stddev = evidence.colour->observed_contrast;
  EXPECT_LT(quality(evidence), quality(good()));
  EXPECT_EQ(reason(evidence), PoseStatus::kRejectedByColour);
  QualityTerms before = mean_of_correct();
  before.detection_logit = 0.0;  // a sure detection leaves little room below 1
  QualityTerms terms = before;
  terms.texture = quality_terms(evidence, {}).texture;
  EXPECT_LT(shape_quality(terms, {}), shape_quality(before, {}) - 0.1F);
}

TEST(PoseQuality, AnotherColourSpeaksAgainstAPose) {
  PoseEvidence evidence = good();
  evidence.colour->chroma_difference = 3.0F;
  EXPECT_LT(quality(evidence), quality(good()));
  EXPECT_EQ(reason(evidence), PoseStatus::kRejectedByColour);
  QualityTerms terms = mean_of_correct();
  terms.chroma_difference = quality_terms(evidence, {}).chroma_difference;
  EXPECT_LT(shape_quality(terms, {}), shape_quality(mean_of_correct(), {}) - 0.1F);
}

TEST(PoseQuality, ColoursThatContradictCountNoMoreThanAsMuch) {
  PoseEvidence evidence = good();
  evidence.colour->residual_stddev = 50.0F;
  const double contradicted = quality_terms(evidence, {}).texture;
  EXPECT_LT(contradicted, 0.0);
  evidence.colour->residual_stddev = 500.0F;
  EXPECT_EQ(quality_terms(evidence, {}).texture, contradicted);
}

TEST(PoseQuality, PlainThingsAgreeWithLittle) {
  PoseEvidence evidence = good();
  evidence.colour->observed_contrast = 12.0F;
  evidence.colour->residual_stddev = 10.0F;  // mostly shading and highlights
  evidence.colour->model_contrast = 5.0F;
  const QualityTerms plain = quality_terms(evidence, {});
  EXPECT_GT(plain.texture, 0.7);
  EXPECT_GT(plain.model_contrast, quality_terms(good(), {}).model_contrast + 1.0) << "there was little to agree with";
}

TEST(PoseQuality, WhatTheCameraWasAtItsLimitForIsNoProofOfAnotherTexture) {
  PoseEvidence evidence = good();
  evidence.colour->residual_stddev = evidence.colour->observed_contrast;
  const double compared = quality_terms(evidence, {}).texture;
  evidence.colour->clipped = 3 * evidence.colour->points;
  const double mostly_clipped = quality_terms(evidence, {}).texture;
  EXPECT_GT(mostly_clipped, compared + 0.2);
  EXPECT_LT(mostly_clipped, 0.7) << "nor of this one";
}

TEST(PoseQuality, AWeakDetectionSpeaksAgainstAPose) {
  PoseEvidence evidence = good();
  evidence.detection_score = 0.0F;  // no infinite odds
  EXPECT_LT(quality(evidence), quality(good()));
  EXPECT_EQ(reason(evidence), PoseStatus::kLowScore);
}

TEST(PoseQuality, AModelWithoutColoursIsJudgedByTheRest) {
  PoseEvidence evidence = good();
  evidence.colour.reset();
  EXPECT_GT(quality(evidence), 0.9F);
  evidence.detection_score = 0.5F;  // a sure detection leaves little room below 1
  evidence.depth.free_space_violations = 900;
  evidence.depth.depth_inliers = 900;
  EXPECT_LT(quality(evidence), 0.9F) << "no colours are no proof";
}

}  // namespace
}  // namespace houghstream
