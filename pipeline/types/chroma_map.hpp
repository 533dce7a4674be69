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
  /// Probability that this object stands there, by all that does not depend on the camera's colours, 0 to 1.
  double probability = 0.0;
};

/// What is remembered of a camera's colours: objects that were seen by it, each class once.
struct CameraChroma {
  FrameId frame;  ///< the newest that was learnt from
  std::vector<ChromaPair> objects;
};

/// How a camera renders known colours under the present light: measured = gain * model + (L* + 16) / 116 * cast, in the
/// a*b* plane of CIE L*a*b*. Where a light scales X, Y and Z, as von Kries has it, the cast of a colour goes with the
/// cube root of its luminance, which is (L* + 16) / 116. Lightness itself is not mapped: exposure and shading decide
/// it. As it stands, it is the identity, and as uncertain as the cameras in which calibration looks for objects differ.
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

  /// How much stronger than taught colours look, in the mean of all hues: 1 of the identity.
  double saturation() const;
  /// What white looks like, a* and b*.
  Eigen::Vector2d white() const;
  /// Standard deviation of what it says of a colour of medium strength, CIE a*b*: how sure it is, in one number.
  double sigma() const;

  const Parameters& parameters() const { return parameters_; }
  const Covariance& covariance() const { return covariance_; }
  double objects() const { return objects_; }  ///< from how many it was learnt, each counted by its probability
  bool is_learnt() const { return objects_ > 0.0; }

 private:
  Parameters parameters_;
  Covariance covariance_;
  double objects_ = 0.0;
};

/// The map in words: "saturation 0.78, white looks like a* +2 b* +14, from 5 objects, to within 4".
std::string describe(const ChromaMap& map);

/// The map that explains the pairs best (maximum a posteriori). Each pair is either of the object that it names or of
/// something else, whose colour may be any; which of them it is, is estimated with the map (expectation maximisation),
/// so that a wrong object does not drag it. Pairs that are no colours (NaN, for one) have no say. Without any pair that
/// has one it is the identity.
ChromaMap fit_chroma_map(const std::vector<ChromaPair>& pairs);

/// The map of the pairs of other classes: what an object is judged by may not be learnt of itself, or a wrong one would
/// explain itself away.
ChromaMap fit_chroma_map_without(const std::string& class_name, const std::vector<ChromaPair>& pairs);

/// Whether its colours, lightness and probability are numbers that such things can be.
bool is_chroma_pair(const ChromaPair& pair);

/// For each pair the map without its class.
std::vector<ChromaMap> fit_chroma_maps_without_each(const std::vector<ChromaPair>& pairs);

/// Whether the image is of a camera in black and white or of infrared light: there is no chroma to learn from. From
/// one of 64 pixels. False for what is no CV_8UC3.
bool is_colourless(const cv::Mat& image);

/// The map of such a camera: every colour becomes grey, so that chroma speaks neither for an object nor against it.
ChromaMap colourless_camera();

}  // namespace houghstream
