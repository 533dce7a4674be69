#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace houghstream {

/// The mean colours of an object at one pose: those of its model, and those that a camera measured at the same points.
struct ChromaPair {
  std::string class_name;
  Eigen::Vector2d model = Eigen::Vector2d::Zero();     ///< a* and b* of the model
  Eigen::Vector2d measured = Eigen::Vector2d::Zero();  ///< a* and b* that the camera measured
  double lightness = 0.0;                              ///< L* that the camera measured, 0 to 100
  /// Probability that this object stands there, by all that does not depend on the camera's colours, 0 to 1.
  double probability = 0.0;
};

/// How a camera renders known colours under the present light: measured = gain * model + (L* + 16) / 116 * cast, in the
/// a*b* plane of CIE L*a*b*. Where a light scales X, Y and Z, as von Kries has it, the cast of a colour goes with the
/// cube root of its luminance, which is (L* + 16) / 116. Lightness itself is not mapped: exposure and shading decide
/// it. As it stands, it is the identity, and as uncertain as the cameras in which practice looks for objects differ.
class ChromaMap {
 public:
  static constexpr int kParameters = 6;
  using Parameters = Eigen::Matrix<double, kParameters, 1>;
  using Covariance = Eigen::Matrix<double, kParameters, kParameters>;

  ChromaMap();
  /// The gain row by row, then the cast of white.
  ChromaMap(const Parameters& parameters, const Covariance& covariance, double objects);

  /// The colour that the camera is expected to measure.
  Eigen::Vector2d apply(const Eigen::Vector2d& model, double lightness) const;
  /// How uncertain that is.
  Eigen::Matrix2d uncertainty(const Eigen::Vector2d& model, double lightness) const;

  const Parameters& parameters() const { return parameters_; }
  const Covariance& covariance() const { return covariance_; }
  double objects() const { return objects_; }  ///< from how many it was learnt, each counted by its probability
  bool is_learnt() const { return objects_ > 0.0; }

 private:
  Parameters parameters_;
  Covariance covariance_;
  double objects_ = 0.0;
};

/// The map that explains the pairs best (maximum a posteriori). Each pair is either of the object that it names or of
/// something else, whose colour may be any; which of them it is, is estimated with the map (expectation maximisation),
/// so that a wrong object does not drag it. Pairs that are no colours (NaN, for one) have no say. Without any pair that
/// has one it is the identity.
ChromaMap fit_chroma_map(const std::vector<ChromaPair>& pairs);

/// For each pair the map of all the pairs of other classes: what an object is judged by may not be learnt of itself, or
/// a wrong one would explain itself away.
std::vector<ChromaMap> fit_chroma_maps_without_each(const std::vector<ChromaPair>& pairs);

}  // namespace houghstream
