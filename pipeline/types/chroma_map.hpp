#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "pipeline/types/frame_id.hpp"

namespace houghstream {

/// The mean colours of an object where it is taken to stand: those of its model, and those that a camera measured at
/// the same points.
struct ChromaPair {
  std::string class_name;
  Eigen::Vector2d model = Eigen::Vector2d::Zero();     ///< a* and b* of the model
  Eigen::Vector2d measured = Eigen::Vector2d::Zero();  ///< a* and b* that the camera measured
  double lightness = 0.0;                              ///< L* that the camera measured, 0 to 100
  /// Probability that this object is there, by all evidence that does not depend on the camera's colours, 0 to 1.
  double probability = 0.0;
};

/// Holds the chroma observed by a camera: of each class once.
struct CameraChroma {
  FrameId frame;  ///< the newest that was learnt from
  std::vector<ChromaPair> objects;
};

/// Returns by how much a light's cast on a colour of this L* is less than on white: the cube root of the luminance, to
/// which a* and b* are proportional where a light scales X, Y and Z.
constexpr double chroma_scale(double lightness) {
  return (lightness + 16.0) / 116.0;
}

/// Maps known colours to those that a camera measures under the present light: measured = gain * model + (L* + 16) /
/// 116 * cast, in the a*b* plane of CIE L*a*b*. Where a light scales X, Y and Z, as in von Kries's model, the cast of a
/// colour is proportional to the cube root of its luminance, which is (L* + 16) / 116. Lightness itself is not mapped,
/// since exposure and shading decide it. By default it is the identity, with the uncertainty of the cameras that
/// calibration simulates.
class ChromaMap {
 public:
  static constexpr int kParameters = 6;
  using Parameters = Eigen::Matrix<double, kParameters, 1>;
  using Covariance = Eigen::Matrix<double, kParameters, kParameters>;

  ChromaMap();
  /// `parameters` are the gain row by row, then the cast of white.
  ChromaMap(const Parameters& parameters, const Covariance& covariance, double objects);

  /// The colour that the camera is expected to measure.
  Eigen::Vector2d apply(const Eigen::Vector2d& model, double lightness) const;
  /// Returns the covariance of that colour.
  Eigen::Matrix2d uncertainty(const Eigen::Vector2d& model, double lightness) const;

  /// Returns the gain of chroma over the taught colours, in the mean of all hues: 1 for the identity.
  double saturation() const;
  /// Returns the colour that white has in the image, a* and b*.
  Eigen::Vector2d white() const;
  /// Returns the standard deviation of the map for a colour of medium strength, CIE a*b*: its uncertainty in one
  /// number.
  double sigma() const;

  const Parameters& parameters() const { return parameters_; }
  const Covariance& covariance() const { return covariance_; }
  double objects() const {
    return objects_;
  }  ///< number of objects it was learnt from, each weighted by its probability
  bool is_learnt() const { return objects_ > 0.0; }

 private:
  Parameters parameters_;
  Covariance covariance_;
  double objects_ = 0.0;
};

/// Returns the map in words: "saturation 0.78, white looks like a* +2 b* +14, from 5 objects, to within 4".
std::string describe(const ChromaMap& map);

/// Fits the map that explains the pairs best (maximum a posteriori). Each pair belongs either to the object that it
/// names or to something else, whose colour may be any; which of them it is, is estimated with the map (expectation
/// maximisation), so that a wrong object does not bias it. Pairs that are no colours (NaN, for one) are ignored.
/// Without any valid pair it is the identity.
ChromaMap fit_chroma_map(const std::vector<ChromaPair>& pairs);

/// Fits the map to the pairs of other classes: the map by which an object is judged may not be learnt from itself, or a
/// wrong one would explain itself away.
ChromaMap fit_chroma_map_without(const std::string& class_name, const std::vector<ChromaPair>& pairs);

/// Returns whether its colours, lightness and probability are valid numbers in their ranges.
bool is_chroma_pair(const ChromaPair& pair);

/// Returns for each pair the map without its class.
std::vector<ChromaMap> fit_chroma_maps_without_each(const std::vector<ChromaPair>& pairs);

/// Returns whether the image is from a black-and-white camera or of infrared light, so that there is no chroma to learn
/// from. It reads one of 64 pixels. Returns false for images that are not CV_8UC3.
bool is_colourless(const cv::Mat& image);

/// Returns the map of such a camera: every colour becomes grey, so that chroma speaks neither for an object nor against
/// it.
ChromaMap colourless_camera();

}  // namespace houghstream
