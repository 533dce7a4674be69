#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

namespace houghstream {

/// Correlation of two sets of colours, pair by pair: all three channels together, each about its own mean. So gain and
/// offset of a channel, which the light decides, do not matter.
class Likeness {
 public:
  void add(const std::array<std::uint8_t, 3>& remembered, const cv::Vec3b& seen);

  /// -1 to 1; near 0 for plain surfaces, whose differences are noise, and 0 for fewer than a dozen pairs.
  float correlation() const;

 private:
  /// Sums of a, b, a * a, b * b and a * b.
  using Sums = std::array<double, 5>;

  int count_ = 0;
  std::array<Sums, 3> channels_{};
};

}  // namespace houghstream
