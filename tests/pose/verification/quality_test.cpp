#include "pose/verification/quality.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

/// A pose about which nothing is wrong.
PoseEvidence good() {
  PoseEvidence evidence;
  evidence.detection_score = 0.9F;
  evidence.depth.rendered = 2000;
  evidence.depth.agreeing = 1800;
  evidence.depth.violating = 20;
  evidence.depth.outline_ends = 150;
  evidence.depth.outline_continues = 15;
  evidence.colour = ColourComparison{400, 0.6F, 14.0F, 0.5F};
  return evidence;
}

float quality(const PoseEvidence& evidence) {
  return pose_quality(quality_terms(evidence, {}), {});
}

PoseStatus reason(const PoseEvidence& evidence) {
  return reason_against(quality_terms(evidence, {}), {});
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
  evidence.depth.violating = 900;
  evidence.depth.agreeing = 900;
  EXPECT_LT(quality(evidence), quality(good()) - 0.1F);
  EXPECT_EQ(reason(evidence), PoseStatus::kRejectedByDepth);
}

TEST(PoseQuality, ASurfaceThatGoesOnSpeaksAgainstAPose) {
  PoseEvidence evidence = good();
  std::swap(evidence.depth.outline_ends, evidence.depth.outline_continues);
  EXPECT_LT(quality(evidence), quality(good()));
  EXPECT_EQ(reason(evidence), PoseStatus::kRejectedByOutline);
}

/// A right pose as most are.
QualityTerms typical() {
  return QualitySettings{}.typical;
}

TEST(PoseQuality, AnotherPrintSpeaksAgainstAPose) {
  PoseEvidence evidence = good();
  evidence.colour->agreement = 0.0F;
  EXPECT_LT(quality(evidence), quality(good()));
  EXPECT_EQ(reason(evidence), PoseStatus::kRejectedByColour);
  QualityTerms terms = typical();
  terms.agreement = quality_terms(evidence, {}).agreement;
  EXPECT_LT(pose_quality(terms, {}), pose_quality(typical(), {}) - 0.1F);
}

TEST(PoseQuality, AnotherColourSpeaksAgainstAPose) {
  PoseEvidence evidence = good();
  evidence.colour->chroma_conflict = 3.0F;
  EXPECT_LT(quality(evidence), quality(good()));
  EXPECT_EQ(reason(evidence), PoseStatus::kRejectedByColour);
  QualityTerms terms = typical();
  terms.chroma_conflict = quality_terms(evidence, {}).chroma_conflict;
  EXPECT_LT(pose_quality(terms, {}), pose_quality(typical(), {}) - 0.1F);
}

TEST(PoseQuality, ColoursThatContradictCountNoMoreThanAsMuch) {
  PoseEvidence evidence = good();
  evidence.colour->agreement = -0.5F;
  const float contradicted = quality(evidence);
  evidence.colour->agreement = -20.0F;
  EXPECT_EQ(quality(evidence), contradicted);
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
  evidence.depth.violating = 900;
  evidence.depth.agreeing = 900;
  EXPECT_LT(quality(evidence), 0.9F) << "no colours are no proof";
}

}  // namespace
}  // namespace houghstream
