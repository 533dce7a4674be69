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

Points sample(const PartlySeen& model, const std::vector<Eigen::Vector3f>& lab, std::size_t count) {
  std::vector<std::uint32_t> seen;
  Eigen::AlignedBox3f box;
  for (std::size_t i = 0; i < model.mesh->vertices.size(); ++i) {
    if (!(*model.seen)[i]) continue;
    seen.push_back(static_cast<std::uint32_t>(i));
    box.extend(model.mesh->vertices[i]);
  }
  Points out;
  out.middle = box.center();
  Random random(7);
  for (std::size_t i = 0; i < std::min(count, seen.size()); ++i) {
    const std::uint32_t v = seen[static_cast<std::size_t>(random.below(static_cast<int>(seen.size())))];
    out.points.push_back(model.mesh->vertices[v]);
    out.normals.push_back(model.mesh->normals[v]);
    out.colours.push_back(lab[v]);
  }
  return out;
}

/// Searches the surface of model a.
class Target {
 public:
  explicit Target(const PartlySeen& model) : model_(model), lab_(lab_of(*model.mesh)), tree_(*model.mesh) {}
  const std::vector<Eigen::Vector3f>& lab() const { return lab_; }

  struct Hit {
    Eigen::Vector3f point = Eigen::Vector3f::Zero();
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    Eigen::Vector3f colour = Eigen::Vector3f::Zero();
    float distance = 0.0F;
    bool seen = true;
  };
  Hit nearest(const Eigen::Vector3f& point) const {
    const ClosestPoint at = tree_.nearest(point);
    Hit hit;
    hit.distance = at.distance;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = model_.mesh->triangles[at.triangle][k];
      hit.point += at.weights[k] * model_.mesh->vertices[v];
      hit.normal += at.weights[k] * model_.mesh->normals[v];
      hit.colour += at.weights[k] * lab_[v];
      hit.seen = hit.seen && (*model_.seen)[v];
    }
    hit.normal.normalize();
    return hit;
  }

 private:
  PartlySeen model_;
  std::vector<Eigen::Vector3f> lab_;
  MeshBvh tree_;
};

Eigen::Isometry3d refine(const Target& a, const Points& b, Eigen::Isometry3d T, int iterations, double limit_m) {
  for (int i = 0; i < iterations; ++i) {
    const double limit = limit_m * (1.0 - 0.8 * i / iterations);
    Matrix6 squares = Matrix6::Identity() * 1e-6;
    Vector6 slope = Vector6::Zero();
    for (std::size_t k = 0; k < b.points.size(); ++k) {
      const Eigen::Vector3f p = (T * b.points[k].cast<double>()).cast<float>();
      const Target::Hit hit = a.nearest(p);
      const double distance = hit.distance;
      const Eigen::Vector3d rotated = T.linear() * b.normals[k].cast<double>();
      if (!hit.seen || distance > limit || rotated.dot(hit.normal.cast<double>()) < 0.3) continue;
      const double rest = 1.0 - distance * distance / (limit * limit);
      const Eigen::Vector3d n = T.linear().transpose() * hit.normal.cast<double>();
      Vector6 row;
      row << n, b.points[k].cast<double>().cross(n);
      squares += rest * rest * row * row.transpose();
      slope += rest * rest * hit.normal.dot(p - hit.point) * row;
    }
    T = retract_about_body(T, squares.ldlt().solve(-slope));
  }
  return T;
}

/// Returns the cost of a pose: distance and colour difference where both models were observed, and the lack of overlap.
/// `median_m` is the median distance.
double cost_of(const Target& a, const Points& b, const Eigen::Isometry3d& T, double& median_m) {
  constexpr double kFar_m = 0.01;
  constexpr double kColour = 60.0;
  double sum = 0.0;
  std::vector<float> distances;
  for (std::size_t k = 0; k < b.points.size(); ++k) {
    const Target::Hit hit = a.nearest((T * b.points[k].cast<double>()).cast<float>());
    if (!hit.seen && hit.distance < kFar_m) {
      sum += 0.5;  // unknown: better than a contradiction, worse than agreement
      continue;
    }
    distances.push_back(hit.distance);
    sum += std::min(1.0, hit.distance / kFar_m) + 0.5 * std::min(1.0, (hit.colour - b.colours[k]).norm() / kColour);
  }
  median_m = 1.0;
  if (distances.size() > b.points.size() / 5) {
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    median_m = *middle;
  }
  return sum / static_cast<double>(std::max<std::size_t>(1, b.points.size()));
}

std::vector<Eigen::Quaterniond> starts(bool upright) {
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

std::optional<ModelRegistration> register_models(const PartlySeen& a, const PartlySeen& b, bool upright, int threads) {
  constexpr std::size_t kCoarse = 120;
  constexpr std::size_t kFine = 1200;
  constexpr std::size_t kKept = 24;
  constexpr double kMax_m = 0.004;
  const Target target(a);
  const std::vector<Eigen::Vector3f> lab = lab_of(*b.mesh);
  const Points few = sample(b, lab, kCoarse);
  const Points many = sample(b, lab, kFine);
  const Points of_a = sample(a, target.lab(), kCoarse);
  const std::vector<Eigen::Quaterniond> rotations = starts(upright);
  struct RegistrationStart {
    double cost = 1e9;
    ModelRegistration found;
  };
  std::vector<RegistrationStart> candidates(rotations.size());
  parallel_for(threads, static_cast<int>(rotations.size()), [&](int i) {
    RegistrationStart& c = candidates[static_cast<std::size_t>(i)];
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = rotations[static_cast<std::size_t>(i)].toRotationMatrix();
    T.translation() = of_a.middle.cast<double>() - T.linear() * few.middle.cast<double>();
    c.found.T_a_b = refine(target, few, T, 8, 0.05);
    c.cost = cost_of(target, few, c.found.T_a_b, c.found.median_m);
  });
  const auto better = [](const RegistrationStart& x, const RegistrationStart& y) { return x.cost < y.cost; };
  std::stable_sort(candidates.begin(), candidates.end(), better);
  if (candidates.size() > kKept) candidates.resize(kKept);
  parallel_for(threads, static_cast<int>(candidates.size()), [&](int i) {
    RegistrationStart& c = candidates[static_cast<std::size_t>(i)];
    c.found.T_a_b = refine(target, many, c.found.T_a_b, 15, 0.02);
    c.cost = cost_of(target, many, c.found.T_a_b, c.found.median_m);
  });
  const RegistrationStart& best = *std::min_element(candidates.begin(), candidates.end(), better);
  if (best.found.median_m > kMax_m) return std::nullopt;
  return best.found;
}

}  // namespace houghstream::reconstruction
