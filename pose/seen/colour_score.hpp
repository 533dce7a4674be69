#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "pipeline/types/chroma_map.hpp"
#include "pose/seen/depth_score.hpp"
#include "pose/seen/region.hpp"

namespace houghstream {

/// Variance of the observed 8-bit CIE L*a*b* colours, all channels, on a uniform surface in even light, which shows no
/// texture.
constexpr double kUntexturedVariance = 15.0;

/// The mean chroma of points, and how much the measured one varies about it.
struct ChromaMeans {
  Eigen::Vector2d model = Eigen::Vector2d::Zero();     ///< a* and b*
  Eigen::Vector2d measured = Eigen::Vector2d::Zero();  ///< a* and b*
  double lightness = 0.0;                              ///< measured, L*, 0 to 100
  Eigen::Vector2d variance = Eigen::Vector2d::Zero();  ///< variance of the measured a* and b*
};

/// Comparison of the model's colours at a pose with the observed ones, where measured and model depth agree and, unless
/// stated otherwise, the camera was not clipped.
struct ColourComparison {
  int points = 0;  ///< compared
  /// 1 less the fraction of the observed variance that is unexplained, with each channel's gain (within limits) and
  /// offset free, as exposure and the light's colour decide them, and lightness also free to follow the surface's
  /// normals, as shading does. It is near 0, or below, for unrelated textures.
  float agreement = 0.0F;
  float residual_stddev = 0.0F;  ///< standard deviation of the seen colours that is left over, 8-bit CIE L*a*b*
  /// Distance of the mean observed a* and b* from the model's, at any strength (within limits) that haze or a camera
  /// gives these, divided by the spread of the observed ones, at most 4. Clipped points count too: without them only
  /// edges and shaded parts would remain, which have another hue.
  float chroma_difference = 0.0F;
  int clipped = 0;  ///< number of points that are not compared, since the camera was clipped there
  /// Standard deviation of the observed colours, with the channels weighted as in `residual_stddev`.
  float observed_contrast = 0.0F;
  float model_contrast = 0.0F;   ///< the model's, measured likewise
  ChromaMeans chroma;            ///< means over all points, which `chroma_difference` compares
  ChromaMeans unclipped_chroma;  ///< means over the points where the camera was not clipped
};

/// Returns ColourComparison::chroma_difference after mapping the model's colours to the camera's.
float chroma_difference(const ChromaMeans& means, const ChromaMap& camera);

/// Compares the colours of the projected points. Returns nothing where the model has no colours or too few points
/// agree.
std::optional<ColourComparison> compare_colours(const LabRegion& colours, const ProjectedView& projected,
                                                const DepthTolerance& tolerance);

/// Compares the colours after averaging the observed ones over slightly more than the model's, and shifting them by up
/// to two pixels to the best agreement (less for small objects): the registration of colour to depth, and poses, are no
/// more accurate. It is meant for the decision about a pose, not for the selection between poses, which differ by less.
std::optional<ColourComparison> compare_texture(const ObjectObservation& observation, const ProjectedView& look,
                                                const DepthTolerance& tolerance);

/// Combines depth and colour: returns the square root of `depth_value` (DepthScore::value), whose noise would otherwise
/// drown the small colour differences between rotations of a round object, less a part where the colours do not explain
/// the observed ones. Returns `depth_value` itself where that is not above 0.
float joint_score(float depth_value, const std::optional<ColourComparison>& colour);

// Sums of compare_colours(), declared here for tests.

/// Columns of a compared point; values are centred, so that single precision suffices.
enum ColourColumn : Eigen::Index {
  kLightness,
  kNormal,
  kOne = kNormal + 3,
  kA,
  kB,
  kObservedLightness,
  kObservedA,
  kObservedB,
  kColourColumns
};
using ColourProducts = Eigen::Matrix<double, kColourColumns, kColourColumns>;  ///< mean products of the columns

/// Holds a compared point in vectors of four.
struct ComparedPoint {
  Eigen::Array4f model, observed;  ///< L*, a*, b* and 1
  Eigen::Array4f normal;           ///< its coordinates and 1
};

/// Sums of those products that are asked for. Only sums of normals are ever rounded: colours are whole numbers.
class ColourSums {
 public:
  /// Adds points in blocks, so that the sums stay in registers.
  template <typename Points>
  void add(const Points& points, std::size_t count) {
    ColourSums sums = *this;
    for (std::size_t i = 0; i < count; ++i) sums.add(points[i]);
    *this = sums;
  }

  int count() const { return count_; }

  ColourSums& operator+=(const ColourSums& other) {
    model_ += other.model_;
    observed_ += other.observed_;
    model_model_ += other.model_model_;
    model_observed_ += other.model_observed_;
    observed_observed_ += other.observed_observed_;
    normal_model_ += other.normal_model_;
    normal_observed_ += other.normal_observed_;
    normal_x_ += other.normal_x_;
    normal_y_ += other.normal_y_;
    normal_z_ += other.normal_z_;
    count_ += other.count_;
    return *this;
  }

  /// Returns the mean products of at least one point. Entries that were not summed are 0.
  ColourProducts means() const {
    ColourProducts products = ColourProducts::Zero();
    const auto set = [&](Eigen::Index a, Eigen::Index b, float sum) {
      products(a, b) = products(b, a) = static_cast<double>(sum) / static_cast<double>(count_);
    };
    constexpr std::array<Eigen::Index, 3> kModel = {kLightness, kA, kB};
    constexpr std::array<Eigen::Index, 3> kObserved = {kObservedLightness, kObservedA, kObservedB};
    const std::array<const Eigen::Array4f*, 3> normals = {&normal_x_, &normal_y_, &normal_z_};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto i = static_cast<Eigen::Index>(c);
      set(kModel[c], kOne, model_[i]);
      set(kObserved[c], kOne, observed_[i]);
      set(kModel[c], kModel[c], model_model_[i]);
      set(kModel[c], kObserved[c], model_observed_[i]);
      set(kObserved[c], kObserved[c], observed_observed_[i]);
      set(kNormal + i, kLightness, normal_model_[i]);
      set(kNormal + i, kObservedLightness, normal_observed_[i]);
      set(kNormal + i, kOne, (*normals[c])[3]);
      for (Eigen::Index j = 0; j <= i; ++j) set(kNormal + i, kNormal + j, (*normals[c])[j]);
    }
    set(kOne, kOne, static_cast<float>(count_));
    return products;
  }

 private:
  void add(const ComparedPoint& point) {
    model_ += point.model;
    observed_ += point.observed;
    model_model_ += point.model * point.model;
    model_observed_ += point.model * point.observed;
    observed_observed_ += point.observed * point.observed;
    normal_model_ += point.model[0] * point.normal;
    normal_observed_ += point.observed[0] * point.normal;
    normal_x_ += point.normal[0] * point.normal;
    normal_y_ += point.normal[1] * point.normal;
    normal_z_ += point.normal[2] * point.normal;
    ++count_;
  }

  Eigen::Array4f model_ = Eigen::Array4f::Zero();
  Eigen::Array4f observed_ = Eigen::Array4f::Zero();
  Eigen::Array4f model_model_ = Eigen::Array4f::Zero();
  Eigen::Array4f model_observed_ = Eigen::Array4f::Zero();
  Eigen::Array4f observed_observed_ = Eigen::Array4f::Zero();
  Eigen::Array4f normal_model_ = Eigen::Array4f::Zero();     // times the own lightness
  Eigen::Array4f normal_observed_ = Eigen::Array4f::Zero();  // times the seen lightness
  Eigen::Array4f normal_x_ = Eigen::Array4f::Zero();
  Eigen::Array4f normal_y_ = Eigen::Array4f::Zero();
  Eigen::Array4f normal_z_ = Eigen::Array4f::Zero();
  int count_ = 0;
};

}  // namespace houghstream
