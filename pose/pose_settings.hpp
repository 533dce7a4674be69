#pragma once

#include <array>
#include <cstddef>

namespace houghstream {

inline constexpr double kRadPerDeg = 0.017453292519943295;

/// Which code registers a candidate to the measured depth.
enum class Registration {
  kProjective,  ///< ours: visible model points against the organised depth image
  kPcl,         ///< pcl::IterativeClosestPoint with point-to-plane estimation, the reference
};

/// What is kept of a model: for view directions spread over the sphere, points that are visible from there.
struct ModelSettings {
  int views_per_edge = 4;        ///< each edge of an icosahedron in so many parts: 10 n^2 + 2 directions
  int points_per_view = 600;     ///< at most
  double view_distance_m = 1.2;  ///< from the model's centre
  int pixels_per_diameter = 72;  ///< of the pictures from which visible points are drawn
  double least_facing = 0.15;    ///< cosine between normal and line of sight below which a point is too grazing
};

/// Standard deviation of measured depth, base + per_m * z^2: a structured-light camera's disparity error
/// (Khoshelham & Elberink 2012, 1.4 mm at 1 m) over what registration of depth to colour adds.
struct DepthNoise {
  double base_m = 0.001;
  double per_m = 0.00143;  ///< 1/m
  double sigma(double z) const { return base_m + per_m * z * z; }
};

/// Measured and model depth agree when they differ by no more than this.
struct DepthTolerance {
  double base_m = 0.0;
  DepthNoise noise;
  double at(double z) const { return base_m + 3.0 * noise.sigma(z); }
};

/// The detection's part of the depth image.
struct RegionSettings {
  double enlarge = 0.15;        ///< of the box's size, on each side
  double gate_margin_m = 0.06;  ///< depth farther from the centre than the model's radius plus this is not the object
  int min_points = 60;          ///< pixels with depth inside the gate
};

/// Candidates from the votes.
struct InitialSettings {
  double cluster_radius_deg = 25.0;
  int clusters = 6;         ///< at most
  int turned_clusters = 1;  ///< of the heaviest also turned by quarters about the object's z axis
  float vote_gain = 0.3F;   ///< how much a rotation that the votes agree on is preferred after registration
};

/// Poses of an earlier frame as further candidates.
struct WarmStartSettings {
  double max_age_s = 0.5;  ///< between the frames
  double reach_m = 0.1;    ///< from the detected centre; objects farther away are others
};

/// Coarse choice by depth score: each rotation at several places, the best go to registration.
struct SearchSettings {
  double reach_m = 0.06;      ///< along the line of sight, to each side of the detected centre
  double step_m = 0.012;      ///< between places across the line of sight
  int steps = 1;              ///< to each side
  int points = 80;            ///< of a view
  int keep = 3;               ///< candidates that are registered
  double tolerance_m = 0.02;  ///< measured and model depth agree; 3 sigma is added
};

/// Point-to-plane registration with Tukey's weights (Rusinkiewicz & Levoy 2001).
struct RegistrationSettings {
  Registration method = Registration::kProjective;
  int coarse_iterations = 8;
  int coarse_points = 120;
  int fine_iterations = 10;
  int fine_points = 600;
  double start_distance_m = 0.035;  ///< pairs farther apart have no weight; shrinks with every iteration
  double end_distance_m = 0.008;    ///< 3 sigma is added
  double point_weight = 0.1;        ///< of the distance along the surface beside that across it
  double max_shift_m = 0.07;        ///< from the detected centre; what ended farther away is something else
  double converged_m = 0.0005;      ///< last step moved the model's surface by less
};

/// Turns about the object's z axis that are tried after registration, degrees.
struct TurnSettings {
  double step_deg = 15.0;       ///< all the way round
  double fine_step_deg = 3.0;   ///< up to one step to each side
  double climb_step_m = 0.004;  ///< shifts along the object's axes that are tried with small turns
  int climb_rounds = 4;         ///< of those, to each side
  int points = 250;             ///< of a view
  std::size_t registered = 3;   ///< the best turns all round are registered again
};

/// Comparison of the rendered model with the measured depth.
struct VerificationSettings {
  double tolerance_m = 0.008;  ///< measured and model depth agree; 3 sigma is added
};

/// The probability that a pose is right, by logistic regression on the evidence (pose/verification/quality.hpp). Fitted
/// to 1482 poses of detections from score 0.1 on in the scenes development_world_0 to 17, of which 773 were right.
/// `least` is the round number from which 98 % of the poses are right in scenes that the fit has not seen (a quarter in
/// turn).
struct QualitySettings {
  double bias = -3.71;
  std::array<double, 6> weights = {1.53, 1.82, 1.33, 1.15, 1.86, 6.16};
  /// Means of right poses: what is farthest below them is the reason for "no pose".
  std::array<double, 6> typical = {1.63, 3.55, -0.16, 1.48, -0.70, -0.02};
  float least = 0.6F;  ///< poses of lower quality are not published
};

struct PoseSettings {
  ModelSettings model;
  DepthNoise noise;
  RegionSettings region;
  InitialSettings initial;
  WarmStartSettings warm_start;
  SearchSettings search;
  RegistrationSettings registration;
  TurnSettings turn;
  VerificationSettings verification;
  QualitySettings quality;
  float min_score = 0.1F;  ///< of a detection whose pose is looked for
  int threads = 1;
};

}  // namespace houghstream
