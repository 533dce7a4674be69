#include "pipeline/geometry/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/no_value.hpp"
#include "pipeline/geometry/raster_edge.hpp"

// Scan conversion uses exact edges (raster_edge.hpp), one span per row. Depth comes from the plane of the unsnapped
// triangle: with n = (V1 - V0) x (V2 - V0), 1/z = n.r / n.V0 along the ray r.

namespace houghstream {
namespace {

constexpr double kNear = 0.05;          // metres
constexpr double kSnapLimit = 1 << 29;  // keeps products of two coordinates within 64 bits

struct ClipVertex {
  Eigen::Vector3d position;
  Snapped snapped;

  bool in_front() const { return position.z() >= kNear; }
};

/// Returns the point relative to the first pixel of a part of the image.
Snapped snap(const Camera& camera, const cv::Point& first_px, const Eigen::Vector3d& point) {
  constexpr double kRounding = kSnapLimit + 0.5;
  const auto fixed = [](double px) {
    const double scaled = px * kSubpixels;
    const double limited = scaled > -kSnapLimit ? std::min(scaled, kSnapLimit) : -kSnapLimit;  // NaN too
    return static_cast<std::int64_t>(limited + kRounding) - static_cast<std::int64_t>(kSnapLimit);
  };
  const Eigen::Vector2d pixel = camera.project(point);
  return {fixed(pixel.x()) - kSubpixels * first_px.x, fixed(pixel.y()) - kSubpixels * first_px.y};
}

void place_vertices(const RenderItem& item, const Camera& camera, const cv::Point& first_px,
                    std::vector<ClipVertex>& vertices) {
  require(item.mesh != nullptr, "render item without a mesh");
  vertices.resize(item.mesh->vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i].position = item.T_camera_object * item.mesh->vertices[i].cast<double>();
    if (vertices[i].in_front()) vertices[i].snapped = snap(camera, first_px, vertices[i].position);
  }
}

/// Returns the pixels of an axis with `size` pixels whose centres lie within these snapped bounds: the first and one
/// past the last.
std::array<int, 2> covered_pixels(std::int64_t low, std::int64_t high, int size) {
  const std::int64_t first = std::clamp<std::int64_t>((low + kSubpixels - 1) >> kSubpixelBits, 0, size);
  const std::int64_t end = std::clamp<std::int64_t>((high >> kSubpixelBits) + 1, first, size);
  return {static_cast<int>(first), static_cast<int>(end)};
}

/// Returns the pixels that triangles of these vertices may cover, which are snapped on the whole image.
cv::Rect covered_part(const std::vector<ClipVertex>& vertices, const Camera& camera) {
  if (vertices.empty()) return {};
  Snapped low = vertices.front().snapped;
  Snapped high = low;
  for (const ClipVertex& vertex : vertices) {
    if (!vertex.in_front()) return {0, 0, camera.width, camera.height};
    low = {std::min(low.x, vertex.snapped.x), std::min(low.y, vertex.snapped.y)};
    high = {std::max(high.x, vertex.snapped.x), std::max(high.y, vertex.snapped.y)};
  }
  const auto [left, right] = covered_pixels(low.x, high.x, camera.width);
  const auto [top, bottom] = covered_pixels(low.y, high.y, camera.height);
  return {left, top, right - left, bottom - top};
}

/// Coefficients of a triangle, whose dot products with a pixel's ray give the pixel's values.
struct Surface {
  Eigen::Vector3d second = Eigen::Vector3d::Zero();  // weight of the 2nd vertex, divided by z
  Eigen::Vector3d third = Eigen::Vector3d::Zero();
  std::int32_t triangle = -1;
  std::uint16_t id = 0;
};

/// The triangle that is being drawn. Most of a dense mesh cover no pixel's centre, or are hidden: what those need not
/// have is made when the first pixel asks for it.
struct Triangle {
  std::array<const ClipVertex*, 3> corners{};
  bool has_plane = false;
  bool is_seen = false;   // nearest somewhere, so far
  double distance = 0.0;  // distance of its plane, times its normal's length; 0 = exactly edge-on, or not finite
  Eigen::Vector3d inverse_depth;  // 1/z: dot product with a pixel's ray
  float step = 0.0F;              // change of 1/z per pixel
  float lowest = 0.0F;            // bounds of 1/z
  float highest = 0.0F;
};

/// Stores the nearest surfaces in one region of the image. Without owners only depth is kept.
class Rasteriser {
 public:
  Rasteriser(const Camera& camera, const cv::Rect& region, bool with_owners);

  void draw(const RenderItem& item);
  /// Renders vertices that are snapped to this part of the image.
  void draw_placed(const RenderItem& item, std::vector<ClipVertex> vertices);
  cv::Mat depth() const;
  RenderedGeometry geometry() const;

 private:
  void draw_triangle(const RenderItem& item, std::size_t index);
  void draw_clipped(Triangle& triangle);
  void fill(const std::array<Snapped, 3>& corners, Triangle& triangle);
  void fill_rows(const std::array<Edge, 3>& edges, const cv::Rect& box, Triangle& triangle);
  void fill_span(int y, int first, int last, Triangle& triangle);
  bool has_plane(Triangle& triangle) const;
  /// Returns the ray through a pixel, at 1 m depth.
  Eigen::Vector3d ray(int x, int y) const {
    return {ray_x_[static_cast<std::size_t>(x)], ray_y_[static_cast<std::size_t>(y)], 1.0};
  }

  Camera camera_;
  cv::Rect region_;
  std::vector<double> ray_x_, ray_y_;  // rays by column and by row of the region
  cv::Mat inverse_depth_;              // CV_32FC1, 0 = nothing
  cv::Mat owner_;                      // CV_32SC1, index into surfaces_, -1 = nothing
  std::vector<Surface> surfaces_;      // only with owners
  std::vector<ClipVertex> vertices_;
};

Rasteriser::Rasteriser(const Camera& camera, const cv::Rect& region, bool with_owners)
    : camera_(camera),
      region_(region),
      inverse_depth_(region.size(), CV_32FC1, cv::Scalar(0)),
      owner_(with_owners ? region.size() : cv::Size(), CV_32SC1, cv::Scalar(-1)) {
  for (int x = 0; x < region.width; ++x) ray_x_.push_back(camera.backproject(x + region.x, 0.0, 1.0).x());
  for (int y = 0; y < region.height; ++y) ray_y_.push_back(camera.backproject(0.0, y + region.y, 1.0).y());
}

void Rasteriser::draw(const RenderItem& item) {
  place_vertices(item, camera_, region_.tl(), vertices_);
  for (std::size_t i = 0; i < item.mesh->triangles.size(); ++i) draw_triangle(item, i);
}

void Rasteriser::draw_placed(const RenderItem& item, std::vector<ClipVertex> vertices) {
  vertices_ = std::move(vertices);
  for (std::size_t i = 0; i < item.mesh->triangles.size(); ++i) draw_triangle(item, i);
}

void Rasteriser::draw_triangle(const RenderItem& item, std::size_t index) {
  const auto& [a, b, c] = item.mesh->triangles[index];
  Triangle triangle;
  triangle.corners = {&vertices_[a], &vertices_[b], &vertices_[c]};
  const auto& [first, second, third] = triangle.corners;
  if (first->in_front() && second->in_front() && third->in_front()) {
    fill({first->snapped, second->snapped, third->snapped}, triangle);
  } else {
    draw_clipped(triangle);
  }
  if (!triangle.is_seen || owner_.empty()) return;
  const Eigen::Vector3d& origin = first->position;
  const Eigen::Vector3d edge_1 = second->position - origin;
  const Eigen::Vector3d edge_2 = third->position - origin;
  surfaces_.push_back({edge_2.cross(origin) / triangle.distance, origin.cross(edge_1) / triangle.distance,
                       static_cast<std::int32_t>(index), static_cast<std::uint16_t>(item.id)});
}

void Rasteriser::draw_clipped(Triangle& triangle) {
  std::array<Snapped, 4> polygon;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const ClipVertex& here = *triangle.corners[i];
    const ClipVertex& next = *triangle.corners[(i + 1) % 3];
    if (here.in_front()) polygon[count++] = here.snapped;
    if (here.in_front() == next.in_front()) continue;
    // Always from the inner to the outer end, so that neighbours sharing this edge get the same point.
    const Eigen::Vector3d& inner = here.in_front() ? here.position : next.position;
    const Eigen::Vector3d& outer = here.in_front() ? next.position : here.position;
    const double along = (inner.z() - kNear) / (inner.z() - outer.z());
    Eigen::Vector3d crossing = inner + along * (outer - inner);
    crossing.z() = kNear;
    polygon[count++] = snap(camera_, region_.tl(), crossing);
  }
  if (count < 3) return;
  fill({polygon[0], polygon[1], polygon[2]}, triangle);
  if (count == 4) fill({polygon[0], polygon[2], polygon[3]}, triangle);
}

bool Rasteriser::has_plane(Triangle& triangle) const {
  if (triangle.has_plane) return triangle.distance != 0.0;
  triangle.has_plane = true;
  const Eigen::Vector3d& origin = triangle.corners[0]->position;
  const Eigen::Vector3d edge_1 = triangle.corners[1]->position - origin;
  const Eigen::Vector3d edge_2 = triangle.corners[2]->position - origin;
  const Eigen::Vector3d normal = edge_1.cross(edge_2);
  const double distance = normal.dot(origin);
  if (!(std::abs(distance) > std::numeric_limits<double>::min())) return false;
  triangle.distance = distance;
  triangle.inverse_depth = normal / distance;
  triangle.step = static_cast<float>(triangle.inverse_depth.x() / camera_.fx);
  double near = std::numeric_limits<double>::infinity();
  double far = 0.0;
  for (const ClipVertex* corner : triangle.corners) {
    near = std::min(near, std::max(corner->position.z(), kNear));
    far = std::max(far, corner->position.z());
  }
  triangle.lowest = static_cast<float>(1.0 / far);
  triangle.highest = static_cast<float>(1.0 / near);
  return true;
}

void Rasteriser::fill(const std::array<Snapped, 3>& corners, Triangle& triangle) {
  const Snapped& a = corners[0];
  const auto first_pixel = [](std::int64_t p, std::int64_t q, std::int64_t r) {
    return std::max<std::int64_t>(0, (std::min(std::min(p, q), r) + kSubpixels - 1) >> kSubpixelBits);
  };
  const auto end_pixel = [](std::int64_t p, std::int64_t q, std::int64_t r, int size) {
    return std::min<std::int64_t>(size, (std::max(std::max(p, q), r) >> kSubpixelBits) + 1);
  };
  const std::int64_t x_first = first_pixel(a.x, corners[1].x, corners[2].x);
  const std::int64_t x_end = end_pixel(a.x, corners[1].x, corners[2].x, region_.width);
  if (x_first >= x_end) return;
  const std::int64_t y_first = first_pixel(a.y, corners[1].y, corners[2].y);
  const std::int64_t y_end = end_pixel(a.y, corners[1].y, corners[2].y, region_.height);
  if (y_first >= y_end) return;
  const bool clockwise = (corners[1].x - a.x) * (corners[2].y - a.y) - (corners[1].y - a.y) * (corners[2].x - a.x) > 0;
  const Snapped& b = corners[clockwise ? 1 : 2];
  const Snapped& c = corners[clockwise ? 2 : 1];
  fill_rows({Edge(a, b), Edge(b, c), Edge(c, a)},
            cv::Rect(cv::Point(static_cast<int>(x_first), static_cast<int>(y_first)),
                     cv::Point(static_cast<int>(x_end), static_cast<int>(y_end))),
            triangle);
}

void Rasteriser::fill_rows(const std::array<Edge, 3>& edges, const cv::Rect& box, Triangle& triangle) {
  constexpr int kNarrow = 4;  // pixels: what is tried one by one sooner than divided for
  const Edge first_edge = edges[0];
  const Edge second_edge = edges[1];
  const Edge third_edge = edges[2];
  const auto is_inside = [&](int x, int y) {
    return (first_edge.at(x, y) | second_edge.at(x, y) | third_edge.at(x, y)) >= 0;
  };
  if (box.width <= kNarrow) {
    for (int y = box.y; y < box.br().y; ++y) {
      int first = box.x;
      int last = box.br().x - 1;
      while (first <= last && !is_inside(first, y)) ++first;
      while (first <= last && !is_inside(last, y)) --last;
      if (first <= last) fill_span(y, first, last, triangle);
    }
    return;
  }
  const std::array<ClippingEdge, 3> clipping{first_edge, second_edge, third_edge};
  for (int y = box.y; y < box.br().y; ++y) {
    int first = box.x;
    int last = box.br().x - 1;
    for (const ClippingEdge& edge : clipping) {
      if (first <= last) edge.clip(y, first, last);
    }
    if (first <= last) fill_span(y, first, last, triangle);
  }
}

void Rasteriser::fill_span(int y, int first, int last, Triangle& triangle) {
  if (!has_plane(triangle)) return;
  const auto start = static_cast<float>(triangle.inverse_depth.dot(ray(first, y)));
  const float step = triangle.step;
  const float lowest = triangle.lowest;
  const float highest = triangle.highest;
  const int count = last - first + 1;
  float* nearest = inverse_depth_.ptr<float>(y) + first;
  if (owner_.empty()) {
    for (int i = 0; i < count; ++i) {
      const float here = std::min(std::max(start + step * static_cast<float>(i), lowest), highest);
      nearest[i] = here > nearest[i] ? here : nearest[i];
    }
    return;
  }
  std::int32_t* owner = owner_.ptr<std::int32_t>(y) + first;
  const auto index = static_cast<std::int32_t>(surfaces_.size());  // its index there if it is visible
  bool is_seen = false;
  for (int i = 0; i < count; ++i) {
    const float here = std::min(std::max(start + step * static_cast<float>(i), lowest), highest);
    const bool closer = here > nearest[i];
    nearest[i] = closer ? here : nearest[i];
    owner[i] = closer ? index : owner[i];
    is_seen |= closer;
  }
  triangle.is_seen |= is_seen;
}

cv::Mat Rasteriser::depth() const {
  cv::Mat depth(region_.size(), CV_32FC1);
  for (int y = 0; y < depth.rows; ++y) {
    const float* in = inverse_depth_.ptr<float>(y);
    float* out = depth.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) out[x] = in[x] > 0.0F ? 1.0F / in[x] : kNoValue;
  }
  return depth;
}

RenderedGeometry Rasteriser::geometry() const {
  RenderedGeometry result;
  result.depth = depth();
  result.id.create(region_.size(), CV_16UC1);
  result.triangle.create(region_.size(), CV_32SC1);
  result.bary.create(region_.size(), CV_32FC2);
  const Surface nothing;
  for (int y = 0; y < region_.height; ++y) {
    const std::int32_t* owner = owner_.ptr<std::int32_t>(y);
    const float* depth = result.depth.ptr<float>(y);
    auto* bary = result.bary.ptr<cv::Vec2f>(y);
    for (int x = 0; x < region_.width; ++x) {
      const Surface& surface = owner[x] < 0 ? nothing : surfaces_[static_cast<std::size_t>(owner[x])];
      result.id.at<std::uint16_t>(y, x) = surface.id;
      result.triangle.at<std::int32_t>(y, x) = surface.triangle;
      const Eigen::Vector3d r = ray(x, y);
      const double z = owner[x] < 0 ? 0.0 : depth[x];
      const double second = std::clamp(z * surface.second.dot(r), 0.0, 1.0);
      const double third = std::clamp(z * surface.third.dot(r), 0.0, 1.0 - second);
      bary[x] = {static_cast<float>(second), static_cast<float>(third)};
    }
  }
  return result;
}

}  // namespace

RenderedGeometry render_geometry(const std::vector<RenderItem>& items, const Camera& camera) {
  return render_geometry(items, camera, cv::Rect(0, 0, camera.width, camera.height));
}

RenderedGeometry render_geometry(const std::vector<RenderItem>& items, const Camera& camera,
                                 const cv::Rect& region_px) {
  check_camera(camera, "rendering camera");
  Rasteriser rasteriser(camera, region_px, true);
  for (const RenderItem& item : items) rasteriser.draw(item);
  return rasteriser.geometry();
}

cv::Mat render_depth(const std::vector<RenderItem>& items, const Camera& camera, const cv::Rect& region_px) {
  Rasteriser rasteriser(camera, region_px, false);
  for (const RenderItem& item : items) rasteriser.draw(item);
  return rasteriser.depth();
}

cv::Mat render_depth(const Mesh& mesh, const Eigen::Isometry3d& T_camera_object, const Camera& camera,
                     const cv::Rect& region_px) {
  return render_depth({{&mesh, T_camera_object, 1}}, camera, region_px);
}

RenderedRegion render_depth_region(const Mesh& mesh, const Eigen::Isometry3d& T_camera_object, const Camera& camera) {
  const RenderItem item{&mesh, T_camera_object, 1};
  std::vector<ClipVertex> vertices;
  place_vertices(item, camera, {}, vertices);
  const cv::Rect region_px = covered_part(vertices, camera);
  if (region_px.area() == 0) return {};
  for (ClipVertex& vertex : vertices)
    vertex.snapped = {vertex.snapped.x - kSubpixels * region_px.x, vertex.snapped.y - kSubpixels * region_px.y};
  Rasteriser rasteriser(camera, region_px, false);
  rasteriser.draw_placed(item, std::move(vertices));
  return {region_px, rasteriser.depth()};
}

}  // namespace houghstream
