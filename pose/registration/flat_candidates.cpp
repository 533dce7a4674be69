#include "pose/registration/flat_candidates.hpp"

#include <algorithm>
#include <cmath>

#include "pose/seen/foreground_search.hpp"

namespace houghstream {
namespace {

/// The search of one object on one plane.
class FlatSearch {
 public:
  FlatSearch(const ObjectObservation& observation, const SurfaceForeground& foreground)
      : observation_(observation),
        foreground_(foreground),
        centre_(observation.model.centre.cast<double>()),
        normal_(foreground.plane.normal()),
        along_(normal_.unitOrthogonal()),
        across_(normal_.cross(along_)) {}

  /// Returns the angles that agree better than their neighbours, with the thin axis along the normal, or against it.
  std::vector<PoseCandidate> best_angles(double side) const {
    constexpr std::size_t kAngles = 24;
    const Eigen::Vector3d thin = observation_.model.axes.col(observation_.model.thin_axis).cast<double>();
    const Eigen::Quaterniond up = Eigen::Quaterniond::FromTwoVectors(side * thin, normal_);
    const Eigen::Vector3d place = foreground_.centre + height_above_lowest(up) * normal_;
    std::vector<PoseCandidate> ring;
    for (std::size_t i = 0; i < kAngles; ++i) {
      const Eigen::AngleAxisd angle(2.0 * M_PI * static_cast<double>(i) / kAngles, normal_);
      ring.push_back(scored(Eigen::Translation3d(place) * (angle * up) * Eigen::Translation3d(-centre_)));
    }
    std::vector<PoseCandidate> best;
    for (std::size_t i = 0; i < kAngles; ++i) {
      const float last = ring[(i + kAngles - 1) % kAngles].score;
      if (ring[i].score > last && ring[i].score >= ring[(i + 1) % kAngles].score) best.push_back(ring[i]);
    }
    return best;
  }

  /// Moves and turns a pose on the plane in steps that shrink where none is better.
  PoseCandidate climb(PoseCandidate best) const {
    constexpr int kRounds = 6;
    constexpr double kStep_m = 0.008;
    constexpr double kStep_rad = 0.1;
    double size = 1.0;
    for (int round = 0; round < kRounds; ++round) {
      const float before = best.score;
      for (const double step : {size, -size}) {
        for (const Eigen::Vector3d& direction : {along_, across_}) {
          const Eigen::Translation3d shift(kStep_m * step * direction);
          keep_better(scored(shift * best.T_camera_object), best);
        }
        const Eigen::Translation3d middle(best.T_camera_object * centre_);
        keep_better(
            scored(middle * Eigen::AngleAxisd(kStep_rad * step, normal_) * middle.inverse() * best.T_camera_object),
            best);
      }
      if (!(best.score > before)) size *= 0.5;
    }
    return best;
  }

 private:
  static void keep_better(const PoseCandidate& candidate, PoseCandidate& best) {
    if (candidate.score > best.score) best = candidate;
  }

  PoseCandidate scored(const Eigen::Isometry3d& pose) const {
    constexpr int kPoints = 120;
    return {pose, mean_evidence(foreground_, project_view(observation_.frame, observation_.model, pose, kPoints))};
  }

  /// Returns how high the model's centre is above its lowest point; turns about the normal do not change it.
  double height_above_lowest(const Eigen::Quaterniond& rotation) const {
    const Eigen::Vector3d up = rotation.inverse() * normal_;  // object frame
    double lowest = 0.0;
    for (const Eigen::Vector3f& vertex : observation_.model.mesh.vertices)
      lowest = std::min(lowest, up.dot(vertex.cast<double>() - centre_));
    return -lowest;
  }

  const ObjectObservation& observation_;
  const SurfaceForeground& foreground_;
  Eigen::Vector3d centre_;
  Eigen::Vector3d normal_;
  Eigen::Vector3d along_;
  Eigen::Vector3d across_;
};

void keep_best(std::size_t maximum, std::vector<PoseCandidate>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const PoseCandidate& a, const PoseCandidate& b) { return a.score > b.score; });
  candidates.resize(std::min(candidates.size(), maximum));
}

}  // namespace

std::vector<PoseCandidate> flat_candidates(const ObjectObservation& observation, int maximum) {
  if (!observation.foreground) return {};
  const FlatSearch search(observation, *observation.foreground);
  std::vector<PoseCandidate> candidates = search.best_angles(1.0);
  const std::vector<PoseCandidate> other_side = search.best_angles(-1.0);
  candidates.insert(candidates.end(), other_side.begin(), other_side.end());
  const auto kept = static_cast<std::size_t>(std::max(0, maximum));
  keep_best(2 * kept, candidates);
  for (PoseCandidate& candidate : candidates) candidate = search.climb(candidate);
  keep_best(kept, candidates);
  return candidates;
}

}  // namespace houghstream
