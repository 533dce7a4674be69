#include "pipeline/types/camera.hpp"

#include <cmath>
#include <cstdio>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/printable.hpp"

namespace houghstream {

Camera Camera::scaled(double scale) const {
  Camera out;
  out.width = static_cast<int>(std::lround(width * scale));
  out.height = static_cast<int>(std::lround(height * scale));
  const double scale_x = static_cast<double>(out.width) / width;
  const double scale_y = static_cast<double>(out.height) / height;
  out.fx = fx * scale_x;
  out.fy = fy * scale_y;
  out.cx = (cx + 0.5) * scale_x - 0.5;
  out.cy = (cy + 0.5) * scale_y - 0.5;
  return out;
}

Camera Camera::cropped(int x_px, int y_px, int crop_width, int crop_height) const {
  return {crop_width, crop_height, fx, fy, cx - x_px, cy - y_px};
}

bool operator==(const Camera& a, const Camera& b) {
  return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy && a.cx == b.cx && a.cy == b.cy;
}

void check_camera(const Camera& camera, const std::string& source) {
  constexpr int kMaxSize = 16384;
  require(camera.width >= 1 && camera.width <= kMaxSize && camera.height >= 1 && camera.height <= kMaxSize,
          "{}: camera size {}x{}, expected 1 to {} pixels each", source, camera.width, camera.height, kMaxSize);
  constexpr double kMinFocal = 0.1;  // wider than any lens at any size, so that pixel positions stay finite
  constexpr double kMaxFocal = 1e7;
  const auto is_focal = [](double f) { return f >= kMinFocal && f <= kMaxFocal; };
  require(is_focal(camera.fx) && is_focal(camera.fy), "{}: focal lengths {} and {}, expected {} to {} pixels", source,
          camera.fx, camera.fy, kMinFocal, kMaxFocal);
  const bool centred = std::abs(camera.cx) <= 2.0 * camera.width && std::abs(camera.cy) <= 2.0 * camera.height;
  require(std::isfinite(camera.cx) && std::isfinite(camera.cy) && centred,
          "{}: principal point ({}, {}), expected within one image size of the {}x{} image", source, camera.cx,
          camera.cy, camera.width, camera.height);
}

Camera parse_camera(const std::string& text) {
  Camera camera;
  int used = 0;
  const int fields = std::sscanf(text.c_str(), "%dx%d,%lf,%lf,%lf,%lf%n", &camera.width, &camera.height, &camera.fx,
                                 &camera.fy, &camera.cx, &camera.cy, &used);
  require(fields == 6 && static_cast<std::size_t>(used) == text.size(),
          "--camera '{}', expected WIDTHxHEIGHT,fx,fy,cx,cy, for instance 640x480,525,525,319.5,239.5",
          printable(text));
  check_camera(camera, "--camera");
  return camera;
}

}  // namespace houghstream
