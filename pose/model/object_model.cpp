#include "pose/model/object_model.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/random.hpp"
#include "pipeline/geometry/renderer.hpp"

namespace houghstream {
namespace {

struct Icosahedron {
  std::array<Eigen::Vector3f, 12> corners;
  std::vector<std::array<std::size_t, 3>> faces;
};

Icosahedron icosahedron() {
  const float golden = 0.5F * (1.0F + std::sqrt(5.0F));
  Icosahedron out;
  std::size_t n = 0;
  for (const float a : {-1.0F, 1.0F}) {
    for (const float b : {-golden, golden}) {
      out.corners[n++] = Eigen::Vector3f(0.0F, a, b);
      out.corners[n++] = Eigen::Vector3f(a, b, 0.0F);
      out.corners[n++] = Eigen::Vector3f(b, 0.0F, a);
    }
  }
  const auto adjacent = [&](std::size_t i, std::size_t j) {
    return (out.corners[i] - out.corners[j]).squaredNorm() < 4.1F;  // edges have length 2
  };
  for (std::size_t i = 0; i < 12; ++i) {
    for (std::size_t j = i + 1; j < 12; ++j) {
      for (std::size_t k = j + 1; k < 12; ++k) {
        if (adjacent(i, j) && adjacent(j, k) && adjacent(i, k)) out.faces.push_back({i, j, k});
      }
    }
  }
  return out;
}

void set_bounds(ObjectModel& model) {
  model.centre = mesh_bounds(model.mesh).center();
  for (const Eigen::Vector3f& v : model.mesh.vertices) model.radius = std::max(model.radius, (v - model.centre).norm());
}

Eigen::Vector3f surface_median(const Mesh& mesh) {
  constexpr int kPoints = 2000;
  const SurfacePoints surface = sample_surface(mesh, kPoints, 1);
  Eigen::Vector3f median;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    for (const Eigen::Vector3f& point : surface.points) values.push_back(point[axis]);
    std::nth_element(values.begin(), values.begin() + kPoints / 2, values.end());
    median[axis] = values[kPoints / 2];
  }
  return median;
}

/// Camera at `distance` from the model's centre, looking at it; the turn about the optical axis does not matter.
Eigen::Isometry3d looking_from(const Eigen::Vector3f& direction, const Eigen::Vector3f& centre, double distance) {
  const Eigen::Quaterniond R_camera_object =
      Eigen::Quaterniond::FromTwoVectors(direction.cast<double>(), -Eigen::Vector3d::UnitZ());
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  T_camera_object.linear() = R_camera_object.toRotationMatrix();
  T_camera_object.translation() = Eigen::Vector3d(0.0, 0.0, distance) - R_camera_object * centre.cast<double>();
  return T_camera_object;
}

Eigen::Vector3f face_normal(const Mesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).normalized();
}

void shuffle_and_cap(ModelView& view, std::size_t most, std::uint64_t seed) {
  Random random(seed);
  const std::size_t kept = std::min(most, view.points.size());
  for (std::size_t i = 0; i < kept; ++i) {
    const std::size_t j = i + random.below(static_cast<int>(view.points.size() - i));
    std::swap(view.points[i], view.points[j]);
    std::swap(view.normals[i], view.normals[j]);
    if (!view.colours.empty()) std::swap(view.colours[i], view.colours[j]);
  }
  view.points.resize(kept);
  view.normals.resize(kept);
  view.colours.resize(std::min(kept, view.colours.size()));
}

ModelView make_view(const ObjectModel& model, const SurfaceColour& colour, const Eigen::Vector3f& direction,
                    const ModelSettings& settings) {
  const double distance = std::max(settings.view_distance_m, 3.0 * model.radius);
  const int size = settings.pixels_per_diameter + 8;
  const double focal = settings.pixels_per_diameter * distance / (2.0 * model.radius);
  const Camera camera{size, size, focal, focal, 0.5 * (size - 1), 0.5 * (size - 1)};
  const Eigen::Isometry3d T_camera_object = looking_from(direction, model.centre, distance);
  const RenderedGeometry seen = render_geometry({{&model.mesh, T_camera_object, 1}}, camera);

  ModelView view;
  view.direction = direction;
  const Eigen::Isometry3d T_object_camera = T_camera_object.inverse();
  const Eigen::Vector3f eye = T_object_camera.translation().cast<float>();
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const int triangle = seen.triangle.at<std::int32_t>(y, x);
      if (triangle < 0) continue;
      view.area += 1.0F;
      const float z = seen.depth.at<float>(y, x);
      const Eigen::Vector3f point = (T_object_camera * camera.backproject(x, y, z)).cast<float>();
      Eigen::Vector3f normal = face_normal(model.mesh, static_cast<std::size_t>(triangle));
      const float facing = normal.dot((eye - point).normalized());
      if (facing < 0.0F) normal = -normal;  // the mesh may be open, or its triangles turned
      if (!(std::abs(facing) >= settings.least_facing)) continue;
      view.points.push_back(point);
      view.normals.push_back(normal);
      if (colour.known()) {
        view.colours.push_back(colour.at(static_cast<std::size_t>(triangle), seen.bary.at<cv::Vec2f>(y, x)));
      }
    }
  }
  return view;
}

/// Of the surface's second moments: those of a triangle are A / 12 (aa' + bb' + cc' + (a+b+c)(a+b+c)').
Eigen::Matrix3f principal_axes(const Mesh& mesh) {
  double area = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d p = mesh.vertices[a].cast<double>();
    const Eigen::Vector3d q = mesh.vertices[b].cast<double>();
    const Eigen::Vector3d r = mesh.vertices[c].cast<double>();
    const double weight = 0.5 * (q - p).cross(r - p).norm();
    const Eigen::Vector3d sum = p + q + r;
    area += weight;
    mean += weight / 3.0 * sum;
    second += weight / 12.0 * (p * p.transpose() + q * q.transpose() + r * r.transpose() + sum * sum.transpose());
  }
  if (!(area > 0.0)) return Eigen::Matrix3f::Identity();
  mean /= area;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(second / area - mean * mean.transpose())
      .eigenvectors()
      .cast<float>();
}

}  // namespace

std::vector<Eigen::Vector3f> sphere_directions(int parts) {
  const Icosahedron solid = icosahedron();
  std::vector<Eigen::Vector3f> directions;
  for (const auto& [a, b, c] : solid.faces) {
    for (int i = 0; i <= parts; ++i) {
      for (int j = 0; i + j <= parts; ++j) {
        const Eigen::Vector3f point = static_cast<float>(i) * solid.corners[a] +
                                      static_cast<float>(j) * solid.corners[b] +
                                      static_cast<float>(parts - i - j) * solid.corners[c];
        const Eigen::Vector3f direction = point.normalized();
        const auto same = [&](const Eigen::Vector3f& other) { return (other - direction).squaredNorm() < 1e-6F; };
        if (std::none_of(directions.begin(), directions.end(), same)) directions.push_back(direction);
      }
    }
  }
  return directions;
}

ObjectModel make_object_model(const std::string& name, Mesh mesh, const ModelSettings& settings) {
  require(!mesh.triangles.empty() && !mesh.vertices.empty(), "model {}: {} triangles, expected a mesh", name,
          mesh.triangles.size());
  ObjectModel model;
  model.mesh = std::move(mesh);
  set_bounds(model);
  require(std::isfinite(model.radius) && model.radius > 0.001F && model.radius < 10.0F,
          "model {}: radius {} m, expected 0.001 to 10 m", name, model.radius);
  if (const auto known = settings.vote_centres.find(name); known != settings.vote_centres.end())
    model.vote_centre = known->second;
  model.middle = surface_median(model.mesh);
  model.axes = principal_axes(model.mesh);
  const SurfaceColour colour(model.mesh, 2.0 * model.radius / settings.pixels_per_diameter);
  std::uint64_t seed = 0;
  float largest = 0.0F;
  for (const Eigen::Vector3f& direction : sphere_directions(settings.views_per_edge)) {
    ModelView view = make_view(model, colour, direction, settings);
    if (view.points.empty()) continue;  // a flat model seen from its edge
    shuffle_and_cap(view, static_cast<std::size_t>(settings.points_per_view), seed++);
    largest = std::max(largest, view.area);
    model.views.push_back(std::move(view));
  }
  require(!model.views.empty(), "model {}: nothing visible from any side, expected a surface", name);
  for (ModelView& view : model.views) view.area /= largest;
  return model;
}

const ModelView& nearest_view(const ObjectModel& model, const Eigen::Isometry3d& T_camera_object) {
  const Eigen::Vector3d eye = -(T_camera_object.linear().transpose() * T_camera_object.translation());
  const Eigen::Vector3f direction = eye.cast<float>() - model.centre;
  const ModelView* best = &model.views.front();
  float best_along = best->direction.dot(direction);
  for (const ModelView& view : model.views) {
    const float along = view.direction.dot(direction);
    if (!(along > best_along)) continue;
    best = &view;
    best_along = along;
  }
  return *best;
}

}  // namespace houghstream
