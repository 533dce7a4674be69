#include "pose/model/symmetry_search.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "pose/model/angles.hpp"
#include "pose/model/revolution_axis.hpp"
#include "pose/model/surface_colour.hpp"
#include "pose/model/symmetry.hpp"

namespace houghstream {
namespace {

constexpr double kSameDirection = 0.985;                 // cosine of 10 degrees
constexpr double kSameRotation_rad = 25.0 * kRadPerDeg;  // rotations of a group differ by 60 degrees and more
constexpr int kMaxFold = 6;
constexpr std::size_t kMaxGroup = 60;  // the icosahedron's

bool has_colours(const Mesh& mesh) {
  return !mesh.colours.empty() || (!mesh.texture.empty() && !mesh.uvs.empty());
}

float tolerance_of(double diameter_m, const SymmetrySearch& settings) {
  constexpr double kMax = 0.05;  // diameters
  const double noise_m = std::min(settings.min_tolerance_m, kMax * diameter_m);
  return static_cast<float>(std::max(settings.tolerance * diameter_m, noise_m));
}

/// Returns BGR at a point of the surface, from the texture where there is one.
Eigen::Vector3f colour_at(const Mesh& mesh, const ClosestPoint& hit) {
  const auto& triangle = mesh.triangles[hit.triangle];
  if (mesh.texture.empty() || mesh.uvs.empty()) {
    Eigen::Vector3f colour = Eigen::Vector3f::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      const cv::Vec3b& corner = mesh.colours[triangle[i]];
      colour += hit.weights[i] * Eigen::Vector3f(corner[0], corner[1], corner[2]);
    }
    return colour;
  }
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();
  for (std::size_t i = 0; i < 3; ++i) uv += hit.weights[i] * mesh.uvs[triangle[i]];
  const cv::Vec3b& colour = texel_at(mesh.texture, uv);
  return {static_cast<float>(colour[0]), static_cast<float>(colour[1]), static_cast<float>(colour[2])};
}

/// Holds the second moments of the surface, which are exact for triangles of even thickness.
struct Moments {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns, in the order of `spread`
  Eigen::Vector3d spread = Eigen::Vector3d::Zero();    ///< standard deviations along the axes, ascending, metres
};

Moments surface_moments(const Mesh& mesh) {
  double area = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>();
    const double triangle_area = 0.5 * (b - a).cross(c - a).norm();
    const Eigen::Vector3d sum = a + b + c;
    area += triangle_area;
    first += triangle_area / 3.0 * sum;
    second +=
        triangle_area / 12.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  require(area > 0.0, "mesh of {} triangles with surface area 0, expected a surface", mesh.triangles.size());
  Moments out;
  out.centroid = first / area;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(second / area - out.centroid * out.centroid.transpose());
  out.axes = solver.eigenvectors();
  out.spread = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return out;
}

double angle_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

/// Returns the box axes first: where a principal axis is nearly one of them, the mesh was drawn along it.
std::vector<Eigen::Vector3d> candidate_axes(const Moments& moments) {
  std::vector<Eigen::Vector3d> axes = {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX()};
  for (int i = 0; i < 3; ++i) axes.emplace_back(moments.axes.col(i));
  return axes;
}

/// No n-fold axis has more than a few of these angles among its own.
constexpr std::array<double, 8> kAngles_deg = {23, 37, 53, 71, 97, 113, 139, 163};

bool fits_any_angle(const RotationSymmetryTest& check, const ContinuousSymmetry& axis) {
  constexpr double kRms = 0.5;  // over all angles what a square bar's edges deviate is halved
  return std::all_of(kAngles_deg.begin(), kAngles_deg.end(), [&](double angle) {
    return check.is_symmetric_under(rotation_about(axis, angle * kRadPerDeg), kRms);
  });
}

std::vector<ContinuousSymmetry> continuous_axes(const RotationSymmetryTest& check, const Moments& moments,
                                                const std::vector<ContinuousSymmetry>& of_revolution) {
  std::vector<ContinuousSymmetry> candidates;
  for (const Eigen::Vector3d& axis : candidate_axes(moments)) candidates.push_back({axis, moments.centroid});
  candidates.insert(candidates.end(), of_revolution.begin(), of_revolution.end());
  std::vector<ContinuousSymmetry> found;
  for (const ContinuousSymmetry& axis : candidates) {
    const bool known = std::any_of(found.begin(), found.end(), [&](const ContinuousSymmetry& other) {
      return std::abs(other.axis.dot(axis.axis)) > kSameDirection;
    });
    if (!known && fits_any_angle(check, axis)) found.push_back(axis);
    if (found.size() == 2) break;  // a ball
  }
  return found;
}

/// Returns one rotation per axis: the smallest that fits as it is, of which the others are multiples. Rotations that
/// fit less well are registered first, since products of rotations that are a few degrees off do not fit.
std::vector<Eigen::Isometry3d> min_rotations(const RotationSymmetryTest& check, const Moments& moments) {
  constexpr double kExactRms = 0.2;  // tolerances
  std::vector<Eigen::Isometry3d> turns;
  std::vector<Eigen::Vector3d> known;
  for (const Eigen::Vector3d& axis : candidate_axes(moments)) {
    const auto same = [&](const Eigen::Vector3d& other) { return std::abs(other.dot(axis)) > kSameDirection; };
    if (std::any_of(known.begin(), known.end(), same)) continue;
    for (int fold = kMaxFold; fold >= 2; --fold) {
      if (!check.is_symmetric_under(check.rotation_about_axis(axis, 2.0 * M_PI / fold), kExactRms)) continue;
      turns.push_back(check.rotation_about_axis(axis, 2.0 * M_PI / fold));
      known.push_back(axis);
      break;
    }
  }
  return turns;
}

/// A rotation by a whole fraction of a full one, from which registration starts.
struct FoldedRotation {
  Eigen::Isometry3d T;
  double deviation_m = 0.0;
};

/// Returns the rotations to try where the moments leave the axis open: about the principal axes where no two spreads
/// are alike, by half a turn about any axis between two that are alike and by any fold about the third, or about any
/// axis where all three are alike.
std::vector<FoldedRotation> possible_rotations(const RotationSymmetryTest& check, const Moments& moments) {
  std::vector<FoldedRotation> turns;
  const auto add = [&](const Eigen::Vector3d& axis, int max_fold) {
    for (int fold = 2; fold <= max_fold; ++fold)
      turns.push_back({check.rotation_about_axis(axis, 2.0 * M_PI / fold), 0.0});
  };
  const auto alike = [&](Eigen::Index i, Eigen::Index j) {
    return moments.spread[j] - moments.spread[i] <= check.tolerance_m();
  };
  constexpr int kDirections = 100;
  if (alike(0, 2)) {
    for (const Eigen::Vector3d& axis : hemisphere_directions(kDirections)) add(axis, kMaxFold);
  } else {
    for (Eigen::Index i = 0; i < 3; ++i) {  // the plane across principal axis i holds the others
      const Eigen::Index a = i == 0 ? 1 : 0;
      const Eigen::Index b = i == 2 ? 1 : 2;
      const bool is_open = b - a == 1 && alike(a, b);
      add(moments.axes.col(i), is_open ? kMaxFold : 2);
      constexpr double kStep_deg = 5.0;
      for (double angle = kStep_deg; is_open && angle < 180.0; angle += kStep_deg)
        add(Eigen::AngleAxisd(angle * kRadPerDeg, moments.axes.col(i)) * moments.axes.col(a), 2);
    }
  }
  for (FoldedRotation& rotation_step : turns) rotation_step.deviation_m = check.deviation(rotation_step.T);
  std::stable_sort(turns.begin(), turns.end(),
                   [](const FoldedRotation& a, const FoldedRotation& b) { return a.deviation_m < b.deviation_m; });
  return turns;
}

/// Returns the rotation of an n-fold axis, n up to 6, that is nearest to a motion, about the motion's axis.
Eigen::Isometry3d folded(const Eigen::Isometry3d& T, const Eigen::Vector3d& centre) {
  constexpr std::array<double, 6> kFolded_deg = {60, 72, 90, 120, 144, 180};
  const Eigen::AngleAxisd rotation(T.linear());
  const Eigen::Vector3d moved = T * centre - centre;
  const Eigen::Vector3d across = moved - rotation.axis().dot(moved) * rotation.axis();
  const double cotangent = 1.0 / std::tan(0.5 * std::max(rotation.angle(), kSameRotation_rad));
  const Eigen::Vector3d offset = centre + 0.5 * (across + cotangent * rotation.axis().cross(across));
  double nearest_deg = kFolded_deg.front();
  for (const double angle_deg : kFolded_deg) {
    const auto off = [&](double deg) { return std::abs(deg * kRadPerDeg - rotation.angle()); };
    if (off(angle_deg) < off(nearest_deg)) nearest_deg = angle_deg;
  }
  return rotation_about({rotation.axis(), offset}, nearest_deg * kRadPerDeg);
}

/// Adds to a group, whose first element is the identity, what its elements and those of `generators` combine to. A
/// product that does not fit as it is, is registered: a rotation that is a little off makes products that are more so.
/// Returns whether all products fit.
bool close_under_composition(const RotationSymmetryTest& check, const std::vector<Eigen::Isometry3d>& generators,
                             std::vector<Eigen::Isometry3d>& group) {
  constexpr double kRmsOfProduct = 1.5;
  constexpr double kMaxError_rad = 12.0 * kRadPerDeg;  // limit for products of rotations that are a few degrees off
  constexpr double kMaxCorrection_rad = 5.0 * kRadPerDeg;
  for (std::size_t i = 0; i < group.size(); ++i) {
    for (const Eigen::Isometry3d& generator : generators) {
      Eigen::Isometry3d product = generator * group[i];
      if (group.size() == kMaxGroup || is_near_any(product, group, kMaxError_rad)) continue;
      if (is_near_any(product, group, kSameRotation_rad)) return false;  // neither an element nor another one
      if (!check.is_symmetric_under(product, kRmsOfProduct)) {
        const Eigen::Isometry3d refined = folded(check.registered(product), check.centre());
        if (angle_between(refined, product) > kMaxCorrection_rad || !check.is_symmetric_under(refined, kRmsOfProduct))
          return false;
        product = refined;
      }
      group.push_back(product);
    }
  }
  return true;
}

/// Returns the group that the turns generate together with those that fit after registration.
std::vector<Eigen::Isometry3d> registered_group(const RotationSymmetryTest& check, const Moments& moments,
                                                std::vector<Eigen::Isometry3d> turns) {
  constexpr double kBasin_rad = 15.0 * kRadPerDeg;  // registration leads to the same from within
  constexpr std::size_t kMaxTries = 24;
  std::vector<Eigen::Isometry3d> tried;
  std::vector<Eigen::Isometry3d> group = group_of(turns);
  group.insert(group.begin(), Eigen::Isometry3d::Identity());
  for (const FoldedRotation& start : possible_rotations(check, moments)) {
    if (tried.size() >= kMaxTries) break;
    if (is_near_any(start.T, group, kBasin_rad) || is_near_any(start.T, tried, kBasin_rad)) continue;
    tried.push_back(start.T);
    const Eigen::Isometry3d rotation_step = folded(check.registered(start.T), check.centre());
    if (is_near_any(rotation_step, group, kSameRotation_rad) || !check.is_symmetric_under(rotation_step)) continue;
    turns.push_back(rotation_step);
    std::vector<Eigen::Isometry3d> larger = group;
    if (close_under_composition(check, turns, larger)) {
      group = std::move(larger);
    } else {
      turns.pop_back();
    }
  }
  group.erase(group.begin());
  return group;
}

/// Returns half turns that exchange the ends of an axis about which any angle fits.
std::vector<Eigen::Isometry3d> end_over_end(const RotationSymmetryTest& check, const ContinuousSymmetry& round) {
  const Eigen::Vector3d across = round.axis.unitOrthogonal();
  const Eigen::Isometry3d plain = rotation_about({across, round.offset}, M_PI);
  if (check.is_symmetric_under(plain)) return {plain};
  const Eigen::Vector3d& centre = check.centre();
  const Eigen::Vector3d middle = 0.5 * (centre + check.registered(plain) * centre);
  const Eigen::Vector3d offset = round.offset + round.axis.dot(middle - round.offset) * round.axis;
  const Eigen::Isometry3d rotation_step = rotation_about({across, offset}, M_PI);
  return check.is_symmetric_under(rotation_step) ? std::vector<Eigen::Isometry3d>{rotation_step}
                                                 : std::vector<Eigen::Isometry3d>{};
}

Symmetries symmetries_by(const RotationSymmetryTest& check, const Moments& moments,
                         const std::vector<ContinuousSymmetry>& of_revolution) {
  Symmetries found;
  found.continuous = continuous_axes(check, moments, of_revolution);
  if (found.continuous.empty()) {
    found.discrete = registered_group(check, moments, min_rotations(check, moments));
  } else if (found.continuous.size() == 1) {
    found.discrete = end_over_end(check, found.continuous.front());
  }
  return found;
}

std::vector<ContinuousSymmetry> revolution_axes(const RotationSymmetryTest& check) {
  constexpr std::size_t kPoints = 300;
  constexpr double kSigma = 0.05;  // diameters, per radian: what 3 degrees of a normal make at the surface
  SurfacePoints some = check.surface();
  some.points.resize(std::min(kPoints, some.points.size()));
  some.normals.resize(some.points.size());
  return find_revolution_axes(some, check.centre(), kSigma * check.diameter_m());
}

/// Returns whether a registration comes no nearer any more: most of them lead nowhere, slowly.
bool has_stalled(const std::vector<double>& means_m) {
  constexpr std::size_t kSteps = 8;
  constexpr double kMinGain = 0.05;  // fraction of the distance, over these steps
  return means_m.size() > kSteps && means_m.back() > (1.0 - kMinGain) * means_m[means_m.size() - 1 - kSteps];
}

}  // namespace

bool is_near_any(const Eigen::Isometry3d& T, const std::vector<Eigen::Isometry3d>& known, double angle_rad) {
  return std::any_of(known.begin(), known.end(),
                     [&](const Eigen::Isometry3d& other) { return angle_between(T, other) < angle_rad; });
}

std::vector<Eigen::Isometry3d> group_of(const std::vector<Eigen::Isometry3d>& turns) {
  std::vector<Eigen::Isometry3d> group = {Eigen::Isometry3d::Identity()};
  for (std::size_t i = 0; i < group.size(); ++i) {
    for (const Eigen::Isometry3d& rotation_step : turns) {
      const Eigen::Isometry3d product = rotation_step * group[i];
      if (!is_near_any(product, group, kSameRotation_rad) && group.size() < kMaxGroup) group.push_back(product);
    }
  }
  group.erase(group.begin());
  return group;
}

RotationSymmetryTest::RotationSymmetryTest(const MeasuredMesh& measured, const Eigen::Vector3d& centre,
                                           const SymmetrySearch& settings)
    : measured_(measured),
      settings_(settings),
      centre_(centre),
      tolerance_m_(tolerance_of(measured.diameter_m, settings)) {
  const Mesh& mesh = measured.mesh;
  constexpr int kPoints = 1000;
  constexpr std::uint64_t kSeed = 1;
  surface_ = sample_surface(mesh, kPoints, kSeed);
  constexpr std::size_t kMaxCorners = 2000;
  const std::size_t step = mesh.vertices.size() / kMaxCorners + 1;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += step) corners_.push_back(mesh.vertices[i]);
  if (!settings.compare_colours || !has_colours(mesh)) return;
  for (const Eigen::Vector3f& point : surface_.points)
    colours_.push_back(colour_at(mesh, measured.tree.nearest(point)));
}

Eigen::Isometry3d RotationSymmetryTest::rotation_about_axis(const Eigen::Vector3d& axis, double angle_rad) const {
  return rotation_about({axis, centre_}, angle_rad);
}

bool RotationSymmetryTest::is_symmetric_under(const Eigen::Isometry3d& T_exact, double rms) const {
  const Eigen::Isometry3f T = T_exact.cast<float>();
  const float max_m = static_cast<float>(settings_.max_deviation) * tolerance_m_;
  const float beyond_m = std::nextafter(max_m, std::numeric_limits<float>::infinity());
  const auto is_near = [&](const Eigen::Vector3f& point) { return distance(T * point, beyond_m) <= max_m; };
  if (!std::all_of(corners_.begin(), corners_.end(), is_near)) return false;
  const double max_rms_m = rms * tolerance_m();
  double left = max_rms_m * max_rms_m * static_cast<double>(surface_.points.size());
  for (const Eigen::Vector3f& point : surface_.points) {
    const auto distance_m = static_cast<double>(distance(T * point, beyond_m));
    left -= distance_m * distance_m;
    if (distance_m > static_cast<double>(max_m) || left < 0.0) return false;
  }
  return differing_fraction(T) <= settings_.max_differing_fraction;
}

double RotationSymmetryTest::deviation(const Eigen::Isometry3d& T_exact) const {
  constexpr std::size_t kPoints = 100;  // the first of farthest points are as evenly spread as all are
  const Eigen::Isometry3f T = T_exact.cast<float>();
  const std::size_t count = std::min(kPoints, surface_.points.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i)
    sum += static_cast<double>(measured_.tree.nearest(T * surface_.points[i]).distance);
  return sum / static_cast<double>(count);
}

Eigen::Isometry3d RotationSymmetryTest::registered(const Eigen::Isometry3d& start) const {
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  constexpr std::size_t kPoints = 200;
  constexpr std::size_t kPointsOfSigma = 100;
  constexpr int kSteps = 40;
  constexpr double kDamping = 1e-4;
  constexpr double kStill_m = 1e-5;
  const Mesh& mesh = measured_.mesh;
  const std::size_t count = std::min(kPoints, surface_.points.size());
  const double radius_m = std::max(1e-3, (surface_.points.front().cast<double>() - centre_).norm());
  std::vector<ClosestPoint> hits(count);
  std::vector<double> means_m;  // means of the distances, by step
  Eigen::Isometry3d T = start;
  for (int step = 0; step < kSteps; ++step) {
    double sum_m = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3f moved = (T * surface_.points[i].cast<double>()).cast<float>();
      hits[i] = step == 0 ? measured_.tree.nearest(moved) : measured_.tree.nearest_with_guess(moved, hits[i].triangle);
      if (i < kPointsOfSigma) sum_m += static_cast<double>(hits[i].distance);
    }
    means_m.push_back(sum_m / static_cast<double>(std::min(kPointsOfSigma, count)));
    if (has_stalled(means_m)) break;
    const double sigma_m = std::max(tolerance_m(), 2.0 * means_m.back());
    Matrix6 normal_matrix = Matrix6::Zero();
    Vector6 right_side = Vector6::Zero();
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d moved = T * surface_.points[i].cast<double>();
      const auto& t = mesh.triangles[hits[i].triangle];
      Eigen::Vector3f closest = Eigen::Vector3f::Zero();
      for (std::size_t k = 0; k < 3; ++k) closest += hits[i].weights[k] * mesh.vertices[t[k]];
      const Eigen::Vector3d normal = (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                                         .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                                         .cast<double>()
                                         .normalized();
      const double r = normal.dot(moved - closest.cast<double>());
      const double ratio = r / sigma_m;
      const double weight = 1.0 / ((1.0 + ratio * ratio) * (1.0 + ratio * ratio));
      Vector6 jacobian;
      jacobian << (moved - centre_).cross(normal) / radius_m, normal;
      normal_matrix += weight * jacobian * jacobian.transpose();
      right_side -= weight * r * jacobian;
    }
    normal_matrix.diagonal().array() += kDamping * static_cast<double>(count);
    const Vector6 change = normal_matrix.ldlt().solve(right_side);
    const Eigen::Vector3d rotation = change.head<3>() / radius_m;
    const Eigen::AngleAxisd rotated(rotation.norm(), rotation.stableNormalized());
    T = Eigen::Translation3d(centre_ + change.tail<3>()) * rotated * Eigen::Translation3d(-centre_) * T;
    if (change.norm() < kStill_m) break;
  }
  return T;
}

double RotationSymmetryTest::round_fraction(const ContinuousSymmetry& axis) const {
  std::vector<Eigen::Isometry3f> rotations;
  for (const double angle : kAngles_deg) rotations.push_back(rotation_about(axis, angle * kRadPerDeg).cast<float>());
  constexpr double kAcross = 0.5;  // cosine of 60 degrees between surface and axis
  int counted = 0;
  int round = 0;
  for (std::size_t i = 0; i < surface_.points.size(); ++i) {
    if (surface_.normals[i].cast<double>().cross(axis.axis).norm() < kAcross) continue;
    ++counted;
    const bool fits = std::all_of(rotations.begin(), rotations.end(), [&](const Eigen::Isometry3f& T) {
      return distance(T * surface_.points[i], tolerance_m_) < tolerance_m_;
    });
    round += fits ? 1 : 0;
  }
  return counted > 0 ? static_cast<double>(round) / counted : 0.0;
}

double RotationSymmetryTest::differing_fraction(const Eigen::Isometry3f& T) const {
  int differing = 0;
  for (std::size_t i = 0; i < colours_.size(); ++i) {
    const Eigen::Vector3f there = colour_at(measured_.mesh, measured_.tree.nearest(T * surface_.points[i]));
    const double difference = static_cast<double>((there - colours_[i]).cwiseAbs().mean()) / 255.0;
    differing += difference > settings_.colour_difference ? 1 : 0;
  }
  return static_cast<double>(differing) / static_cast<double>(surface_.points.size());
}

Symmetries find_symmetries(const Mesh& mesh, const SymmetrySearch& settings) {
  const Moments moments = surface_moments(mesh);
  const MeasuredMesh measured(mesh);
  const RotationSymmetryTest check(measured, moments.centroid, settings);
  return symmetries_by(check, moments, revolution_axes(check));
}

ShapeSymmetry find_shape_symmetry(const Mesh& mesh) {
  return find_shape_symmetry(MeasuredMesh(mesh));
}

ShapeSymmetry find_shape_symmetry(const MeasuredMesh& measured) {
  // Structured light errs by this much at 1.2 m (Nguyen et al. 2012: 0.0012 + 0.0019 (z - 0.4)^2 m).
  constexpr double kDepthNoise_m = 0.0025;
  constexpr double kMinRoundFraction = 0.7;
  SymmetrySearch settings;
  settings.min_tolerance_m = kDepthNoise_m;
  settings.max_deviation = 3.0;
  const Moments moments = surface_moments(measured.mesh);
  const RotationSymmetryTest check(measured, moments.centroid, settings);
  const std::vector<ContinuousSymmetry> round = revolution_axes(check);
  ShapeSymmetry found;
  found.symmetries = symmetries_by(check, moments, round);
  if (!found.symmetries.continuous.empty()) return found;
  double best = kMinRoundFraction;
  for (const ContinuousSymmetry& axis : round) {
    const double fraction = check.round_fraction(axis);
    if (fraction < best) continue;
    best = fraction;
    found.nearly_round = axis;
  }
  return found;
}

}  // namespace houghstream
