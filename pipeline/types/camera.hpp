#pragma once

#include <Eigen/Core>
#include <string>

namespace houghstream {

/// Describes a pinhole camera without distortion. The convention of the whole project is written here once: camera
/// frame x right, y down, z forward, metres; the centre of the first pixel is (0,0); depth is Z along the optical axis,
/// not range along the ray. No other file knows a focal length.
struct Camera {
  int width = 0;    ///< pixels
  int height = 0;   ///< pixels
  double fx = 0.0;  ///< pixels
  double fy = 0.0;  ///< pixels
  double cx = 0.0;  ///< pixels
  double cy = 0.0;  ///< pixels

  /// Returns the pixel of a point in the camera frame. The point must lie in front of the camera (z > 0).
  Eigen::Vector2d project(const Eigen::Vector3d& point_camera) const {
    return {fx * point_camera.x() / point_camera.z() + cx, fy * point_camera.y() / point_camera.z() + cy};
  }

  /// Works as project() in single precision, for many points, with an error below a thousandth of a pixel.
  Eigen::Vector2f project_single(const Eigen::Vector3f& point_camera) const {
    const float scale = 1.0F / point_camera.z();
    return {static_cast<float>(fx) * point_camera.x() * scale + static_cast<float>(cx),
            static_cast<float>(fy) * point_camera.y() * scale + static_cast<float>(cy)};
  }

  /// Returns the point in the camera frame seen at pixel (u,v) with depth z in metres.
  Eigen::Vector3d backproject(double u_px, double v_px, double z) const {
    return {(u_px - cx) / fx * z, (v_px - cy) / fy * z, z};
  }

  /// Returns the length in metres of one pixel at depth z.
  double metres_per_px(double z) const { return z / fx; }

  /// Returns the camera of the image resized to `scale` times its size (pixel areas stay aligned).
  Camera scaled(double scale) const;

  /// Returns the camera of the sub-image whose first pixel is (x_px, y_px) of this one.
  Camera cropped(int x_px, int y_px, int crop_width, int crop_height) const;
};

bool operator==(const Camera& a, const Camera& b);
inline bool operator!=(const Camera& a, const Camera& b) {
  return !(a == b);
}

/// Throws InputError naming `source` unless sizes are 1..16384, focal lengths finite and positive, and the
/// principal point finite and within one image size of the image.
void check_camera(const Camera& camera, const std::string& source);

/// Parses "WIDTHxHEIGHT,fx,fy,cx,cy", the form of the option --camera. Throws InputError.
Camera parse_camera(const std::string& text);

}  // namespace houghstream
