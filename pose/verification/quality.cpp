#include "pose/verification/quality.hpp"

#include <algorithm>
#include <cmath>

namespace houghstream {
namespace {

double log_odds(double probability) {
  constexpr double kMargin = 0.001;  // a score of exactly 0 or 1 is not certainty
  const double p = std::clamp(probability, kMargin, 1.0 - kMargin);
  return std::log(p / (1.0 - p));
}

}  // namespace

QualityTerms quality_terms(const PoseEvidence& evidence, const QualitySettings& settings) {
  // Added to shares and counts, so that none weighs too much where there is little of it.
  constexpr double kShare = 0.01;
  constexpr double kFraction = 0.05;
  constexpr double kCount = 3.0;
  constexpr double kColourUnits = 10.0;
  constexpr double kUsualContrast = 18.0;
  const Verification& depth = evidence.depth;
  const double judged = std::max(1, depth.agreeing + depth.violating);
  QualityTerms terms = settings.typical;
  terms[0] = log_odds(static_cast<double>(evidence.detection_score));
  terms[1] = -std::log(depth.violating / judged + kShare);
  terms[2] = std::log(static_cast<double>(depth.visible_fraction()) + kFraction);
  terms[3] = std::log((depth.outline_ends + kCount) / (depth.outline_continues + kCount));
  if (evidence.colour) {
    terms[4] = -static_cast<double>(evidence.colour->chroma_shift) / kColourUnits;
    terms[5] = -std::max(0.0, static_cast<double>(evidence.colour->left_over) - kUsualContrast) / kColourUnits;
  }
  return terms;
}

float pose_quality(const QualityTerms& terms, const QualitySettings& settings) {
  double sum = settings.bias;
  for (std::size_t i = 0; i < terms.size(); ++i) sum += settings.weights[i] * terms[i];
  return static_cast<float>(1.0 / (1.0 + std::exp(-sum)));
}

PoseStatus reason_against(const QualityTerms& terms, const QualitySettings& settings) {
  constexpr std::array<PoseStatus, 6> kReasons = {PoseStatus::kLowScore,         PoseStatus::kRejectedByDepth,
                                                  PoseStatus::kRejectedByDepth,  PoseStatus::kRejectedByOutline,
                                                  PoseStatus::kRejectedByColour, PoseStatus::kRejectedByColour};
  std::size_t worst = 0;
  const auto against = [&](std::size_t i) { return settings.weights[i] * (settings.typical[i] - terms[i]); };
  for (std::size_t i = 1; i < terms.size(); ++i) {
    if (against(i) > against(worst)) worst = i;
  }
  return kReasons[worst];
}

}  // namespace houghstream
