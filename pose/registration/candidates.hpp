#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/base/settings_fields.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/object_pose.hpp"
#include "pose/seen/region.hpp"

namespace houghstream {

/// Modes of the votes' rotations.
struct InitialSettings {
  double cluster_radius_deg = 25.0;
  int clusters = 6;          ///< maximum number of modes
  int rotated_clusters = 1;  ///< number of the heaviest that are also turned by quarters about the object's z axis
  float vote_gain = 0.1F;    ///< preference after registration for a rotation that the votes agree on
};

template <typename Visit>
void fields(const InitialSettings& /*settings*/, const Visit& visit) {
  using S = InitialSettings;
  visit(number("cluster_radius_deg", &S::cluster_radius_deg, 0.1, 180, "degrees"));
  visit(number("clusters", &S::clusters, 1, 1000));
  visit(number("rotated_clusters", &S::rotated_clusters, 0, 1000));
  visit(number("vote_gain", &S::vote_gain, 0, 100));
}

/// Coarse choice by depth score: each rotation at several places, the best go to registration.
struct SearchSettings {
  double reach_m = 0.06;               ///< reach along the line of sight, to each side of the detected centre
  double step_m = 0.012;               ///< step between places across the line of sight
  int steps = 1;                       ///< number of steps to each side
  int points = 80;                     ///< points of a view
  int keep = 3;                        ///< maximum number of the votes' candidates that are registered
  double tolerance_m = 0.02;           ///< measured and model depth agree; 3 sigma is added
  double max_flat_thickness_m = 0.04;  ///< thinner objects are also laid on the plane under them (flat_candidates)
  int flat_keep = 4;                   ///< candidates so found that are registered
};

template <typename Visit>
void fields(const SearchSettings& /*settings*/, const Visit& visit) {
  using S = SearchSettings;
  visit(number("reach_m", &S::reach_m, 0, 10, "m"));
  visit(number("step_m", &S::step_m, 0, 10, "m"));
  visit(number("steps", &S::steps, 0, 100));
  visit(number("points", &S::points, 1, 100000));
  visit(number("keep", &S::keep, 1, 1000));
  visit(number("tolerance_m", &S::tolerance_m, 0, 1, "m"));
  visit(number("max_flat_thickness_m", &S::max_flat_thickness_m, 0, 1, "m"));
  visit(number("flat_keep", &S::flat_keep, 0, 1000));
}

/// Poses of an earlier frame as further candidates, and what was decided of them.
struct WarmStartSettings {
  double max_age_s = 0.5;  ///< time between the frames
  double reach_m = 0.1;    ///< distance from the detected centre; objects farther away are others
  /// Where the best registered candidate continues a pose of at least this quality, its alternatives (half turns, turns
  /// about an axis) are not searched and its texture is not compared anew: that takes most of a pose's time.
  float sure_quality = 0.9F;
  double max_turn_deg = 10.0;  ///< rotation from one frame to the next of a pose that is continued
  /// Number of consecutive frames for which a pose is continued so, and up to 3 more by class, so that not all objects
  /// are searched again in one frame. 0: each pose is searched anew.
  int max_continued = 8;
  /// A weak detection (Detection::reported is false) that was rejected with a quality of at most sure_rejection_quality
  /// is rejected again, without a search, for this time, and up to three quarters longer by class, where its class is
  /// detected weakly again. 0: each is searched. Chosen: of 1050 weak detections that were rejected in a stream of four
  /// objects the 1024 with such a quality would have been published once in the twelve frames after it (0.4 s), the 26
  /// others five times.
  double max_rejected_s = 0.3;
  float sure_rejection_quality = 0.1F;
  double rejected_reach_m = 0.05;  ///< maximum distance between both detected centres
};

template <typename Visit>
void fields(const WarmStartSettings& /*settings*/, const Visit& visit) {
  using S = WarmStartSettings;
  visit(number("max_age_s", &S::max_age_s, 0, 3600, "s"));
  visit(number("reach_m", &S::reach_m, 0, 10, "m"));
  visit(number("sure_quality", &S::sure_quality, 0, 1));
  visit(number("max_turn_deg", &S::max_turn_deg, 0, 180, "degrees"));
  visit(number("max_continued", &S::max_continued, 0, 1000000));
  visit(number("max_rejected_s", &S::max_rejected_s, 0, 3600, "s"));
  visit(number("sure_rejection_quality", &S::sure_rejection_quality, 0, 1));
  visit(number("rejected_reach_m", &S::rejected_reach_m, 0, 10, "m"));
}

/// A rotation on which votes agree.
struct RotationCandidate {
  Eigen::Quaternionf R_camera_object = Eigen::Quaternionf::Identity();
  float weight = 0.0F;  ///< weight of its votes, 0 for one that was added without votes
};

/// Returns the modes of the votes' rotations, heaviest first: the vote with most weight about it gathers its
/// neighbours, whose mean (Markley et al. 2007) is a candidate; again with the rest. Then the heaviest turned by
/// quarters about the object's z axis, because views of a standing object are most easily confused that way. Empty
/// where the votes hold no finite rotation with weight.
std::vector<RotationCandidate> rotation_clusters(const std::vector<RotationVote>& votes,
                                                 const InitialSettings& settings);

/// Returns the support of a pose's rotation by the votes: the sum of the modes' weights, each times a Gaussian of its
/// angle to the rotation (sigma: the clusters' radius), relative to the heaviest mode, at most 1.
float vote_support(const std::vector<RotationCandidate>& modes, const Eigen::Isometry3d& T_camera_object,
                   const InitialSettings& settings);

/// A place to start registration from.
struct PoseCandidate {
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  /// DepthScore::value; of flat candidates their evidence; 0 for poses of an earlier frame, which are not chosen by it.
  float score = 0.0F;
};

/// Tries each rotation at places about the detected centre, moved along the line of sight onto the measured surface;
/// gives the best place of each rotation, best first, at most SearchSettings::keep.
std::vector<PoseCandidate> place_candidates(const ObjectObservation& observation,
                                            const std::vector<RotationCandidate>& rotations,
                                            const SearchSettings& settings);

/// Returns an earlier frame's poses of the class near the detected centre as candidates; none of a frame that is later
/// than this one or too long before it.
std::vector<PoseCandidate> earlier_candidates(const ObjectObservation& observation, const std::string& class_name,
                                              const ObjectPoses& earlier, const WarmStartSettings& settings);

/// Returns the pose of an earlier frame that a registered candidate of this one continues, or null: a sure one of the
/// class that lies near the detected centre, rotated alike, and was not continued for too long; of several the nearest
/// to the candidate.
const ObjectPose* find_continued(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                                 const std::string& class_name, const ObjectPoses& earlier,
                                 const WarmStartSettings& settings);

/// Returns the rejected weak detection of an earlier frame that a weak one of this frame, taken at `utime`, repeats:
/// one of its class, surely rejected, searched near the same place and not too long ago. Null where there is none, and
/// for a reported detection.
const ObjectPose* find_rejected(const Detection& detection, std::int64_t utime, const ObjectPoses& earlier,
                                const WarmStartSettings& settings);

}  // namespace houghstream
