#include "pipeline/geometry/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "pipeline/geometry/raster_edge.hpp"

// Scan conversion with exact edges (raster_edge.hpp), one span per row. Depth comes from the plane of the unsnapped
// triangle: with n = (V1 - V0) x (V2 - V0), 1/z = n.r / n.V0 along the ray r.

namespace houghstream {
namespace {

constexpr double kNear = 0.05;          // metres
constexpr double kSnapLimit = 1 << 29;  // keeps products of two coordinates within 64 bits
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

struct ClipVertex {
  Eigen::Vector3d position;
  Snapped snapped;
};

/// What a visible pixel needs of its triangle: dot products with the pixel's ray.
struct Surface {
  Eigen::Vector3d inverse_depth = Eigen::Vector3d::Zero();  // 1/z
  Eigen::Vector3d second = Eigen::Vector3d::Zero();         // weight of the 2nd vertex, divided by z
  Eigen::Vector3d third = Eigen::Vector3d::Zero();
  std::int32_t triangle = -1;
  std::uint16_t id = 0;
};

/// Nearest surfaces in one region of the image. Without owners only depth is kept.
class Rasteriser {
 public:
  Rasteriser(const Camera& camera, const cv::Rect& region, bool with_owners)
      : camera_(camera),
        region_(region),
        inverse_depth_(region.size(), CV_32FC1, cv::Scalar(0)),
        owner_(with_owners ? region.size() : cv::Size(), CV_32SC1, cv::Scalar(-1)) {
    for (int x = 0; x < region.width; ++x) ray_x_.push_back(camera.backproject(x + region.x, 0.0, 1.0).x());
    for (int y = 0; y < region.height; ++y) ray_y_.push_back(camera.backproject(0.0, y + region.y, 1.0).y());
  }

  void draw(const RenderItem& item);
  cv::Mat depth() const;
  RenderedGeometry geometry() const;

 private:
  Snapped snap(const Eigen::Vector3d& point) const;
  void draw_triangle(const RenderItem& item, std::size_t index);
  void draw_clipped(const std::array<ClipVertex, 3>& corners, const Surface& surface);
  bool covers_a_pixel(const Snapped& a, const Snapped& b, const Snapped& c) const;
  void fill(const std::array<Snapped, 3>& corners, const Surface& surface);
  void fill_span(int y, int first, int last, const Surface& surface);
  Eigen::Vector3d ray(int x, int y) const {
    return {ray_x_[static_cast<std::size_t>(x)], ray_y_[static_cast<std::size_t>(y)], 1.0};
  }

  Camera camera_;
  cv::Rect region_;
  cv::Mat inverse_depth_;          // CV_32FC1, 0 = nothing
  cv::Mat owner_;                  // CV_32SC1, index into surfaces_, -1 = nothing
  std::vector<Surface> surfaces_;  // only with owners
  std::vector<ClipVertex> vertices_;
  std::vector<double> ray_x_;  // of the region's columns and rows
  std::vector<double> ray_y_;
  float lowest_ = 0.0F;  // bounds of 1/z on the triangle being drawn
  float highest_ = 0.0F;
  float step_ = 0.0F;  // of 1/z from column to column
};

Snapped Rasteriser::snap(const Eigen::Vector3d& point) const {
  constexpr double kRounding = kSnapLimit + 0.5;
  const auto fixed = [](double px) {
    const double scaled = px * kSubpixels;
    const double limited = scaled > -kSnapLimit ? std::min(scaled, kSnapLimit) : -kSnapLimit;  // NaN too
    return static_cast<std::int64_t>(limited + kRounding) - static_cast<std::int64_t>(kSnapLimit);
  };
  const Eigen::Vector2d pixel = camera_.project(point);
  return {fixed(pixel.x()) - kSubpixels * region_.x, fixed(pixel.y()) - kSubpixels * region_.y};
}

void Rasteriser::draw(const RenderItem& item) {
  require(item.mesh != nullptr, "render item without a mesh");
  const Mesh& mesh = *item.mesh;
  vertices_.resize(mesh.vertices.size());
  if (!owner_.empty()) surfaces_.reserve(surfaces_.size() + mesh.triangles.size());
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    vertices_[i].position = item.T_camera_object * mesh.vertices[i].cast<double>();
    if (vertices_[i].position.z() >= kNear) vertices_[i].snapped = snap(vertices_[i].position);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) draw_triangle(item, i);
}

bool Rasteriser::covers_a_pixel(const Snapped& a, const Snapped& b, const Snapped& c) const {
  const auto [x_low, x_high] = std::minmax({a.x, b.x, c.x});
  const auto [y_low, y_high] = std::minmax({a.y, b.y, c.y});
  const auto holds_centre = [](std::int64_t low, std::int64_t high, int size) {
    const std::int64_t first = (low + kSubpixels - 1) >> kSubpixelBits;
    const std::int64_t last = high >> kSubpixelBits;
    return first <= last && last >= 0 && first < size;
  };
  return holds_centre(x_low, x_high, region_.width) && holds_centre(y_low, y_high, region_.height);
}

void Rasteriser::draw_triangle(const RenderItem& item, std::size_t index) {
  const auto& triangle = item.mesh->triangles[index];
  const ClipVertex& a = vertices_[triangle[0]];
  const ClipVertex& b = vertices_[triangle[1]];
  const ClipVertex& c = vertices_[triangle[2]];
  const bool all_in_front = a.position.z() >= kNear && b.position.z() >= kNear && c.position.z() >= kNear;
  // Of a dense mesh most triangles end here.
  if (all_in_front && !covers_a_pixel(a.snapped, b.snapped, c.snapped)) return;

  const Eigen::Vector3d& origin = a.position;
  const Eigen::Vector3d edge_1 = b.position - origin;
  const Eigen::Vector3d edge_2 = c.position - origin;
  const Eigen::Vector3d normal = edge_1.cross(edge_2);
  const double distance = normal.dot(origin);
  if (!(std::abs(distance) > std::numeric_limits<double>::min())) return;  // seen exactly edge-on, or not finite
  Surface surface;
  surface.inverse_depth = normal / distance;
  if (!owner_.empty()) {
    surface.second = edge_2.cross(origin) / distance;
    surface.third = origin.cross(edge_1) / distance;
    surface.triangle = static_cast<std::int32_t>(index);
    surface.id = static_cast<std::uint16_t>(item.id);
    surfaces_.push_back(surface);
  }
  if (all_in_front) {
    const auto [near, far] = std::minmax({a.position.z(), b.position.z(), c.position.z()});
    lowest_ = static_cast<float>(1.0 / far);
    highest_ = static_cast<float>(1.0 / near);
    fill({a.snapped, b.snapped, c.snapped}, surface);
  } else {
    draw_clipped({a, b, c}, surface);
  }
}

void Rasteriser::draw_clipped(const std::array<ClipVertex, 3>& corners, const Surface& surface) {
  std::array<Snapped, 4> polygon;
  std::size_t count = 0;
  double far = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const ClipVertex& here = corners[i];
    const ClipVertex& next = corners[(i + 1) % 3];
    const bool here_in = here.position.z() >= kNear;
    if (here_in) {
      polygon[count++] = here.snapped;
      far = std::max(far, here.position.z());
    }
    if (here_in == (next.position.z() >= kNear)) continue;
    // Always from the inner to the outer end, so that neighbours sharing this edge get the same point.
    const Eigen::Vector3d& inner = here_in ? here.position : next.position;
    const Eigen::Vector3d& outer = here_in ? next.position : here.position;
    const double along = (inner.z() - kNear) / (inner.z() - outer.z());
    Eigen::Vector3d crossing = inner + along * (outer - inner);
    crossing.z() = kNear;
    polygon[count++] = snap(crossing);
  }
  if (count < 3) return;
  lowest_ = static_cast<float>(1.0 / far);
  highest_ = static_cast<float>(1.0 / kNear);
  fill({polygon[0], polygon[1], polygon[2]}, surface);
  if (count == 4) fill({polygon[0], polygon[2], polygon[3]}, surface);
}

void Rasteriser::fill(const std::array<Snapped, 3>& corners, const Surface& surface) {
  const Snapped& a = corners[0];
  const bool clockwise = (corners[1].x - a.x) * (corners[2].y - a.y) - (corners[1].y - a.y) * (corners[2].x - a.x) > 0;
  const Snapped& b = corners[clockwise ? 1 : 2];
  const Snapped& c = corners[clockwise ? 2 : 1];
  std::array<Edge, 3> edges{Edge(a, b), Edge(b, c), Edge(c, a)};

  const auto [x_low, x_high] = std::minmax({a.x, b.x, c.x});
  const auto [y_low, y_high] = std::minmax({a.y, b.y, c.y});
  const auto first_pixel = [](std::int64_t low) {
    return static_cast<int>(std::max<std::int64_t>(0, (low + kSubpixels - 1) >> kSubpixelBits));
  };
  const int x_first = first_pixel(x_low);
  const int y_first = first_pixel(y_low);
  const int x_last = static_cast<int>(std::min<std::int64_t>(region_.width - 1, x_high >> kSubpixelBits));
  const int y_last = static_cast<int>(std::min<std::int64_t>(region_.height - 1, y_high >> kSubpixelBits));
  constexpr int kFew = 8;
  const bool few = x_last - x_first < kFew;
  if (!few) {
    for (Edge& edge : edges) edge.prepare();
  }
  step_ = static_cast<float>(surface.inverse_depth.x() / camera_.fx);
  for (int y = y_first; y <= y_last; ++y) {
    int first = x_first;
    int last = x_last;
    for (const Edge& edge : edges) {
      if (first > last) break;
      few ? edge.clip_few(y, first, last) : edge.clip(y, first, last);
    }
    if (first <= last) fill_span(y, first, last, surface);
  }
}

void Rasteriser::fill_span(int y, int first, int last, const Surface& surface) {
  const auto start = static_cast<float>(surface.inverse_depth.dot(ray(first, y)));
  const float step = step_;
  const float lowest = lowest_;
  const float highest = highest_;
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
  const auto index = static_cast<std::int32_t>(surfaces_.size()) - 1;
  for (int i = 0; i < count; ++i) {
    const float here = std::min(std::max(start + step * static_cast<float>(i), lowest), highest);
    const bool closer = here > nearest[i];
    nearest[i] = closer ? here : nearest[i];
    owner[i] = closer ? index : owner[i];
  }
}

cv::Mat Rasteriser::depth() const {
  cv::Mat depth(region_.size(), CV_32FC1);
  for (int y = 0; y < depth.rows; ++y) {
    const float* in = inverse_depth_.ptr<float>(y);
    float* out = depth.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) out[x] = in[x] > 0.0F ? 1.0F / in[x] : kNone;
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

}  // namespace houghstream
