#include "detector/evidence/suppression.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

Detection boxed(float score, float x) {
  Detection detection;
  detection.score = score;
  detection.box_px = {x, 0, 100, 100};
  return detection;
}

TEST(Suppression, OfOverlappingBoxesTheStrongerStays) {
  // The boxes at 0 and 20 overlap by IoU 0.67, those at 20 and 40 too, those at 0 and 40 by 0.43.
  const std::vector<Detection> kept =
      suppress_overlaps({boxed(0.5F, 20), boxed(0.4F, 40), boxed(0.9F, 0)}, SuppressionSettings{});
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0].score, 0.9F);
  EXPECT_EQ(kept[1].score, 0.4F);  // only the dropped one overlapped it
}

TEST(Suppression, AnotherClassMustBeSignificantlyStrongerToSuppress) {
  Detection other = boxed(0.3F, 10);
  other.class_id = 2;
  EXPECT_EQ(suppress_overlaps({boxed(0.55F, 0), other}, SuppressionSettings{}).size(), 2U);
  EXPECT_EQ(suppress_overlaps({boxed(0.7F, 0), other}, SuppressionSettings{}).size(), 1U);
  other.score = 0.1F;  // five times weaker, but than something that nobody would report
  EXPECT_EQ(suppress_overlaps({boxed(0.45F, 0), other}, SuppressionSettings{}).size(), 2U);
}

std::vector<ScoredHypothesis> apart(const std::vector<std::pair<std::string, float>>& found) {
  std::vector<ScoredHypothesis> candidates;
  for (const auto& [name, score] : found) {
    ScoredHypothesis& candidate = candidates.emplace_back();
    candidate.detection = boxed(score, 200.0F * static_cast<float>(candidates.size()));
    candidate.detection.class_name = name;
  }
  return candidates;
}

TEST(Suppression, AClassIsReportedFromItsOwnThresholdOn) {
  EvidenceSettings evidence;
  evidence.threshold = 0.6F;
  evidence.class_thresholds = {{"brick", 0.1F}, {"mug", 0.9F}};
  evidence.candidates_from = 0.3F;
  evidence.max_candidates = 1;
  std::vector<ScoredHypothesis> candidates =
      apart({{"mug", 0.8F}, {"mug", 0.95F}, {"bowl", 0.65F}, {"bowl", 0.5F}, {"brick", 0.2F}, {"brick", 0.05F}});
  const std::vector<Detection> kept = suppress(candidates, evidence, SuppressionSettings{});
  std::vector<std::pair<float, bool>> scores;
  for (const Detection& detection : kept) scores.emplace_back(detection.score, detection.reported);
  const std::vector<std::pair<float, bool>> expected = {{0.95F, true}, {0.8F, false}, {0.65F, true}, {0.2F, true}};
  EXPECT_EQ(scores, expected) << "the one candidate of 0.8, and behind it what is reported";
}

}  // namespace
}  // namespace houghstream
