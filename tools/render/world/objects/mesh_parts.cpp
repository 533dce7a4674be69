#include "tools/render/world/objects/mesh_parts.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/base/checks.hpp"

namespace houghstream::world {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

void add_triangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const auto& v = mesh.vertices;
  const Eigen::Vector3f normal = (v[b] - v[a]).cross(v[c] - v[a]);
  if (normal.squaredNorm() > 1e-20F) mesh.triangles.push_back(Triangle{a, b, c});
}

// Rings of `columns` vertices, one after the other, become a skin.
void skin_rings(Mesh& mesh, std::size_t rings, std::size_t columns) {
  for (std::size_t i = 0; i + 1 < rings; ++i) {
    for (std::size_t j = 0; j + 1 < columns; ++j) {
      const auto a = static_cast<std::uint32_t>(i * columns + j);
      const auto b = static_cast<std::uint32_t>(a + columns);
      add_triangle(mesh, a, a + 1, b + 1);
      add_triangle(mesh, a, b + 1, b);
    }
  }
}

// First and last column are the same line in space with different texture columns.
void join_seam_normals(Mesh& mesh, std::size_t rings, std::size_t columns) {
  for (std::size_t i = 0; i < rings; ++i) {
    Eigen::Vector3f& first = mesh.normals[i * columns];
    Eigen::Vector3f& last = mesh.normals[(i + 1) * columns - 1];
    first = (first + last).normalized();
    last = first;
  }
}

void add_quad(Mesh& mesh, const std::array<Eigen::Vector3f, 4>& corners) {
  const std::array<Eigen::Vector2f, 4> uvs = {Eigen::Vector2f(0, 1), {1, 1}, {1, 0}, {0, 0}};
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  mesh.uvs.insert(mesh.uvs.end(), uvs.begin(), uvs.end());
  add_triangle(mesh, first, first + 1, first + 2);
  add_triangle(mesh, first, first + 2, first + 3);
}

Mesh quad(const std::array<Eigen::Vector3f, 4>& corners, const cv::Mat& texture) {
  Mesh mesh;
  add_quad(mesh, corners);
  mesh.texture = texture;
  compute_normals(mesh);
  return mesh;
}

void add_corner(Mesh& mesh, const Eigen::Vector3d& position, const Eigen::Vector2d& uv) {
  mesh.vertices.push_back(position.cast<float>());
  mesh.uvs.push_back(uv.cast<float>());
}

// Makes the flat front (y < 0) or back of a prism, as a fan round its first corner.
Mesh prism_end(const std::vector<Eigen::Vector2d>& outline, double y, const cv::Mat& texture) {
  Eigen::AlignedBox2d bounds;
  for (const Eigen::Vector2d& point : outline) bounds.extend(point);
  Mesh mesh;
  for (const Eigen::Vector2d& point : outline) {
    const Eigen::Vector2d fraction = (point - bounds.min()).cwiseQuotient(bounds.sizes());
    add_corner(mesh, {point.x(), y, point.y()}, {y < 0.0 ? fraction.x() : 1.0 - fraction.x(), 1.0 - fraction.y()});
  }
  for (std::uint32_t i = 1; i + 1 < outline.size(); ++i) {
    if (y < 0.0)
      mesh.triangles.push_back({0, i, i + 1});
    else
      mesh.triangles.push_back({0, i + 1, i});
  }
  mesh.texture = texture;
  compute_normals(mesh);
  return mesh;
}

// Makes a side of a prism; its texture is upright on sides that rise, and on those that fall.
Mesh prism_side(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double half, const cv::Mat& texture) {
  Mesh mesh;
  const double low = from.y() > to.y() ? 0.0 : 1.0;
  const double high = 1.0 - low;
  add_corner(mesh, {from.x(), -half, from.y()}, {high, low});
  add_corner(mesh, {from.x(), half, from.y()}, {low, low});
  add_corner(mesh, {to.x(), half, to.y()}, {low, high});
  add_corner(mesh, {to.x(), -half, to.y()}, {high, high});
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.texture = texture;
  compute_normals(mesh);
  return mesh;
}

}  // namespace

Mesh lathe(const std::vector<ProfilePoint>& profile, const cv::Mat& texture, int segments) {
  Mesh mesh;
  const auto columns = static_cast<std::size_t>(segments) + 1;
  for (const ProfilePoint& point : profile) {
    for (std::size_t j = 0; j < columns; ++j) {
      // The seam's two columns must meet exactly, so the last one uses the first one's angle.
      const double angle = 2.0 * M_PI * static_cast<double>(j % static_cast<std::size_t>(segments)) / segments;
      mesh.vertices.push_back(
          Eigen::Vector3d(point.radius * std::cos(angle), point.radius * std::sin(angle), point.z).cast<float>());
      mesh.uvs.emplace_back(static_cast<float>(static_cast<double>(j) / segments), static_cast<float>(point.v));
    }
  }
  skin_rings(mesh, profile.size(), columns);
  mesh.texture = texture;
  compute_normals(mesh);
  join_seam_normals(mesh, profile.size(), columns);
  return mesh;
}

std::vector<ProfilePoint> with_arc_length(std::vector<ProfilePoint> profile, double v_start, double v_end) {
  std::vector<double> length(profile.size(), 0.0);
  for (std::size_t i = 1; i < profile.size(); ++i) {
    length[i] = length[i - 1] + std::hypot(profile[i].radius - profile[i - 1].radius, profile[i].z - profile[i - 1].z);
  }
  for (std::size_t i = 0; i < profile.size(); ++i) {
    profile[i].v = v_start + (v_end - v_start) * length[i] / length.back();
  }
  return profile;
}

Mesh box(const Eigen::Vector3d& size, const BoxFaces& faces) {
  const Eigen::Vector3f h = 0.5F * size.cast<float>();
  const auto corner = [&h](int x, int y, int z) {
    return h.cwiseProduct(Eigen::Vector3i(x, y, z).cast<float>()).eval();
  };
  const auto face = [&faces](const cv::Mat& texture) { return texture.empty() ? faces.front : texture; };
  std::vector<Part> parts;
  const auto add = [&](const std::array<Eigen::Vector3f, 4>& corners, const cv::Mat& texture) {
    parts.push_back({quad(corners, face(texture)), Eigen::Isometry3d::Identity()});
  };
  add({corner(-1, -1, -1), corner(1, -1, -1), corner(1, -1, 1), corner(-1, -1, 1)}, faces.front);
  add({corner(1, 1, -1), corner(-1, 1, -1), corner(-1, 1, 1), corner(1, 1, 1)}, faces.back);
  add({corner(-1, 1, -1), corner(-1, -1, -1), corner(-1, -1, 1), corner(-1, 1, 1)}, faces.left);
  add({corner(1, -1, -1), corner(1, 1, -1), corner(1, 1, 1), corner(1, -1, 1)}, faces.right);
  add({corner(-1, -1, 1), corner(1, -1, 1), corner(1, 1, 1), corner(-1, 1, 1)}, faces.top);
  add({corner(-1, 1, -1), corner(1, 1, -1), corner(1, -1, -1), corner(-1, -1, -1)}, faces.bottom);
  return compose(parts);
}

Mesh box(const Eigen::Vector3d& size, const cv::Mat& texture) {
  BoxFaces faces;
  faces.front = texture;
  return box(size, faces);
}

Mesh tube(const std::vector<Eigen::Vector3d>& path, double radius, const cv::Mat& texture, int segments) {
  return tapered_tube(path, std::vector<double>(path.size(), radius), texture, segments);
}

Mesh tapered_tube(const std::vector<Eigen::Vector3d>& path, const std::vector<double>& radii, const cv::Mat& texture,
                  int segments) {
  require(path.size() >= 2, "tube: path of {} points, expected at least 2", path.size());
  require(radii.size() == path.size(), "tube: {} radii for {} points", radii.size(), path.size());
  Mesh mesh;
  const auto columns = static_cast<std::size_t>(segments) + 1;
  const Eigen::Vector3d start_direction = (path[1] - path[0]).normalized();
  Eigen::Vector3d side = start_direction.unitOrthogonal();
  const auto add_ring = [&](const Eigen::Vector3d& centre, const Eigen::Vector3d& direction, double r, double v) {
    side = (side - direction * direction.dot(side)).normalized();  // carried along without twist
    const Eigen::Vector3d other = direction.cross(side);
    for (std::size_t j = 0; j < columns; ++j) {
      const double angle = 2.0 * M_PI * static_cast<double>(j % static_cast<std::size_t>(segments)) / segments;
      mesh.vertices.push_back((centre + r * (std::cos(angle) * side + std::sin(angle) * other)).cast<float>());
      mesh.uvs.emplace_back(static_cast<float>(static_cast<double>(j) / segments), static_cast<float>(v));
    }
  };
  for (std::size_t i = 0; i < path.size(); ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, path.size() - 1);
    const Eigen::Vector3d direction = (path[after] - path[before]).normalized();
    const double v = static_cast<double>(i) / static_cast<double>(path.size() - 1);
    if (i == 0) {
      add_ring(path[i], direction, 0.0, v);
      add_ring(path[i], direction, radii[i], v);
    }
    add_ring(path[i], direction, radii[i], v);
    if (i + 1 == path.size()) {
      add_ring(path[i], direction, radii[i], v);
      add_ring(path[i], direction, 0.0, v);
    }
  }
  const std::size_t rings = path.size() + 4;
  skin_rings(mesh, rings, columns);
  mesh.texture = texture;
  compute_normals(mesh);
  join_seam_normals(mesh, rings, columns);
  return mesh;
}

Part at(Mesh mesh, const Eigen::Vector3d& translation, double yaw_rad) {
  Part part{std::move(mesh), Eigen::Isometry3d::Identity()};
  part.T_object_part.translate(translation);
  part.T_object_part.rotate(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
  return part;
}

Mesh prism(const std::vector<Eigen::Vector2d>& outline, double depth, const cv::Mat& ends, const cv::Mat& side) {
  require(outline.size() >= 3, "prism: outline of {} points, expected at least 3", outline.size());
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Part> parts = {at(prism_end(outline, -0.5 * depth, ends), origin),
                             at(prism_end(outline, 0.5 * depth, ends), origin)};
  for (std::size_t i = 0; i < outline.size(); ++i)
    parts.push_back(at(prism_side(outline[i], outline[(i + 1) % outline.size()], 0.5 * depth, side), origin));
  return compose(parts);
}

Mesh scaled(Mesh mesh, const Eigen::Vector3d& factors) {
  const Eigen::Vector3f stretch = factors.cast<float>();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = vertex.cwiseProduct(stretch);
  for (Eigen::Vector3f& normal : mesh.normals) normal = normal.cwiseQuotient(stretch).normalized();
  return mesh;
}

}  // namespace houghstream::world
