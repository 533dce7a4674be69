#include "pose/model/surface_colour.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace houghstream {
namespace {

/// Returns the texture's pixels per metre of surface, mean over the mesh.
double texel_density(const Mesh& mesh) {
  double on_texture = 0.0;
  double on_surface = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3f u = mesh.vertices[b] - mesh.vertices[a];
    const Eigen::Vector3f v = mesh.vertices[c] - mesh.vertices[a];
    on_surface += 0.5 * static_cast<double>(u.cross(v).norm());
    const Eigen::Vector2f p = mesh.uvs[b] - mesh.uvs[a];
    const Eigen::Vector2f q = mesh.uvs[c] - mesh.uvs[a];
    on_texture += 0.5 * std::abs(static_cast<double>(p.x() * q.y() - p.y() * q.x()));
  }
  return on_surface > 0.0 ? std::sqrt(on_texture * mesh.texture.cols * mesh.texture.rows / on_surface) : 0.0;
}

LabColour to_lab(const cv::Vec3b& bgr) {
  cv::Mat pixel(1, 1, CV_8UC3, cv::Scalar(bgr[0], bgr[1], bgr[2]));
  cv::cvtColor(pixel, pixel, cv::COLOR_BGR2Lab);
  const auto& lab = pixel.at<cv::Vec3b>(0, 0);
  return {lab[0], lab[1], lab[2]};
}

}  // namespace

const cv::Vec3b& texel_at(const cv::Mat& texture, const Eigen::Vector2f& uv) {
  const auto index = [](float fraction, int size) {
    return std::clamp(static_cast<int>(fraction * static_cast<float>(size)), 0, size - 1);
  };
  return texture.at<cv::Vec3b>(index(uv.y(), texture.rows), index(uv.x(), texture.cols));
}

SurfaceColour::SurfaceColour(const Mesh& mesh, double detail_m) : mesh_(mesh) {
  if (mesh.texture.empty() || mesh.uvs.size() != mesh.vertices.size()) return;
  const int side = 2 * static_cast<int>(0.5 * detail_m * texel_density(mesh)) + 1;
  cv::blur(mesh.texture, texture_, cv::Size(side, side));
  cv::cvtColor(texture_, texture_, cv::COLOR_BGR2Lab);
}

bool SurfaceColour::has_colour() const {
  return !texture_.empty() || mesh_.colours.size() == mesh_.vertices.size();
}

LabColour SurfaceColour::at(std::size_t triangle, const cv::Vec2f& bary) const {
  const auto& [a, b, c] = mesh_.triangles[triangle];
  const float first = 1.0F - bary[0] - bary[1];
  if (!texture_.empty()) {
    const Eigen::Vector2f uv = first * mesh_.uvs[a] + bary[0] * mesh_.uvs[b] + bary[1] * mesh_.uvs[c];
    const cv::Vec3b& lab = texel_at(texture_, uv);
    return {lab[0], lab[1], lab[2]};
  }
  const cv::Vec3f bgr = first * cv::Vec3f(mesh_.colours[a]) + bary[0] * cv::Vec3f(mesh_.colours[b]) +
                        bary[1] * cv::Vec3f(mesh_.colours[c]);
  return to_lab(bgr);
}

}  // namespace houghstream
