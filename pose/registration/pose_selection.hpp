#pragma once

#include <cstddef>
#include <vector>

#include "pipeline/base/settings_fields.hpp"
#include "pose/registration/registration.hpp"
#include "pose/seen/depth_score.hpp"

namespace houghstream {

/// Turns about the object's z axis that are tried after registration, degrees.
struct RotationSearchSettings {
  double step_deg = 15.0;              ///< step all the way round
  double fine_step_deg = 3.0;          ///< fine step, up to one coarse step to each side
  double hill_climb_step_m = 0.004;    ///< shifts along the object's axes that are tried with small turns
  int hill_climb_rounds = 4;           ///< number of such shifts to each side
  int points = 250;                    ///< points of a view
  std::size_t registered = 3;          ///< number of the best turns all round that are registered again
  std::size_t alternatives = 1;        ///< number of flips that are selected beside the best one
  float min_alternative_ratio = 0.8F;  ///< smallest score of such a flip over that of the best one
};

template <typename Visit>
void fields(const RotationSearchSettings& /*settings*/, const Visit& visit) {
  using S = RotationSearchSettings;
  visit(number("step_deg", &S::step_deg, 0.1, 360, "degrees"));
  visit(number("fine_step_deg", &S::fine_step_deg, 0.1, 180, "degrees"));
  visit(number("hill_climb_step_m", &S::hill_climb_step_m, 0, 1, "m"));
  visit(number("hill_climb_rounds", &S::hill_climb_rounds, 0, 1000));
  visit(number("points", &S::points, 1, 100000));
  visit(number("registered", &S::registered, 0, 1000));
  visit(number("alternatives", &S::alternatives, 0, 1000));
  visit(number("min_alternative_ratio", &S::min_alternative_ratio, 0, 1));
}

/// The settings that the choice reads; each stands beside its stage.
struct PoseSelectionSettings {
  InitialSettings initial;
  RegistrationSettings registration;
  RotationSearchSettings rotation_search;
  double tolerance_m = kDepthTolerance_m;  ///< VerificationSettings::tolerance_m
};

/// Selects the best registered candidate by the joint score of depth, colour and votes, and registers it finely. The
/// result has no inliers where none ended near the detected centre. `votes` are the modes of the detection's rotations.
RegistrationResult best_registered(const ObjectObservation& observation,
                                   const std::vector<RegistrationResult>& registered,
                                   const std::vector<RotationCandidate>& votes, const PoseSelectionSettings& settings);

/// Returns the probability that verification will publish a pose of a detection with this score, by the joint score of
/// depth and colour of its best registered candidate. Logistic regression on 735 detections from a score of 0.1 on, 251
/// of them published, of 21 objects in 88 images of furnished rooms.
double publication_probability(const ObjectObservation& observation, const RegistrationResult& best,
                               float detection_score, const PoseSelectionSettings& settings);

/// Selects poses among the rotations of the best registered candidate by the joint score of depth, colour and votes: it
/// is flipped about each of its principal axes, and rotated about its z axis, where votes err most. Each of these
/// rotations is registered again and improved by hill climbing, and the best is kept; then its texture may rotate it a
/// little, and a last registration follows. Behind it come flips that score nearly as well, registered finely, since
/// verification separates them better than the points of a view. `best` has inliers.
std::vector<RegistrationResult> select_poses(const ObjectObservation& observation, const RegistrationResult& best,
                                             const std::vector<RotationCandidate>& votes,
                                             const PoseSelectionSettings& settings);

/// Turns a finely registered pose a little about its z axis to where depth, colour and votes agree most, and registers
/// it again, as select_poses() ends.
RegistrationResult refine_rotation(const ObjectObservation& observation, const RegistrationResult& registered,
                                   const std::vector<RotationCandidate>& votes, const PoseSelectionSettings& settings);

/// Registers a pose that was found otherwise finely, and refines its rotation.
RegistrationResult refine_pose(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                               const std::vector<RotationCandidate>& votes, const PoseSelectionSettings& settings);

// The names of before, for one release.
using TurnSettings [[deprecated("is RotationSearchSettings now")]] = RotationSearchSettings;
using ChoiceSettings [[deprecated("is PoseSelectionSettings now")]] = PoseSelectionSettings;

}  // namespace houghstream
