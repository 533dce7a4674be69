#include "pose/registration/candidates.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/types/frame_id.hpp"
#include "pose/model/angles.hpp"
#include "pose/seen/depth_score.hpp"

namespace houghstream {
namespace {

constexpr int kSpread = 4;  // groups of classes that are searched again in different frames

std::vector<RotationVote> select_usable_votes(const std::vector<RotationVote>& votes) {
  std::vector<RotationVote> out;
  for (const RotationVote& vote : votes) {
    const float norm = vote.R_camera_object.norm();
    const bool usable = std::isfinite(norm) && norm > 0.5F && std::isfinite(vote.weight) && vote.weight > 0.0F;
    if (usable) out.push_back({vote.R_camera_object.normalized(), vote.weight});
  }
  return out;
}

/// Returns the cosine of half the angle between two rotations.
float half_angle_cosine(const RotationVote& a, const RotationVote& b) {
  return std::abs(a.R_camera_object.dot(b.R_camera_object));
}

/// Returns the eigenvector of the largest eigenvalue of the weighted sum of q q^T (Markley et al. 2007, eq. 12).
RotationCandidate mean_rotation(const std::vector<RotationVote>& votes) {
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  RotationCandidate mean;
  for (const RotationVote& vote : votes) {
    const Eigen::Vector4d q = vote.R_camera_object.coeffs().cast<double>();
    sum += static_cast<double>(vote.weight) * q * q.transpose();
    mean.weight += vote.weight;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(sum);
  mean.R_camera_object.coeffs() = solver.eigenvectors().col(3).cast<float>();
  mean.R_camera_object.normalize();
  return mean;
}

/// Returns the vote with most weight within the radius; ties go to the first.
std::size_t find_densest_vote(const std::vector<RotationVote>& votes, float min_cosine) {
  std::size_t best = 0;
  float best_weight = -1.0F;
  for (std::size_t i = 0; i < votes.size(); ++i) {
    float weight = 0.0F;
    for (const RotationVote& other : votes)
      weight += half_angle_cosine(votes[i], other) >= min_cosine ? other.weight : 0.0F;
    if (weight > best_weight) {
      best_weight = weight;
      best = i;
    }
  }
  return best;
}

void add_rotated(std::vector<RotationCandidate>& candidates, int rotated_clusters) {
  const std::size_t heaviest = std::min<std::size_t>(candidates.size(), std::max(0, rotated_clusters));
  for (std::size_t i = 0; i < heaviest; ++i) {
    const Eigen::Quaternionf R_camera_object = candidates[i].R_camera_object;
    for (const double degrees : {90.0, 180.0, 270.0}) {
      const Eigen::AngleAxisf rotation_step(static_cast<float>(degrees * kRadPerDeg), Eigen::Vector3f::UnitZ());
      candidates.push_back({R_camera_object * Eigen::Quaternionf(rotation_step), 0.0F});
    }
  }
}

PoseCandidate find_best_position(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                                 const SearchSettings& settings) {
  const ShiftSearch along{settings.points, settings.reach_m, {settings.tolerance_m, observation.noise}};
  PoseCandidate best;
  for (int j = -settings.steps; j <= settings.steps; ++j) {
    for (int i = -settings.steps; i <= settings.steps; ++i) {
      Eigen::Isometry3d T = Eigen::Translation3d(i * settings.step_m, j * settings.step_m, 0.0) * T_camera_object;
      const DepthShift found = best_depth_shift(observation.frame, observation.model, T, along);
      // Along the ray of where it was detected: its origin may lie anywhere.
      T.pretranslate(found.shift_m / observation.centre_camera.z() * observation.centre_camera.cast<double>());
      const bool first = i == -settings.steps && j == -settings.steps;
      if (first || found.score.value > best.score) best = {T, found.score.value};
    }
  }
  return best;
}

/// Returns the published poses of the class in an earlier frame that lie near the detected centre.
std::vector<const ObjectPose*> earlier_poses(const ObjectObservation& observation, const std::string& class_name,
                                             const ObjectPoses& earlier, const WarmStartSettings& settings) {
  std::vector<const ObjectPose*> poses;
  const double age_s = seconds_between(earlier.frame.utime, observation.frame.id.utime);
  if (!(age_s > 0.0 && age_s <= settings.max_age_s)) return poses;
  for (const ObjectPose& pose : earlier.poses) {
    if (!pose.T_camera_object || pose.class_name != class_name) continue;
    if (distance_from_detected(observation, *pose.T_camera_object) <= settings.reach_m) poses.push_back(&pose);
  }
  return poses;
}

}  // namespace

std::vector<RotationCandidate> rotation_clusters(const std::vector<RotationVote>& votes,
                                                 const InitialSettings& settings) {
  std::vector<RotationVote> remaining = select_usable_votes(votes);
  constexpr double kSelf = 0.9999;  // a vote is always in its own cluster
  const double limit = std::cos(0.5 * settings.cluster_radius_deg * kRadPerDeg);
  const auto min_cosine = static_cast<float>(std::min(limit, kSelf));
  std::vector<RotationCandidate> candidates;
  while (!remaining.empty() && static_cast<int>(candidates.size()) < settings.clusters) {
    const RotationVote centre = remaining[find_densest_vote(remaining, min_cosine)];
    const auto far = [&](const RotationVote& vote) { return half_angle_cosine(vote, centre) < min_cosine; };
    const auto near_begin = std::stable_partition(remaining.begin(), remaining.end(), far);
    candidates.push_back(mean_rotation({near_begin, remaining.end()}));
    remaining.erase(near_begin, remaining.end());
  }
  add_rotated(candidates, settings.rotated_clusters);
  return candidates;
}

float vote_support(const std::vector<RotationCandidate>& modes, const Eigen::Isometry3d& T_camera_object,
                   const InitialSettings& settings) {
  const double width_rad = settings.cluster_radius_deg * kRadPerDeg;
  const Eigen::Quaternionf R_camera_object(Eigen::Quaterniond(T_camera_object.linear()).cast<float>());
  float sum = 0.0F;
  float maximum = 0.0F;
  for (const RotationCandidate& mode : modes) {
    const double ratio = static_cast<double>(R_camera_object.angularDistance(mode.R_camera_object)) / width_rad;
    sum += mode.weight * static_cast<float>(std::exp(-0.5 * ratio * ratio));
    maximum = std::max(maximum, mode.weight);
  }
  return maximum > 0.0F ? std::min(1.0F, sum / maximum) : 0.0F;
}

std::vector<PoseCandidate> place_candidates(const ObjectObservation& observation,
                                            const std::vector<RotationCandidate>& rotations,
                                            const SearchSettings& settings) {
  std::vector<PoseCandidate> candidates;
  for (const RotationCandidate& rotation : rotations) {
    Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
    T_camera_object.linear() = rotation.R_camera_object.cast<double>().normalized().toRotationMatrix();
    T_camera_object.translation() =
        (observation.centre_camera - rotation.R_camera_object.normalized() * observation.model.vote_centre)
            .cast<double>();
    candidates.push_back(find_best_position(observation, T_camera_object, settings));
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const PoseCandidate& a, const PoseCandidate& b) { return a.score > b.score; });
  candidates.resize(std::min<std::size_t>(candidates.size(), std::max(1, settings.keep)));
  return candidates;
}

std::vector<PoseCandidate> earlier_candidates(const ObjectObservation& observation, const std::string& class_name,
                                              const ObjectPoses& earlier, const WarmStartSettings& settings) {
  std::vector<PoseCandidate> candidates;
  for (const ObjectPose* pose : earlier_poses(observation, class_name, earlier, settings))
    candidates.push_back({*pose->T_camera_object, 0.0F});
  return candidates;
}

const ObjectPose* find_continued(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                                 const std::string& class_name, const ObjectPoses& earlier,
                                 const WarmStartSettings& settings) {
  const double max_turn = settings.max_turn_deg * kRadPerDeg;
  const ObjectPose* nearest = nullptr;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const ObjectPose* pose : earlier_poses(observation, class_name, earlier, settings)) {
    const int maximum = settings.max_continued + (settings.max_continued > 0 ? pose->class_id % kSpread : 0);
    if (pose->quality < settings.sure_quality || pose->continued_frames >= maximum) continue;
    const Eigen::Matrix3d turn = pose->T_camera_object->linear().transpose() * T_camera_object.linear();
    const double distance_m = (pose->T_camera_object->translation() - T_camera_object.translation()).norm();
    if (Eigen::AngleAxisd(turn).angle() > max_turn || distance_m >= nearest_m) continue;
    nearest = pose;
    nearest_m = distance_m;
  }
  return nearest;
}

const ObjectPose* find_rejected(const Detection& detection, std::int64_t utime, const ObjectPoses& earlier,
                                const WarmStartSettings& settings) {
  if (detection.reported) return nullptr;
  const auto repeats = [&](const ObjectPose& pose) {
    if (!pose.rejected_search || pose.class_name != detection.class_name) return false;
    const double age_s = seconds_between(pose.rejected_search->utime, utime);
    const double max_age_s = settings.max_rejected_s * (1.0 + static_cast<double>(pose.class_id % kSpread) / kSpread);
    return age_s > 0.0 && age_s <= max_age_s && pose.quality <= settings.sure_rejection_quality &&
           (detection.centre_camera - pose.rejected_search->centre_camera).norm() <= settings.rejected_reach_m;
  };
  const auto rejected = std::find_if(earlier.poses.begin(), earlier.poses.end(), repeats);
  return rejected == earlier.poses.end() ? nullptr : &*rejected;
}

}  // namespace houghstream
