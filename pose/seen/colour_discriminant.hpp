#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

namespace houghstream {

/// Mean and covariance of colours, 8-bit CIE L*a*b*.
class ColourMoments {
 public:
  void add(const cv::Vec3b& lab);
  int count() const { return count_; }
  Eigen::Vector3d mean() const { return sum_ / count_; }  ///< at least one colour was added
  Eigen::Matrix3d covariance() const;                     ///< likewise

 private:
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products_ = Eigen::Matrix3d::Zero();
  int count_ = 0;
};

/// Tells an object's colours from those beside it by one number, which also pixels keep in which both are mixed, as on
/// parts that are thin in the image (Fisher 1936, "The use of multiple measurements in taxonomic problems").
class ColourDiscriminant {
 public:
  /// Returns nothing where either side has too few colours, or where they hardly differ.
  static std::optional<ColourDiscriminant> between(const ColourMoments& object, const ColourMoments& beside);

  /// Returns -1 for the colours beside the object, 1 for a mixture that is half the object's, and in between for less.
  double evidence(const cv::Vec3b& lab) const;

 private:
  Eigen::Vector3d weights_ = Eigen::Vector3d::Zero();  ///< 1 from `beside_` to the object's mean
  Eigen::Vector3d beside_ = Eigen::Vector3d::Zero();
};

}  // namespace houghstream
