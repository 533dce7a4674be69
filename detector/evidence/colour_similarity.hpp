#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

namespace houghstream {

/// Mean colours of a view and of the frame over the same cells, CIE L*a*b*.
struct MeanColours {
  std::array<float, 2> remembered_ab{};
  std::array<float, 2> measured_ab{};
  float measured_lightness = 0.0F;  ///< 0 to 100
  bool is_known = false;            ///< false for fewer than a dozen pairs
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

  /// -1 to 1; near 0 for plain surfaces, whose differences are noise, and 0 for fewer than a dozen pairs.
  float correlation() const;

  /// Logarithm of the contrast of the colours seen over that of the remembered ones, -2 to 2; 0 for fewer than a dozen
  /// pairs. Dim, hazy and blurred pictures show less than was taught.
  float log_contrast_ratio() const;

  MeanColours means() const;

  /// How far the mean colour seen is from the remembered one, at any strength that haze or a camera gives it: distance
  /// in the a*b* plane over the spread of the colours seen, at most 4; 0 for fewer than a dozen pairs. Tells plain
  /// surfaces apart, which correlation cannot.
  float mean_chroma_distance() const;

  /// How far the hues differ, pair by pair, where both colours are strong: what the scalar product of the colours in
  /// the a*b* plane lacks to the largest that colours of their strengths can have, over that largest, which pale
  /// colours keep from reaching it. 0 for the same hues at any strength, as haze and exposure change it, 1 for hues at
  /// right angles, at most 2; 0 for fewer than a dozen pairs. A purple can is no red one, however alike their print.
  float hue_mismatch() const;

  /// How much weaker the colours seen are than the remembered ones, beyond what their brightness explains: logarithm of
  /// the expected strength in the a*b* plane over the one seen in the remembered hues, -1 to 2; 0 where no colour is
  /// remembered, and for fewer than a dozen pairs. A black carton is no dark red one.
  float chroma_deficit() const;

 private:
  /// Sums of a, b, a * a, b * b and a * b.
  using Sums = std::array<std::int32_t, 5>;  // exact for 33 000 pairs, many times what a view has

  /// Of the colours in the a*b* plane, about grey and not about their mean: sums over all pairs.
  struct Strengths {
    double product = 0.0;
    double expected_sq = 0.0;
    double observed_sq = 0.0;
  };

  double observed_variance(std::size_t channel) const;
  Strengths strengths() const;

  int count_ = 0;
  std::array<Sums, 3> channels_{};
};

}  // namespace houghstream
