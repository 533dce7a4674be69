#include "detector/evidence/colour_similarity.hpp"

#include <algorithm>
#include <cmath>

namespace houghstream {
namespace {

constexpr int kMinPairs = 12;             // pairs from which a comparison means something
constexpr double kNeutral = 128.0;        // a* and b* of grey
constexpr double kPaleChroma_sq = 120.0;  // squared C*ab below which a hue is unreliable

}  // namespace

void ColourSimilarity::add(const ColourPairs& pairs) {
  count_ += static_cast<int>(pairs.count);
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const ColourPairs::Values& expected = pairs.expected[c];
    const ColourPairs::Values& observed = pairs.observed[c];
    Sums sums{};
    for (std::size_t i = 0; i < pairs.count; ++i) {
      const std::int32_t a = expected[i];
      const std::int32_t b = observed[i];
      sums[0] += a;
      sums[1] += b;
      sums[2] += a * a;
      sums[3] += b * b;
      sums[4] += a * b;
    }
    for (std::size_t k = 0; k < sums.size(); ++k) channels_[c][k] += sums[k];
  }
}

double ColourSimilarity::observed_variance(std::size_t channel) const {
  const double count = count_;
  const double mean = channels_[channel][1] / count;
  return channels_[channel][3] / count - mean * mean;
}

MeanColours ColourSimilarity::means() const {
  constexpr double kLightness = 100.0 / 255.0;
  if (count_ < kMinPairs) return {};
  const double count = count_;
  const auto chroma = [&](std::size_t channel, std::size_t which) {
    return static_cast<float>(channels_[channel][which] / count - kNeutral);
  };
  return {{chroma(1, 0), chroma(2, 0)},
          {chroma(1, 1), chroma(2, 1)},
          static_cast<float>(kLightness * channels_[0][1] / count),
          true};
}

float ColourSimilarity::mean_chroma_distance() const {
  constexpr double kUniformVariance = 100.0;  // variance of a and b that plain surfaces have in changing light
  constexpr double kMinRatio = 0.5;           // limits of the chroma (C*ab) over the expected one
  constexpr double kMaxRatio = 2.5;
  if (count_ < kMinPairs) return 0.0F;
  const double count = count_;
  const auto mean = [&](std::size_t channel, std::size_t which) {
    return channels_[channel][which] / count - kNeutral;
  };
  const double expected_sq = mean(1, 0) * mean(1, 0) + mean(2, 0) * mean(2, 0);
  const double product = mean(1, 0) * mean(1, 1) + mean(2, 0) * mean(2, 1);
  const double chroma_ratio = std::clamp(product / std::max(expected_sq, 1.0), kMinRatio, kMaxRatio);
  const double a = mean(1, 1) - chroma_ratio * mean(1, 0);
  const double b = mean(2, 1) - chroma_ratio * mean(2, 0);
  return static_cast<float>(
      std::min(4.0, std::sqrt((a * a + b * b) / (kUniformVariance + observed_variance(1) + observed_variance(2)))));
}

ColourSimilarity::ChromaProducts ColourSimilarity::chroma_products() const {
  ChromaProducts out;
  const double count = count_;
  for (const std::size_t c : {std::size_t{1}, std::size_t{2}}) {
    const Sums& sums = channels_[c];
    const double offset = count * kNeutral * kNeutral;
    out.product += sums[4] - kNeutral * (static_cast<double>(sums[0]) + sums[1]) + offset;
    out.expected_sq += sums[2] - 2.0 * kNeutral * sums[0] + offset;
    out.observed_sq += sums[3] - 2.0 * kNeutral * sums[1] + offset;
  }
  return out;
}

float ColourSimilarity::hue_mismatch() const {
  if (count_ < kMinPairs) return 0.0F;
  const ChromaProducts sum = chroma_products();
  const double deficit = std::sqrt(sum.expected_sq * sum.observed_sq) - sum.product;
  const double pale_sum = kPaleChroma_sq * count_;
  return static_cast<float>(std::max(deficit, 0.0) /
                            std::sqrt((sum.expected_sq + pale_sum) * (sum.observed_sq + pale_sum)));
}

float ColourSimilarity::chroma_deficit() const {
  constexpr double kMinBrightness = 0.1;  // brightness over the expected one
  constexpr double kMaxBrightness = 4.0;
  if (count_ < kMinPairs) return 0.0F;
  const ChromaProducts sum = chroma_products();
  const double expected = std::max(static_cast<double>(channels_[0][0]), 1.0);
  const double brightness = std::clamp(channels_[0][1] / expected, kMinBrightness, kMaxBrightness);
  const double pale_sum = kPaleChroma_sq * count_;
  const double expected_chroma = brightness * sum.expected_sq + pale_sum;
  return static_cast<float>(std::clamp(std::log(expected_chroma / (std::max(sum.product, 0.0) + pale_sum)), -1.0, 2.0));
}

float ColourSimilarity::log_contrast_ratio() const {
  constexpr double kNoiseVariance = 9.0;  // variance that a plain surface's pixels have
  constexpr double kMax = 2.0;
  if (count_ < kMinPairs) return 0.0F;
  const double count = count_;
  double expected = 3.0 * kNoiseVariance;
  double observed = 3.0 * kNoiseVariance;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const double mean = channels_[c][0] / count;
    expected += channels_[c][2] / count - mean * mean;
    observed += observed_variance(c);
  }
  return static_cast<float>(std::clamp(0.5 * std::log(observed / expected), -kMax, kMax));
}

float ColourSimilarity::correlation() const {
  constexpr double kNoiseVariance = 9.0;  // variance that a plain surface's pixels have
  if (count_ < kMinPairs) return 0.0F;
  const double count = count_;
  double covariance = 0.0;
  double expected = 3.0 * kNoiseVariance;
  double observed = 3.0 * kNoiseVariance;
  for (const Sums& sums : channels_) {
    const double mean_a = sums[0] / count;
    const double mean_b = sums[1] / count;
    covariance += sums[4] / count - mean_a * mean_b;
    expected += sums[2] / count - mean_a * mean_a;
    observed += sums[3] / count - mean_b * mean_b;
  }
  return static_cast<float>(covariance / std::sqrt(expected * observed));
}

}  // namespace houghstream
