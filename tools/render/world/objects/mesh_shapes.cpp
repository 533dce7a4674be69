#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"

namespace houghstream {
namespace {

void add_corner(Mesh& mesh, const Eigen::Vector3d& position, const Eigen::Vector2d& uv) {
  mesh.vertices.push_back(position.cast<float>());
  mesh.uvs.push_back(uv.cast<float>());
}

// The flat front (y < 0) or back of a prism, as a fan round its first corner.
Mesh prism_end(const std::vector<Eigen::Vector2d>& outline, double y, const cv::Mat& texture) {
  Eigen::AlignedBox2d bounds;
  for (const Eigen::Vector2d& point : outline) bounds.extend(point);
  Mesh mesh;
  for (const Eigen::Vector2d& point : outline) {
    const Eigen::Vector2d share = (point - bounds.min()).cwiseQuotient(bounds.sizes());
    add_corner(mesh, {point.x(), y, point.y()}, {y < 0.0 ? share.x() : 1.0 - share.x(), 1.0 - share.y()});
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

// The texture stands upright on sides that rise, and on those that fall.
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

}  // namespace houghstream
