#include "pose/seen/colour_discriminant.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace houghstream {
namespace {

Eigen::Vector3d vector_of(const cv::Vec3b& lab) {
  return {1.0 * lab[0], 1.0 * lab[1], 1.0 * lab[2]};
}

}  // namespace

void ColourMoments::add(const cv::Vec3b& lab) {
  const Eigen::Vector3d colour = vector_of(lab);
  sum_ += colour;
  products_ += colour * colour.transpose();
  ++count_;
}

Eigen::Matrix3d ColourMoments::covariance() const {
  return products_ / count_ - mean() * mean().transpose();
}

std::optional<ColourDiscriminant> ColourDiscriminant::between(const ColourMoments& object,
                                                              const ColourMoments& beside) {
  constexpr int kMinColours = 30;
  constexpr double kNoise = 9.0;           // variance of a channel
  constexpr double kMinDistance_sq = 4.0;  // two standard deviations
  if (std::min(object.count(), beside.count()) < kMinColours) return std::nullopt;
  const Eigen::Matrix3d scatter =
      0.5 * (object.covariance() + beside.covariance()) + kNoise * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d difference = object.mean() - beside.mean();
  const Eigen::Vector3d direction = scatter.ldlt().solve(difference);
  const double distance_sq = direction.dot(difference);
  if (!(distance_sq > kMinDistance_sq)) return std::nullopt;
  ColourDiscriminant discriminant;
  discriminant.weights_ = direction / distance_sq;
  discriminant.beside_ = beside.mean();
  return discriminant;
}

double ColourDiscriminant::evidence(const cv::Vec3b& lab) const {
  constexpr double kNeither = 0.25;  // share of the object in a mixture that speaks for neither
  const double share = weights_.dot(vector_of(lab) - beside_);
  return std::clamp(share / kNeither - 1.0, -1.0, 1.0);
}

}  // namespace houghstream
