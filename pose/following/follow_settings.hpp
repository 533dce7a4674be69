#pragma once

namespace houghstream {

/// How an object is found again in the next frame from where it is expected, without a detection. Between two frames it
/// moves by little: few points and steps of registration do.
struct FollowSettings {
  int coarse_iterations = 5;
  int coarse_points = 150;
  double start_distance_m = 0.02;  ///< pairs farther apart have no weight, at first
  int fine_iterations = 8;
  int fine_points = 400;
  double max_jump_m = 0.04;  ///< of the middle, from where it was expected: what ended farther away is something else

  // The print turns a round thing back, which depth alone lets drift.
  double settle_step_deg = 2.0;
  double settle_step_m = 0.002;
  int settle_rounds = 4;
  int settle_points = 250;

  float hidden_share = 0.5F;   ///< of the rendered pixels, behind something: it is hidden rather than gone
  float through_share = 0.3F;  ///< of the others, seen through: it is gone even so
};

}  // namespace houghstream
