#pragma once

#include "detector/forest/score_model.hpp"

namespace houghstream {

/// Returns the terms in the order of kScoreTermList.
inline std::array<float, kScoreTerms> listed(const ScoreTerms& terms) {
  std::array<float, kScoreTerms> values{};
  for (std::size_t i = 0; i < kScoreTerms; ++i) values[i] = terms.*kScoreTermList[i];
  return values;
}

}  // namespace houghstream
