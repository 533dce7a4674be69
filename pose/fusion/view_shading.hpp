#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

namespace houghstream::fusion {

/// Returns a pixel's colour in linear light, from its bytes as sRGB (IEC 61966-2-1), BGR in [0,1].
Eigen::Vector3d srgb_to_linear(const cv::Vec3b& colour);
/// Returns the inverse of srgb_to_linear(), clipped.
cv::Vec3b linear_to_srgb(const Eigen::Vector3d& linear);

/// A vertex as a view shows it.
struct ColourSample {
  int vertex = 0;
  int view = 0;
  double level = 0.0;   ///< log of the linear brightness
  double weight = 0.0;  ///< larger for a frontal view
};

/// Estimates the log exposure of each view relative to the others, with median 0. Brightness is modelled as exposure
/// times the radiance of the vertex; medians make the estimate robust to moving highlights and shadows. A view that
/// shares no vertex with others has 0. (Gain compensation of panoramas: Brown and Lowe 2007, with medians.)
std::vector<double> estimate_exposures(const std::vector<ColourSample>& samples, int vertices, int views);

/// Log irradiance of a lighting that is static relative to the object, as a function of the normal: spherical harmonics
/// of second order (which represent diffuse lighting, Ramamoorthi and Hanrahan 2001).
class ShadingModel {
 public:
  /// Returns the logarithm of the shading on a surface of this normal, up to a constant.
  double operator()(const Eigen::Vector3d& normal) const;

 private:
  friend ShadingModel fit_shading(const std::vector<Eigen::Vector3d>& colours,
                                  const std::vector<Eigen::Vector3d>& normals);
  Eigen::Matrix<double, 8, 1> weights_ = Eigen::Matrix<double, 8, 1>::Zero();
};

/// Separates shading from albedo. Neither is observed alone: surfaces of the same hue and saturation on sides that face
/// differently are taken to have the same albedo in most places (absolute deviations are minimal), and ambiguous
/// variation counts as albedo. `colours` are linear BGR of points of the surface, without exposure; `normals` have unit
/// length. Both have one size.
ShadingModel fit_shading(const std::vector<Eigen::Vector3d>& colours, const std::vector<Eigen::Vector3d>& normals);

}  // namespace houghstream::fusion
