#include "tools/studies/recorded/mesh_alignment.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pose/model/mesh_bvh.hpp"
#include "pose/model/object_model.hpp"

namespace houghstream {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kFarOff_m = 0.01;
constexpr std::uint64_t kSeed = 1;
constexpr int kFinePoints = 3000;

struct Fit {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  double rms_m = std::numeric_limits<double>::infinity();
};

/// Gives the maximum correspondence distance of a registration, which shrinks.
struct Descent {
  int iterations = 0;
  double first_limit_m = 0.0;
  double last_limit_m = 0.0;
};

/// The target's surface with what registration asks of it.
class Target {
 public:
  explicit Target(const Mesh& mesh) : mesh_(mesh), tree_(mesh) {}

  Fit registered(const std::vector<Eigen::Vector3f>& points, Eigen::Isometry3d T, const Descent& descent) const {
    const double shrink = std::pow(descent.last_limit_m / descent.first_limit_m, 1.0 / descent.iterations);
    double limit = descent.first_limit_m;
    for (int i = 0; i < descent.iterations; ++i, limit *= shrink) T = step(points, T, limit) * T;
    return {T, rms(points, T)};
  }

 private:
  Eigen::Vector3d surface_point(const ClosestPoint& hit) const {
    Eigen::Vector3f point = Eigen::Vector3f::Zero();
    for (std::size_t k = 0; k < 3; ++k) point += hit.weights[k] * mesh_.vertices[mesh_.triangles[hit.triangle][k]];
    return point.cast<double>();
  }

  Eigen::Vector3d normal(std::uint32_t triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    const Eigen::Vector3f& corner = mesh_.vertices[a];
    return (mesh_.vertices[b] - corner).cross(mesh_.vertices[c] - corner).cast<double>().normalized();
  }

  /// Returns the motion that lowers the distances, about the middle of the points.
  Eigen::Isometry3d step(const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T, double limit) const {
    constexpr double kDamping = 1e-3;  // of the mean curvature, constrains rotations that round shapes leave open
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3f& point : points) middle += T * point.cast<double>() / static_cast<double>(points.size());
    Matrix6d squares = Matrix6d::Zero();
    Vector6d sums = Vector6d::Zero();
    for (const Eigen::Vector3f& point : points) {
      const Eigen::Vector3d p = T * point.cast<double>();
      const ClosestPoint hit = tree_.nearest(p.cast<float>());
      if (hit.distance >= limit) continue;
      const Eigen::Vector3d n = normal(hit.triangle);
      const double left = 1.0 - std::pow(hit.distance / limit, 2);
      Vector6d slope;
      slope << (p - middle).cross(n), n;
      squares += left * left * slope * slope.transpose();
      sums += left * left * n.dot(surface_point(hit) - p) * slope;
    }
    squares.topLeftCorner<3, 3>().diagonal().array() += kDamping * squares.topLeftCorner<3, 3>().trace() / 3.0;
    squares.bottomRightCorner<3, 3>().diagonal().array() += kDamping * squares.bottomRightCorner<3, 3>().trace() / 3.0;
    const Vector6d motion = squares.ldlt().solve(sums);
    if (!motion.allFinite()) return Eigen::Isometry3d::Identity();
    const double angle = motion.head<3>().norm();
    const Eigen::Vector3d axis = angle > 0.0 ? Eigen::Vector3d(motion.head<3>() / angle) : Eigen::Vector3d::UnitZ();
    return Eigen::Translation3d(middle + motion.tail<3>()) * Eigen::AngleAxisd(angle, axis) *
           Eigen::Translation3d(-middle);
  }

  double rms(const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T) const {
    double sum = 0.0;
    for (const Eigen::Vector3f& point : points) {
      const double distance = tree_.nearest((T * point.cast<double>()).cast<float>()).distance;
      sum += std::pow(std::min(distance, kFarOff_m), 2);
    }
    return std::sqrt(sum / static_cast<double>(points.size()));
  }

  const Mesh& mesh_;
  MeshBvh tree_;
};

Eigen::Vector3d middle_of(const std::vector<Eigen::Vector3f>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& point : points) sum += point.cast<double>();
  return sum / static_cast<double>(points.size());
}

/// Returns the source's middle on the target's, rotated by each of evenly spread rotations about 30 degrees apart.
std::vector<Eigen::Isometry3d> starts(const Eigen::Vector3d& source_middle, const Eigen::Vector3d& target_middle) {
  constexpr int kRotations = 12;
  std::vector<Eigen::Isometry3d> out;
  for (const Eigen::Vector3f& direction : sphere_directions(2)) {
    const auto tilt = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), direction.cast<double>());
    for (int k = 0; k < kRotations; ++k) {
      const Eigen::AngleAxisd rotation(2.0 * M_PI * k / kRotations, Eigen::Vector3d::UnitZ());
      out.emplace_back(Eigen::Translation3d(target_middle) * tilt * rotation * Eigen::Translation3d(-source_middle));
    }
  }
  return out;
}

double angle_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
}

void sort_by_rms(std::vector<Fit>& fits) {
  std::stable_sort(fits.begin(), fits.end(), [](const Fit& a, const Fit& b) { return a.rms_m < b.rms_m; });
}

/// Returns the best fits without duplicates, at most `maximum`. `fits` is sorted.
std::vector<Fit> distinct(const std::vector<Fit>& fits, double apart_rad, std::size_t maximum) {
  std::vector<Fit> kept;
  for (const Fit& fit : fits) {
    const auto is_near = [&](const Fit& o) {
      return angle_between(fit.T_target_source, o.T_target_source) < apart_rad;
    };
    if (kept.size() < maximum && std::none_of(kept.begin(), kept.end(), is_near)) kept.push_back(fit);
  }
  return kept;
}

}  // namespace

MeshAlignment align_meshes(const Mesh& source, const Mesh& target) {
  require(!source.triangles.empty(), "mesh of {} vertices without triangles, expected a surface",
          source.vertices.size());
  constexpr int kCoarsePoints = 150;
  constexpr std::size_t kRefined = 12;
  constexpr double kSame_rad = 10.0 * M_PI / 180.0;
  constexpr double kOther_rad = 20.0 * M_PI / 180.0;
  constexpr Descent kCoarse{12, 0.06, 0.02};
  constexpr Descent kFine{40, 0.02, 0.005};
  const Target surface(target);
  const std::vector<Eigen::Vector3f> few = sample_surface(source, kCoarsePoints, kSeed).points;
  const std::vector<Eigen::Vector3f> many = sample_surface(source, kFinePoints, kSeed).points;
  const Eigen::Vector3d target_middle = middle_of(sample_surface(target, kFinePoints, kSeed).points);
  std::vector<Fit> coarse;
  for (const Eigen::Isometry3d& T : starts(middle_of(many), target_middle)) {
    coarse.push_back(surface.registered(few, T, kCoarse));
  }
  sort_by_rms(coarse);
  std::vector<Fit> fine;
  for (const Fit& fit : distinct(coarse, kSame_rad, kRefined)) {
    fine.push_back(surface.registered(many, fit.T_target_source, kFine));
  }
  sort_by_rms(fine);
  const std::vector<Fit> basins = distinct(fine, kOther_rad, 2);
  const double next = basins.size() > 1 ? basins[1].rms_m : std::numeric_limits<double>::quiet_NaN();
  return {basins[0].T_target_source, basins[0].rms_m, next};
}

Eigen::Isometry3d refined_alignment(const Mesh& source, const Mesh& target, const Eigen::Isometry3d& T_start) {
  constexpr Descent kRefining{30, 0.01, 0.003};
  const std::vector<Eigen::Vector3f> points = sample_surface(source, kFinePoints, kSeed).points;
  return Target(target).registered(points, T_start, kRefining).T_target_source;
}

}  // namespace houghstream
