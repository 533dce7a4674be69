#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "pipeline/base/settings_fields.hpp"
#include "pipeline/types/frame.hpp"
#include "pose/following/colour_statistics.hpp"
#include "pose/following/silhouette.hpp"
#include "pose/registration/depth_equations.hpp"
#include "pose/seen/region.hpp"

namespace houghstream {

/// Region modality: where along lines across the silhouette the colours of the object end and those beside it begin
/// (Prisacariu and Reid 2012; Tjaden et al. 2018). Lines, smoothed step functions and their posterior in closed form
/// are those of Stoiber et al. (2022, "SRT3D: A Sparse Region-Based 3D Object Tracking Approach for the Real World";
/// 2022, "Iterative Corresponding Geometry").
struct RegionModalitySettings {
  int lines = 100;             ///< maximum number of lines across the silhouette; 0: colours play no part
  double colour_rate = 0.2;    ///< fraction by which a frame moves the histograms
  double occlusion_m = 0.015;  ///< depth nearer than the model by so much and 3 sigma covers a line
  /// Standard deviation by which all edges of an object err outwards alike, and by which those err towards the darker
  /// side alike: a lens and a tone curve move edges of light, and mixed pixels look like the side of more colours.
  double common_error_px = 3.0;
};

template <typename Visit>
void fields(const RegionModalitySettings& /*settings*/, const Visit& visit) {
  using S = RegionModalitySettings;
  visit(number("lines", &S::lines, 0, 10000));
  visit(number("colour_rate", &S::colour_rate, 0, 1));
  visit(number("occlusion_m", &S::occlusion_m, 0, 1, "m"));
  visit(number("common_error_px", &S::common_error_px, 0, 100, "pixels"));
}

/// Scale of a region step: pixels along a line that make one segment, and the standard deviation of a line's edge,
/// pixels.
struct RegionScale {
  int segment_px = 1;
  double sigma_px = 1.5;
  int every = 1;  ///< every so many points of the silhouette make a line, which weighs as many
};

/// Number of segments of a line over which the posterior of its edge is computed.
constexpr int kEdgePositions = 12;

/// A line across the silhouette, and where the frame has its edge.
struct RegionLine {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();      ///< point of the silhouette, object frame, metres
  Eigen::Vector2f centre_px = Eigen::Vector2f::Zero();  ///< place of the point when the line was drawn
  Eigen::Vector2f normal = Eigen::Vector2f::Zero();     ///< unit vector out of the model
  float segments_per_px = 1.0F;                         ///< segments per pixel along the normal
  float first = 0.0F;     ///< position of the first of `posterior`, segments outwards from the point
  float mean = 0.0F;      ///< mean of the edge's position, segments outwards from the point
  float variance = 1.0F;  ///< variance of that position, segments^2
  float contrast = 0.0F;  ///< brightness of the side of the model beside the other one, -1 to 1
  /// Probabilities of the edge's position, one segment after the other; their sum is 1.
  std::array<float, kEdgePositions> posterior{};
};

/// Lines across a silhouette in a frame, with the number of points that gave none.
struct RegionLines {
  std::vector<RegionLine> lines;  ///< lines that have an edge
  int covered = 0;                ///< number of points behind nearer depth
  int blank = 0;                  ///< number of lines whose colours have no edge
};

/// Inputs in which lines are drawn.
struct RegionView {
  const RgbdFrame& frame;
  const ObjectModel& model;
  DepthNoise noise;
};

/// Returns how far a point, camera frame, metres, moves along a direction of the image, times the direction's length,
/// for a unit of each coordinate of MotionEquations: pixels a metre for a unit direction. `centre` is the model's,
/// camera frame, metres.
Vector6d image_motion_row(const RegionView& view, const Eigen::Vector3d& point, const Eigen::Vector2d& direction,
                          const Eigen::Vector3d& centre);

/// Adds weight * row * row^T to the lower triangle of a hessian, bit for bit as Eigen's rankUpdate() does, whose
/// general code takes several times as long for so small a matrix.
inline void add_outer_product(const Vector6d& row, double weight, Matrix6d& hessian) {
  for (Eigen::Index j = 0; j < row.size(); ++j) {
    const double weighted = weight * row[j];
    for (Eigen::Index i = j; i < row.size(); ++i) hessian(i, j) += weighted * row[i];
  }
}

/// Draws a line through each point of the silhouette at the pose and finds its edge. Left out are points that nearer
/// depth occludes, also where it lies beside them, lines on which the model begins again or ends within three segments,
/// and lines all of whose colours are those of one side.
RegionLines find_region_lines(const RegionView& view, const Silhouette& silhouette, const ColourStatistics& colours,
                              const Eigen::Isometry3d& T_camera_object, const RegionScale& scale,
                              const RegionModalitySettings& settings);

/// Place from which a line's edge attracts the pose: the mean of its posterior reaches far, its gradient at the pose is
/// more exact.
enum class EdgeStep { kToMean, kAlongGradient };

/// Returns the normal equations of the motion that brings the silhouette of a pose to the edges, as build_equations()
/// has them, in the inverse square of metres: the hessian is the information of the edges.
MotionEquations region_equations(const RegionView& view, const std::vector<RegionLine>& lines,
                                 const Eigen::Isometry3d& T_camera_object, const RegionScale& scale, EdgeStep step,
                                 const RegionModalitySettings& settings);

/// Learns a frame's colours inside the silhouette at the pose and outside it, near to it and not covered.
void learn_colours(const RegionView& view, const Silhouette& silhouette, const Eigen::Isometry3d& T_camera_object,
                   const RegionModalitySettings& settings, ColourStatistics& colours);

/// Returns the part of the image about the silhouette at the pose, a little enlarged; it may be empty.
cv::Rect silhouette_box(const RegionView& view, const Silhouette& silhouette, const Eigen::Isometry3d& T_camera_object);

}  // namespace houghstream
