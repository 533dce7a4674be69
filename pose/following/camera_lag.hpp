#pragma once

#include "pose/following/joint_registration.hpp"

namespace houghstream {

/// Estimates by how much later than its colours a camera takes its depth, from what objects that move before it show of
/// both. A camera keeps its lag, but not forever: old evidence is forgotten as new evidence comes. Not thread-safe.
class CameraLag {
 public:
  /// `prior_s`: standard deviation of cameras' lags, which are 0 in the mean, seconds.
  explicit CameraLag(double prior_s) : prior_s_(prior_s) {}

  /// Adds the evidence of one registration, a deviation of which was so many seconds.
  void update(const LagEvidence& evidence, double deviation_s);

  /// Returns the lag, seconds: positive where depth is the later one, 0 where nothing has moved yet.
  double seconds() const { return weighted_ / information(); }
  /// Returns its standard deviation, seconds.
  double sigma_s() const;
  /// Returns whether the lag may be published: its standard deviation is at most a fifth of the prior's.
  bool is_known() const;

 private:
  double information() const { return 1.0 / (prior_s_ * prior_s_) + observed_information_; }

  double prior_s_;
  double observed_information_ = 0.0;  // information, 1/s^2
  double weighted_ = 0.0;              // information times lag, 1/s
};

}  // namespace houghstream
