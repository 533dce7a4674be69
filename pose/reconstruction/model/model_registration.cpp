#include "pose/reconstruction/model/model_registration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/parallel.hpp"
#include "pipeline/base/random.hpp"
#include "pose/model/mesh_bvh.hpp"
#include "pose/model/object_model.hpp"
#include "pose/motion/twist.hpp"
#include "pose/reconstruction/map/frame_alignment.hpp"

namespace houghstream::reconstruction {
namespace {

/// Holds some of a model's observed vertices, with colours as CIE L*a*b*.
struct Points {
  std::vector<Eigen::Vector3f> points, normals, colours;
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
};

std::vector<Eigen::Vector3f> lab_of(const Mesh& mesh) {
  std::vector<Eigen::Vector3f> colours(mesh.vertices.size(), Eigen::Vector3f::Zero());
  if (mesh.colours.size() != mesh.vertices.size()) return colours;
  cv::Mat lab;
  cv::cvtColor(cv::Mat(mesh.colours), lab, cv::COLOR_BGR2Lab);
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const cv::Vec3b& c = lab.at<cv::Vec3b>(static_cast<int>(i));
    colours[i] = {0.3F * static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
  }
  return colours;
}

Points sample(const PartialModel& model, const std::vector<Eigen::Vector3f>& lab, std::size_t count) {
  std::vector<std::uint32_t> observed;
  Eigen::AlignedBox3f box;
  for (std::size_t i = 0; i < model.mesh->vertices.size(); ++i) {
    if (!(*model.observed)[i]) continue;
    observed.push_back(static_cast<std::uint32_t>(i));
    box.extend(model.mesh->vertices[i]);
  }
  Points out;
  out.middle = box.center();
  Random random(7);
  for (std::size_t i = 0; i < std::min(count, observed.size()); ++i) {
    const std::uint32_t v = observed[static_cast<std::size_t>(random.below(static_cast<int>(observed.size())))];
    out.points.push_back(model.mesh->vertices[v]);
    out.normals.push_back(model.mesh->normals[v]);
    out.colours.push_back(lab[v]);
  }
  return out;
}

/// Searches the surface of model a.
class TargetSurface {
 public:
  explicit TargetSurface(const PartialModel& model) : model_(model), lab_(lab_of(*model.mesh)), tree_(*model.mesh) {}
  const std::vector<Eigen::Vector3f>& lab() const { return lab_; }

  struct ClosestSurface {
    Eigen::Vector3f point = Eigen::Vector3f::Zero();
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    Eigen::Vector3f colour = Eigen::Vector3f::Zero();
    float distance = 0.0F;
    bool observed = true;
  };
  ClosestSurface nearest(const Eigen::Vector3f& point) const {
    const ClosestPoint at = tree_.nearest(point);
    ClosestSurface closest;
    closest.distance = at.distance;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = model_.mesh->triangles[at.triangle][k];
      closest.point += at.weights[k] * model_.mesh->vertices[v];
      closest.normal += at.weights[k] * model_.mesh->normals[v];
      closest.colour += at.weights[k] * lab_[v];
      closest.observed = closest.observed && (*model_.observed)[v];
    }
    closest.normal.normalize();
    return closest;
  }

 private:
  PartialModel model_;
  std::vector<Eigen::Vector3f> lab_;
  MeshBvh tree_;
};

Eigen::Isometry3d refine(const TargetSurface& a, const Points& b, Eigen::Isometry3d T, int iterations, double limit_m) {
  for (int i = 0; i < iterations; ++i) {
    const double limit = limit_m * (1.0 - 0.8 * i / iterations);
    Matrix6 hessian = Matrix6::Identity() * 1e-6;
    Vector6 gradient = Vector6::Zero();
    for (std::size_t k = 0; k < b.points.size(); ++k) {
      const Eigen::Vector3f p = (T * b.points[k].cast<double>()).cast<float>();
      const TargetSurface::ClosestSurface closest = a.nearest(p);
      const double distance = closest.distance;
      const Eigen::Vector3d rotated = T.linear() * b.normals[k].cast<double>();
      if (!closest.observed || distance > limit || rotated.dot(closest.normal.cast<double>()) < 0.3) continue;
      const double tukey = 1.0 - distance * distance / (limit * limit);
      const Eigen::Vector3d n = T.linear().transpose() * closest.normal.cast<double>();
      Vector6 row;
      row << n, b.points[k].cast<double>().cross(n);
      hessian += tukey * tukey * row * row.transpose();
      gradient += tukey * tukey * closest.normal.dot(p - closest.point) * row;
    }
    T = retract_about_body(T, hessian.ldlt().solve(-gradient));
  }
  return T;
}

/// Returns the cost of a pose: distance and colour difference where both models were observed, and the lack of overlap.
/// `median_m` is the median distance.
double registration_cost(const TargetSurface& a, const Points& b, const Eigen::Isometry3d& T, double& median_m) {
  constexpr double kFar_m = 0.01;
  constexpr double kColour = 60.0;
  double sum = 0.0;
  std::vector<float> distances;
  for (std::size_t k = 0; k < b.points.size(); ++k) {
    const TargetSurface::ClosestSurface closest = a.nearest((T * b.points[k].cast<double>()).cast<float>());
    if (!closest.observed && closest.distance < kFar_m) {
      sum += 0.5;  // unknown: better than a contradiction, worse than agreement
      continue;
    }
    distances.push_back(closest.distance);
    sum += std::min(1.0, closest.distance / kFar_m) +
           0.5 * std::min(1.0, (closest.colour - b.colours[k]).norm() / kColour);
  }
  median_m = 1.0;
  if (distances.size() > b.points.size() / 5) {
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    median_m = *middle;
  }
  return sum / static_cast<double>(std::max<std::size_t>(1, b.points.size()));
}

std::vector<Eigen::Quaterniond> initial_rotations(bool upright) {
  constexpr int kRotations = 12;
  constexpr double kStep = 6.283185307179586 / kRotations;
  std::vector<Eigen::Quaterniond> rotations;
  const std::vector<Eigen::Vector3f> all = sphere_directions(2);
  for (const Eigen::Vector3f& up : upright ? std::vector<Eigen::Vector3f>{Eigen::Vector3f::UnitZ()} : all) {
    const Eigen::Quaterniond tilt = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up.cast<double>());
    for (int angle = 0; angle < (upright ? 3 : 1) * kRotations; ++angle)
      rotations.push_back(tilt * Eigen::AngleAxisd(angle * kStep / (upright ? 3 : 1), Eigen::Vector3d::UnitZ()));
  }
  return rotations;
}

}  // namespace

std::optional<ModelRegistration> register_models(const PartialModel& a, const PartialModel& b, bool upright,
                                                 int threads) {
  constexpr std::size_t kCoarsePoints = 120;
  constexpr std::size_t kFinePoints = 1200;
  constexpr std::size_t kMaxRefined = 24;
  constexpr double kMaxMedian_m = 0.004;
  const TargetSurface target(a);
  const std::vector<Eigen::Vector3f> lab = lab_of(*b.mesh);
  const Points coarse_points = sample(b, lab, kCoarsePoints);
  const Points fine_points = sample(b, lab, kFinePoints);
  const Points target_points = sample(a, target.lab(), kCoarsePoints);
  const std::vector<Eigen::Quaterniond> rotations = initial_rotations(upright);
  struct RegistrationStart {
    double cost = 1e9;
    ModelRegistration found;
  };
  std::vector<RegistrationStart> candidates(rotations.size());
  parallel_for(threads, static_cast<int>(rotations.size()), [&](int i) {
    RegistrationStart& c = candidates[static_cast<std::size_t>(i)];
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = rotations[static_cast<std::size_t>(i)].toRotationMatrix();
    T.translation() = target_points.middle.cast<double>() - T.linear() * coarse_points.middle.cast<double>();
    c.found.T_a_b = refine(target, coarse_points, T, 8, 0.05);
    c.cost = registration_cost(target, coarse_points, c.found.T_a_b, c.found.median_m);
  });
  const auto better = [](const RegistrationStart& x, const RegistrationStart& y) { return x.cost < y.cost; };
  std::stable_sort(candidates.begin(), candidates.end(), better);
  if (candidates.size() > kMaxRefined) candidates.resize(kMaxRefined);
  parallel_for(threads, static_cast<int>(candidates.size()), [&](int i) {
    RegistrationStart& c = candidates[static_cast<std::size_t>(i)];
    c.found.T_a_b = refine(target, fine_points, c.found.T_a_b, 15, 0.02);
    c.cost = registration_cost(target, fine_points, c.found.T_a_b, c.found.median_m);
  });
  const RegistrationStart& best = *std::min_element(candidates.begin(), candidates.end(), better);
  if (best.found.median_m > kMaxMedian_m) return std::nullopt;
  return best.found;
}

}  // namespace houghstream::reconstruction
