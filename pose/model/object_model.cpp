#include "pose/model/object_model.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/base/random.hpp"
#include "pipeline/geometry/renderer.hpp"
#include "pose/model/symmetry.hpp"
#include "pose/model/symmetry_search.hpp"

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

/// Returns the pose of a camera at `distance` from the model's centre that looks at it. The rotation about the optical
/// axis does not matter.
Eigen::Isometry3d looking_from(const Eigen::Vector3f& direction, const Eigen::Vector3f& centre, double distance) {
  const Eigen::Quaterniond R_camera_object =
      Eigen::Quaterniond::FromTwoVectors(direction.cast<double>(), -Eigen::Vector3d::UnitZ());
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  T_camera_object.linear() = R_camera_object.toRotationMatrix();
  T_camera_object.translation() = Eigen::Vector3d(0.0, 0.0, distance) - R_camera_object * centre.cast<double>();
  return T_camera_object;
}

/// Holds a visible surface point of a view, with where it lies in its triangle.
struct SeenPoint {
  Eigen::Vector3f point;
  Eigen::Vector3f normal;
  std::size_t triangle = 0;
  cv::Vec2f bary;  // weights of the triangle's second and third vertex
};

std::vector<Eigen::Vector3f> face_normals(const Mesh& mesh) {
  std::vector<Eigen::Vector3f> normals;
  normals.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3f& origin = mesh.vertices[a];
    normals.emplace_back((mesh.vertices[b] - origin).cross(mesh.vertices[c] - origin).normalized());
  }
  return normals;
}

/// Makes the views of a model. Several threads may use it at once.
class ViewMaker {
 public:
  ViewMaker(const ObjectModel& model, const ModelSettings& settings)
      : model_(model),
        settings_(settings),
        colour_(model.mesh, 2.0 * model.radius / settings.pixels_per_diameter),
        face_normals_(face_normals(model.mesh)) {}

  /// Makes the view from a direction, with at most ModelSettings::points_per_view of the visible points, in random
  /// order.
  ModelView make(const Eigen::Vector3f& direction, std::uint64_t seed) const;

  /// Adds the colours of all that is visible from one direction.
  void add_texture(const Eigen::Vector3f& direction, SurfaceTextureBuilder& texture) const;

  bool has_colours() const { return colour_.has_colour(); }

 private:
  std::vector<SeenPoint> seen_from(const Eigen::Vector3f& direction, float& area_px) const;

  const ObjectModel& model_;
  const ModelSettings& settings_;
  SurfaceColour colour_;
  std::vector<Eigen::Vector3f> face_normals_;
};

/// Returns all visible points, row by row, and their silhouette's area.
std::vector<SeenPoint> ViewMaker::seen_from(const Eigen::Vector3f& direction, float& area_px) const {
  const double distance = std::max(settings_.view_distance_m, 3.0 * model_.radius);
  const int size = settings_.pixels_per_diameter + 8;
  const double focal = settings_.pixels_per_diameter * distance / (2.0 * model_.radius);
  const Camera camera{size, size, focal, focal, 0.5 * (size - 1), 0.5 * (size - 1)};
  const Eigen::Isometry3d T_camera_object = looking_from(direction, model_.centre, distance);
  const RenderedGeometry rendered = render_geometry({{&model_.mesh, T_camera_object, 1}}, camera);

  std::vector<SeenPoint> seen;
  const Eigen::Isometry3d T_object_camera = T_camera_object.inverse();
  const Eigen::Vector3f eye = T_object_camera.translation().cast<float>();
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const int triangle = rendered.triangle.at<std::int32_t>(y, x);
      if (triangle < 0) continue;
      area_px += 1.0F;
      const float z = rendered.depth.at<float>(y, x);
      const Eigen::Vector3f point = (T_object_camera * camera.backproject(x, y, z)).cast<float>();
      Eigen::Vector3f normal = face_normals_[static_cast<std::size_t>(triangle)];
      const float facing = normal.dot((eye - point).normalized());
      if (facing < 0.0F) normal = -normal;  // the mesh may be open, or its triangles reversed
      if (!(std::abs(facing) >= settings_.min_facing)) continue;
      seen.push_back({point, normal, static_cast<std::size_t>(triangle), rendered.bary.at<cv::Vec2f>(y, x)});
    }
  }
  return seen;
}

ModelView ViewMaker::make(const Eigen::Vector3f& direction, std::uint64_t seed) const {
  ModelView view;
  view.direction = direction;
  std::vector<SeenPoint> seen = seen_from(direction, view.area);
  Random random(seed);
  const std::size_t kept = std::min(static_cast<std::size_t>(settings_.points_per_view), seen.size());
  for (std::size_t i = 0; i < kept; ++i) {
    std::swap(seen[i], seen[i + random.below(static_cast<int>(seen.size() - i))]);
    view.points.push_back(seen[i].point);
    view.normals.push_back(seen[i].normal);
    if (colour_.has_colour()) view.colours.push_back(colour_.at(seen[i].triangle, seen[i].bary));
  }
  return view;
}

void ViewMaker::add_texture(const Eigen::Vector3f& direction, SurfaceTextureBuilder& texture) const {
  float area_px = 0.0F;
  for (const SeenPoint& seen : seen_from(direction, area_px))
    texture.add(seen.point, seen.normal, colour_.at(seen.triangle, seen.bary));
}

/// Makes the colours by position. Views from fewer directions than the model has suffice here: they see the whole
/// surface, and all visible points are kept.
SurfaceTexture make_surface_texture(const ViewMaker& maker, double detail_m) {
  constexpr int kParts = 2;
  if (!maker.has_colours()) return {};
  SurfaceTextureBuilder texture(detail_m);
  for (const Eigen::Vector3f& direction : sphere_directions(kParts)) maker.add_texture(direction, texture);
  return texture.make();
}

/// Makes views from the directions in which some of the surface is visible.
std::vector<ModelView> make_views(const ViewMaker& maker, const ModelSettings& settings, int threads) {
  const std::vector<Eigen::Vector3f> directions = sphere_directions(settings.views_per_edge);
  std::vector<ModelView> made(directions.size());
  parallel_for(threads, static_cast<int>(made.size()), [&](int i) {
    made[static_cast<std::size_t>(i)] =
        maker.make(directions[static_cast<std::size_t>(i)], static_cast<std::uint64_t>(i));
  });
  std::vector<ModelView> views;
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (made[i].points.empty()) continue;  // a flat model seen from its edge: those that follow move up
    views.push_back(views.size() == i ? std::move(made[i]) : maker.make(directions[i], views.size()));
  }
  return views;
}

/// Returns the maximum displacement of a point of the surface by a motion, over the motions that look the same.
double moved_by(const Eigen::Isometry3d& motion, const std::vector<Eigen::Vector3f>& points,
                const std::vector<Eigen::Isometry3d>& same) {
  double minimum = std::numeric_limits<double>::infinity();
  for (const Eigen::Isometry3d& symmetry : same) {
    double farthest = 0.0;
    for (const Eigen::Vector3f& point : points) {
      const Eigen::Vector3d at = point.cast<double>();
      farthest = std::max(farthest, (motion * at - symmetry * at).norm());
    }
    minimum = std::min(minimum, farthest);
  }
  return minimum;
}

/// Returns quarter and half turns about the principal axes after which the shape is nearly as before, and all their
/// products: a pose of a nearly square box that is wrong by a quarter turn converges to where depth supports it.
std::vector<Eigen::Isometry3d> near_symmetries(const MeasuredMesh& measured, const ObjectModel& model) {
  SymmetrySearch search;
  search.tolerance = 0.1;  // diameters, with which BOP finds candidates (Hodan et al. 2020)
  const RotationSymmetryTest check(measured, model.surface_median.cast<double>(), search);
  std::vector<Eigen::Isometry3d> rotations;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = model.axes.col(i).cast<double>();
    for (const double angle : {0.5 * M_PI, M_PI}) {
      if (!check.is_symmetric_under(axis, angle)) continue;
      rotations.push_back(check.rotation_about_axis(axis, angle));
      break;
    }
  }
  return group_of(rotations);
}

/// Returns points of the surface that most rotations about the axis take off it: a mug's handle.
SurfacePoints find_unround_points(const MeasuredMesh& measured, const ContinuousSymmetry& axis) {
  constexpr int kPoints = 1500;
  constexpr int kRotations = 7;
  constexpr float kOff = 0.04F;  // diameters
  const float off_m = kOff * static_cast<float>(measured.diameter_m);
  const SurfacePoints surface = sample_surface(measured.mesh, kPoints, 2);
  SurfacePoints unround;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const Eigen::Vector3f& point = surface.points[i];
    int off = 0;
    for (int k = 1; k <= kRotations; ++k) {
      const Eigen::AngleAxisd rotation(2.0 * M_PI * k / (kRotations + 1), axis.axis);
      const Eigen::Vector3d at = axis.offset + rotation * (point.cast<double>() - axis.offset);
      off += measured.tree.nearest(at.cast<float>()).distance > off_m ? 1 : 0;
    }
    if (2 * off <= kRotations) continue;
    unround.points.push_back(point);
    unround.normals.push_back(surface.normals[i]);
  }
  return unround;
}

/// Returns whether a part of the surface has the colours of the views, in the mean.
bool has_colours_of_views(const ObjectModel& model, const SurfacePoints& part) {
  constexpr float kMaxDifference = 25.0F;  // 8-bit CIE L*a*b*: one paint in another shade
  Eigen::Vector3f part_sum = Eigen::Vector3f::Zero();
  float part_count = 0.0F;
  for (std::size_t i = 0; i < part.points.size(); ++i) {
    const std::optional<Eigen::Vector3f> colour = model.texture.find(part.points[i], part.normals[i]);
    if (!colour) continue;
    part_sum += *colour;
    ++part_count;
  }
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float count = 0.0F;
  for (const ModelView& view : model.views) {
    for (const LabColour& colour : view.colours) {
      sum += Eigen::Vector3f(colour[0], colour[1], colour[2]);
      ++count;
    }
  }
  return part_count > 0.0F && count > 0.0F && (part_sum / part_count - sum / count).norm() < kMaxDifference;
}

void set_alternatives(const MeasuredMesh& measured, const Symmetries& same_appearance, double right_within,
                      ObjectModel& model) {
  constexpr double kShapeStep = 0.13;  // diameters: turns of about 15 degrees
  constexpr double kSameStep = 0.02;
  constexpr double kSame_rad = 0.17;
  constexpr int kPoints = 300;
  const std::vector<Eigen::Isometry3d> same = expand_symmetries(same_appearance, kSameStep);
  const std::vector<Eigen::Vector3f> points = sample_surface(model.mesh, kPoints, 1).points;
  const double right_m = right_within * measured.diameter_m;
  const auto add_others = [&](const std::vector<Eigen::Isometry3d>& motions, std::vector<Eigen::Isometry3d>& list) {
    for (const Eigen::Isometry3d& motion : motions) {
      if (moved_by(motion, points, same) > right_m && !is_near_any(motion, model.alternatives, kSame_rad))
        list.push_back(motion);
    }
  };
  std::vector<Eigen::Isometry3d> exact;
  add_others(expand_symmetries(model.shape_symmetries, kShapeStep), exact);
  model.alternatives = std::move(exact);
  add_others(near_symmetries(measured, model), model.near_alternatives);
  if (!model.nearly_round) return;
  add_others(expand_symmetries({{}, {*model.nearly_round}}, kShapeStep), model.partial_alternatives);
  SurfacePoints unround = find_unround_points(measured, *model.nearly_round);
  model.is_unround_alike = has_colours_of_views(model, unround);
  model.unround_points = std::move(unround.points);
  model.unround_normals = std::move(unround.normals);
}

/// Accumulates the surface's second moments: those of a triangle are A / 12 (aa' + bb' + cc' + (a+b+c)(a+b+c)').
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

void set_thickness(ObjectModel& model) {
  model.thickness = std::numeric_limits<float>::infinity();
  for (int i = 0; i < 3; ++i) {
    float low = std::numeric_limits<float>::infinity();
    float high = -low;
    for (const Eigen::Vector3f& vertex : model.mesh.vertices) {
      const float along = model.axes.col(i).dot(vertex);
      low = std::min(low, along);
      high = std::max(high, along);
    }
    if (!(high - low < model.thickness)) continue;
    model.thickness = high - low;
    model.thin_axis = i;
  }
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

ObjectModel make_object_model(const std::string& name, Mesh mesh, const ModelSettings& settings, int threads) {
  require(!mesh.triangles.empty() && !mesh.vertices.empty(), "model {}: {} triangles, expected a mesh", name,
          mesh.triangles.size());
  ObjectModel model;
  model.mesh = std::move(mesh);
  set_bounds(model);
  require(std::isfinite(model.radius) && model.radius > 0.001F && model.radius < 10.0F,
          "model {}: radius {} m, expected 0.001 to 10 m", name, model.radius);
  if (const auto known = settings.vote_centres.find(name); known != settings.vote_centres.end())
    model.vote_centre = known->second;
  model.surface_median = surface_median(model.mesh);
  model.axes = principal_axes(model.mesh);
  set_thickness(model);
  const MeasuredMesh measured(model.mesh);
  const auto shape = settings.shape_symmetries.find(name);
  const ShapeSymmetry symmetry =
      shape != settings.shape_symmetries.end() ? shape->second : find_shape_symmetry(measured);
  model.shape_symmetries = symmetry.symmetries;
  model.nearly_round = symmetry.nearly_round;
  const ViewMaker maker(model, settings);
  model.views = make_views(maker, settings, threads);
  require(!model.views.empty(), "model {}: nothing visible from any side, expected a surface", name);
  float largest = 0.0F;
  for (const ModelView& view : model.views) largest = std::max(largest, view.area);
  for (ModelView& view : model.views) view.area /= largest;
  model.texture = make_surface_texture(maker, 2.0 * static_cast<double>(model.radius) / settings.pixels_per_diameter);
  const auto same_appearance = settings.symmetries.find(name);
  set_alternatives(measured, same_appearance != settings.symmetries.end() ? same_appearance->second : Symmetries(),
                   settings.right_within, model);
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
