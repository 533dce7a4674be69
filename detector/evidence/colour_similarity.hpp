#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "detector/evidence/cell_comparison.hpp"

namespace houghstream {

/// Mean colours of a view and of the frame over the same cells, CIE L*a*b*.
struct MeanColours {
  std::array<float, 2> template_ab{};
  std::array<float, 2> measured_ab{};
  float measured_lightness = 0.0F;  ///< 0 to 100
  bool is_known = false;            ///< false for fewer than a dozen pairs
};

/// Pairs of colours, channel by channel: those that are expected and those that are observed, 8-bit L*a*b*.
struct ColourPairs {
  using Values = PerCell<std::int16_t>;

  std::size_t count = 0;  ///< number of valid values at the front of each array
  std::array<Values, 3> expected;
  std::array<Values, 3> observed;
};

/// Compares two sets of 8-bit L*a*b* colours, pair by pair. The correlation takes all three channels together, each
/// about its own mean: gain and offset of a channel, which the light decides, do not matter.
class ColourSimilarity {
 public:
  void add(const std::array<std::uint8_t, 3>& expected, const cv::Vec3b& observed) {
    ++count_;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      const int a = expected[c];
      const int b = observed[static_cast<int>(c)];
      Sums& sums = channels_[c];
      sums[0] += a;
      sums[1] += b;
      sums[2] += a * a;
      sums[3] += b * b;
      sums[4] += a * b;
    }
  }

  /// Returns the correlation, -1 to 1; near 0 for plain surfaces, whose differences are noise, and 0 for fewer than a
  /// dozen pairs.
  float correlation() const;

  /// Returns the logarithm of observed over expected contrast, -2 to 2; 0 for fewer than twelve pairs. Dim, hazy and
  /// blurred images show less contrast than the training views.
  float log_contrast_ratio() const;

  MeanColours means() const;

  /// Returns the distance of the mean chroma from the expected one in the a*b* plane, over the standard deviation of
  /// the observed chroma, at most 4; 0 for fewer than twelve pairs. The magnitude of the expected chroma (CIE C*ab) is
  /// free, since haze and cameras change it. This separates uniform surfaces, which correlation cannot.
  float mean_chroma_distance() const;

  /// Returns how much the sum of the scalar products of the chroma vectors lacks to the largest value that vectors of
  /// these lengths can have, over that value; a constant in the divisor keeps pale colours from mattering. It is 0 for
  /// equal hues at any saturation (haze and exposure change that), 1 for hues at right angles, at most 2, and 0 for
  /// fewer than twelve pairs. A purple can thereby differs from a red one with the same texture.
  float hue_mismatch() const;

  /// Returns the logarithm of expected over observed chroma along the template's hues after correction for brightness,
  /// clamped to [-1, 2]. A black carton thereby differs from a dark red one. Returns 0 for achromatic templates and for
  /// fewer than twelve pairs.
  float chroma_deficit() const;

  /// Adds all pairs, several at once: the sums are exact.
  void add(const ColourPairs& pairs);

 private:
  /// Sums of a, b, a * a, b * b and a * b.
  using Sums = std::array<std::int32_t, 5>;  // exact for 33 000 pairs, many times what a view has

  /// Sums over all pairs of the products of chroma vectors, about grey and not about their mean.
  struct ChromaProducts {
    double product = 0.0;
    double expected_sq = 0.0;
    double observed_sq = 0.0;
  };

  double observed_variance(std::size_t channel) const;
  ChromaProducts chroma_products() const;

  int count_ = 0;
  std::array<Sums, 3> channels_{};
};

}  // namespace houghstream
