#include "detector/evidence/likeness.hpp"

#include <algorithm>
#include <cmath>

namespace houghstream {
namespace {

constexpr int kFewest = 12;         // pairs from which a comparison means something
constexpr double kNeutral = 128.0;  // a* and b* of grey

}  // namespace

double Likeness::seen_variance(std::size_t channel) const {
  const double count = count_;
  const double mean = channels_[channel][1] / count;
  return channels_[channel][3] / count - mean * mean;
}

float Likeness::foreign_colour() const {
  constexpr double kPlain = 100.0;  // variance of a and b that plain surfaces have in changing light
  constexpr double kPalest = 0.5;   // strengths over the remembered one
  constexpr double kStrongest = 2.5;
  if (count_ < kFewest) return 0.0F;
  const double count = count_;
  const auto mean = [&](std::size_t channel, std::size_t which) {
    return channels_[channel][which] / count - kNeutral;
  };
  const double remembered_sq = mean(1, 0) * mean(1, 0) + mean(2, 0) * mean(2, 0);
  const double product = mean(1, 0) * mean(1, 1) + mean(2, 0) * mean(2, 1);
  const double strength = std::clamp(product / std::max(remembered_sq, 1.0), kPalest, kStrongest);
  const double a = mean(1, 1) - strength * mean(1, 0);
  const double b = mean(2, 1) - strength * mean(2, 0);
  return static_cast<float>(std::min(4.0, std::sqrt((a * a + b * b) / (kPlain + seen_variance(1) + seen_variance(2)))));
}

float Likeness::hue_conflict() const {
  constexpr double kPale = 120.0;  // squared strength in the a*b* plane about which a hue begins to mean something
  if (count_ < kFewest) return 0.0F;
  const double count = count_;
  double product = 0.0;
  double remembered_sq = 0.0;
  double seen_sq = 0.0;
  for (const std::size_t c : {std::size_t{1}, std::size_t{2}}) {  // about grey, not about the mean
    const Sums& sums = channels_[c];
    const double offset = count * kNeutral * kNeutral;
    product += sums[4] - kNeutral * (static_cast<double>(sums[0]) + sums[1]) + offset;
    remembered_sq += sums[2] - 2.0 * kNeutral * sums[0] + offset;
    seen_sq += sums[3] - 2.0 * kNeutral * sums[1] + offset;
  }
  const double lacking = std::sqrt(remembered_sq * seen_sq) - product;
  const double pale = kPale * count;
  return static_cast<float>(std::max(lacking, 0.0) / std::sqrt((remembered_sq + pale) * (seen_sq + pale)));
}

float Likeness::contrast() const {
  constexpr double kNoise = 9.0;  // variance that a plain surface's pixels have
  constexpr double kMost = 2.0;
  if (count_ < kFewest) return 0.0F;
  const double count = count_;
  double remembered = 3.0 * kNoise;
  double seen = 3.0 * kNoise;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const double mean = channels_[c][0] / count;
    remembered += channels_[c][2] / count - mean * mean;
    seen += seen_variance(c);
  }
  return static_cast<float>(std::clamp(0.5 * std::log(seen / remembered), -kMost, kMost));
}

float Likeness::correlation() const {
  constexpr double kNoise = 9.0;  // variance that a plain surface's pixels have
  if (count_ < kFewest) return 0.0F;
  const double count = count_;
  double covariance = 0.0;
  double remembered = 3.0 * kNoise;
  double seen = 3.0 * kNoise;
  for (const Sums& sums : channels_) {
    const double mean_a = sums[0] / count;
    const double mean_b = sums[1] / count;
    covariance += sums[4] / count - mean_a * mean_b;
    remembered += sums[2] / count - mean_a * mean_a;
    seen += sums[3] / count - mean_b * mean_b;
  }
  return static_cast<float>(covariance / std::sqrt(remembered * seen));
}

}  // namespace houghstream
