#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace houghstream {

/// Colour histograms of an object and of what lies beside it, learnt from frame to frame (Prisacariu and Reid 2012,
/// "PWP3D"; histograms of 16 values a channel as Stoiber et al. 2022 have them).
class ColourStatistics {
 public:
  ColourStatistics();

  /// Returns the probability, in (0, 1), that a pixel of this colour (BGR) is on the object, where both sides are
  /// equally likely a priori; 0.5 for a colour that was never observed.
  float foreground(const cv::Vec3b& bgr) const { return ratio_[bin_of(bgr)]; }

  /// Returns whether no pixels have been learnt yet.
  bool empty() const { return empty_; }

  /// Takes a frame's pixels on the object and beside it: each histogram moves by `rate` towards theirs, the first one
  /// all the way. A side without pixels keeps its histogram.
  void learn(const std::vector<cv::Vec3b>& on, const std::vector<cv::Vec3b>& beside, double rate);

 private:
  static constexpr int kBits = 4;  // bits of a channel that choose its bin
  static std::size_t bin_of(const cv::Vec3b& bgr) {
    constexpr int kDrop = 8 - kBits;
    return (static_cast<std::size_t>(bgr[0] >> kDrop) << (2 * kBits)) |
           (static_cast<std::size_t>(bgr[1] >> kDrop) << kBits) | static_cast<std::size_t>(bgr[2] >> kDrop);
  }

  bool empty_ = true;
  std::vector<float> on_;  // fractions of the pixels, by bin
  std::vector<float> beside_;
  std::vector<float> ratio_;
};

}  // namespace houghstream
