#include "tools/teach/mesh/lookalikes.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "pose/model/mesh_bvh.hpp"
#include "pose/model/surface_colour.hpp"

namespace houghstream::teach {
namespace {

constexpr int kPoints = 400;
constexpr float kMaxScale = 1.25F;
constexpr float kSpreadTolerance = 0.08F;  // tolerance over the spread along each principal axis
constexpr float kTolerance = 0.02F;        // mean distance between the surfaces, of the diameter
constexpr int kFirstLook = 50;             // points that rule most ways out
constexpr int kRotations = 36;
constexpr double kDetail_m = 0.005;       // finer texture does not count
constexpr float kColourDistance = 30.0F;  // distance in L*a*b* of 8 bits: the same texture in another light
constexpr float kMinAlike = 0.75F;        // share of the surface whose colours agree
constexpr double kMinConfused = 0.05;     // share of an object's views in practice in which another is reported there
constexpr int kMinConfusions = 3;         // fewer may be chance

/// A mesh as it is compared.
struct Shape {
  explicit Shape(const Mesh& mesh) : tree(mesh), colour(mesh, kDetail_m) {
    points = sample_surface(mesh, kPoints, 1).points;
    for (const Eigen::Vector3f& point : points) centre += point / static_cast<float>(points.size());
    Eigen::Matrix3f covariance = Eigen::Matrix3f::Zero();
    for (Eigen::Vector3f& point : points) {
      point -= centre;
      covariance += point * point.transpose() / static_cast<float>(points.size());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver(covariance);
    axes = solver.eigenvectors();
    spread = solver.eigenvalues().cwiseMax(0.0F).cwiseSqrt();
    diameter = static_cast<float>(mesh_diameter(mesh));
    if (!colour.has_colour()) return;
    for (const Eigen::Vector3f& point : points) colours.push_back(colour_at(point));
  }

  ClosestPoint nearest(const Eigen::Vector3f& about_centre) const { return tree.nearest(about_centre + centre); }
  LabColour colour_at(const Eigen::Vector3f& about_centre) const {
    const ClosestPoint hit = nearest(about_centre);
    return colour.at(hit.triangle, {hit.weights[1], hit.weights[2]});
  }

  MeshBvh tree;
  SurfaceColour colour;
  std::vector<Eigen::Vector3f> points;  ///< about the centre
  std::vector<LabColour> colours;       ///< one per point; none for a mesh without colours
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();
  Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();  ///< columns, least spread first
  Eigen::Vector3f spread = Eigen::Vector3f::Zero();    ///< metres
  float diameter = 0.0F;
};

float mean_distance(const Shape& from, const Eigen::Matrix3f& map, const Shape& to, int count) {
  float sum = 0.0F;
  for (int i = 0; i < count; ++i) sum += to.nearest(map * from.points[static_cast<std::size_t>(i)]).distance;
  return sum / static_cast<float>(count);
}

bool may_be_same_shape(const Shape& one, const Eigen::Matrix3f& map, const Shape& other) {
  return mean_distance(one, map, other, kFirstLook) < 1.5F * kTolerance * other.diameter;
}

/// Compares both ways, since a part of a shape is not the shape.
bool same_shape(const Shape& one, const Eigen::Matrix3f& map, const Shape& other) {
  const float allowed = kTolerance * other.diameter;
  const Eigen::Matrix3f back = map.inverse();
  return mean_distance(one, map, other, kPoints) < allowed &&
         mean_distance(other, back, one, kPoints) < allowed * one.diameter / other.diameter;
}

/// Stops when too many points differ, whatever the others have.
bool same_colours(const Shape& one, const Eigen::Matrix3f& map, const Shape& other) {
  if (one.colours.empty() || other.colours.empty()) return true;
  const std::size_t count = one.points.size();
  std::size_t can_be_alike = count;
  for (std::size_t i = 0; i < count; ++i) {
    const LabColour a = one.colours[i];
    const LabColour b = other.colour_at(map * one.points[i]);
    float difference_sq = 0.0F;
    for (std::size_t k = 0; k < a.size(); ++k)
      difference_sq += std::pow(static_cast<float>(a[k]) - static_cast<float>(b[k]), 2.0F);
    if (difference_sq < kColourDistance * kColourDistance) continue;
    --can_be_alike;
    if (static_cast<float>(can_be_alike) < kMinAlike * static_cast<float>(count)) return false;
  }
  return true;
}

/// Returns all ways to lay three axes on three axes: 48, half of them mirrored.
std::vector<Eigen::Matrix3f> axis_maps() {
  std::vector<Eigen::Matrix3f> maps;
  std::array<int, 3> order = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3f map = Eigen::Matrix3f::Zero();
      for (int k = 0; k < 3; ++k) map(order[static_cast<std::size_t>(k)], k) = (signs >> k & 1) != 0 ? -1.0F : 1.0F;
      maps.push_back(map);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return maps;
}

std::optional<Lookalike> compare(const Shape& one, const Shape& other) {
  const float scale = other.spread.norm() / one.spread.norm();
  if (scale > kMaxScale || scale < 1.0F / kMaxScale) return std::nullopt;
  const Eigen::Vector3f off = (scale * one.spread - other.spread).cwiseAbs();
  if (off.maxCoeff() > kSpreadTolerance * other.spread.maxCoeff()) return std::nullopt;
  std::optional<Lookalike> mirrored;
  for (const Eigen::Matrix3f& along : axis_maps()) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int angle = axis == 0 ? 0 : 1; angle < kRotations; ++angle) {
        const Eigen::AngleAxisf about(2.0F * static_cast<float>(M_PI) * static_cast<float>(angle) / kRotations,
                                      Eigen::Vector3f::Unit(axis));
        const Eigen::Matrix3f map = scale * other.axes * about.toRotationMatrix() * along * one.axes.transpose();
        const bool is_mirror = map.determinant() < 0.0F;
        if (is_mirror && mirrored) continue;
        // Round objects agree in shape under each of the maps, and nearly all of them differ in colours: these come
        // before the costly comparison.
        if (!may_be_same_shape(one, map, other) || !same_colours(one, map, other) || !same_shape(one, map, other))
          continue;
        Lookalike found{"", "", is_mirror, static_cast<double>(scale)};
        if (!is_mirror) return found;
        mirrored = found;
      }
    }
  }
  return mirrored;
}

/// Returns how often `other` was reported in the place of the object, in words; empty where that was rare.
std::string confusion_words(const store::StoredObject& object, const std::string& other) {
  if (!object.practice || object.practice->shown == 0) return {};
  const auto taken = object.practice->taken_for.find(other);
  const int times = taken != object.practice->taken_for.end() ? taken->second : 0;
  const double fraction = static_cast<double>(times) / object.practice->shown;
  if (times < kMinConfusions || fraction < kMinConfused) return {};
  return fmt::format("'{}' is detected in the place of '{}' in {:.0f} % of {} views", other, object.name,
                     100.0 * fraction, object.practice->shown);
}

}  // namespace

std::vector<Lookalike> find_lookalikes(const std::vector<NamedMesh>& meshes) {
  std::vector<std::unique_ptr<Shape>> shapes;
  shapes.reserve(meshes.size());
  for (const auto& [name, mesh] : meshes) shapes.push_back(std::make_unique<Shape>(*mesh));
  std::vector<Lookalike> pairs;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (std::size_t j = i + 1; j < shapes.size(); ++j) {
      std::optional<Lookalike> found = compare(*shapes[i], *shapes[j]);
      if (!found) continue;
      found->one = meshes[i].first;
      found->other = meshes[j].first;
      pairs.push_back(*found);
    }
  }
  return pairs;
}

std::string describe(const Lookalike& pair) {
  constexpr double kSameSize = 0.03;
  std::string how = pair.mirrored ? "the one is the other's mirror image" : "of the same shape";
  if (std::abs(pair.scale - 1.0) > kSameSize)
    how += fmt::format(", '{}' {:.2f} times as large", pair.other, pair.scale);
  return fmt::format("'{}' and '{}' can hardly be told apart: {}, with colours alike or unknown", pair.one, pair.other,
                     how);
}

std::vector<std::string> confusion_lines(const store::ObjectStore& store) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < store.objects.size(); ++i) {
    for (std::size_t j = i + 1; j < store.objects.size(); ++j) {
      const std::string& one = store.objects[i].name;
      const std::string& other = store.objects[j].name;
      const std::string there = confusion_words(store.objects[i], other);
      const std::string back = confusion_words(store.objects[j], one);
      if (there.empty() && back.empty()) continue;
      lines.push_back(fmt::format("'{}' and '{}' can hardly be told apart: in practice {}{}{}", one, other, there,
                                  there.empty() || back.empty() ? "" : ", and ", back));
    }
  }
  return lines;
}

}  // namespace houghstream::teach
