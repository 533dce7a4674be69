#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "detector/evidence/colour_similarity.hpp"
#include "detector/features/working_frame.hpp"
#include "detector/forest/forest.hpp"
#include "pipeline/geometry/boundary_sample.hpp"
#include "pipeline/types/chroma_map.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Holds a frame with its colours in the colour space of view templates, CIE L*a*b*.
struct LabFrame {
  const RgbdFrame& frame;
  LabLevels lab;       ///< levels of make_smoothed_lab()
  float scale = 1.0F;  ///< size of the first level over the frame's
  /// Map from taught colours to those of the camera, by class index, which is applied to views before they are
  /// compared. Empty: colours are compared as they were taught.
  std::vector<ChromaMap> chroma_maps = {};
};

/// Match of a view template at a hypothesis' centre with the frame. The first four are fractions of the template's
/// surface and sum to 1.
struct TemplateMatch {
  float visible_fraction = 0.0F;   ///< fraction whose depth is that of the template
  float occluded_fraction = 0.0F;  ///< fraction that a nearer surface occludes
  /// Fraction behind which a farther surface is measured: the object cannot be there.
  float free_space_violation = 0.0F;
  float no_depth_fraction = 0.0F;     ///< fraction without measured depth
  float depth_residual = 0.0F;        ///< mean error of the visible depth over the tolerance, 0 to 1
  float rim_continuation = 0.0F;      ///< fraction of the rim beside the outline to which the surface continues
  float colour_correlation = 0.0F;    ///< correlation of the visible or unknown colours with the template's, -1 to 1
  float mean_chroma_distance = 0.0F;  ///< see ColourSimilarity
  float hue_mismatch = 0.0F;          ///< see ColourSimilarity
  float chroma_deficit = 0.0F;        ///< see ColourSimilarity
  float log_contrast_ratio = 0.0F;    ///< see ColourSimilarity
  MeanColours colours;                ///< mean colours of the compared cells
  cv::Rect2f visible_box_px;          ///< box of what is visible or unknown, frame pixels; may be empty
};

/// Continuation of surface and colour across the outline of a template, each as a fraction of the outline, 0 to 1; 0
/// where nothing of it is seen. A part of a larger or longer thing looks like the object within the outline only. Depth
/// cannot tell where the object touches what it stands on; that its colour, or the slope of its surface, continues
/// there can. (Alexe, Deselaers and Ferrari 2010 tell objects by the contrast of a window with its surroundings.)
class BoundaryContinuation {
 public:
  /// Adds a sample of the boundary. `tolerance` is that of depth, metres.
  void add(const BoundarySample& sample, float tolerance) {
    const float surface = houghstream::surface_continuation(sample, tolerance);
    ++count_;
    surface_ += surface;
    colour_ += is_background_step(sample, tolerance) ? 0.0F : uniform_colour_continuation(sample);
    both_ += surface * houghstream::textured_colour_continuation(sample);
  }

  float surface() const { return fraction(surface_); }  ///< fraction across which the surface continues straight
  /// Fraction across which the colour continues, with no step back in depth.
  float colour() const { return fraction(colour_); }
  float joint() const { return fraction(both_); }  ///< fraction across which the surface continues in the same colour

 private:
  float fraction(float sum) const { return count_ > 0 ? sum / static_cast<float>(count_) : 0.0F; }

  int count_ = 0;
  float surface_ = 0.0F;
  float colour_ = 0.0F;
  float both_ = 0.0F;
};

/// The cells of a placed template that are visible, or whose depth is not known.
class UnoccludedCells {
 public:
  UnoccludedCells(const ViewTemplate& view, const Eigen::Vector3f& centre_camera, const RgbdFrame& frame);

  /// Returns the fraction of these cells whose middle lies in one of the others, 0 to 1.
  float fraction_in(const UnoccludedCells& other) const;

 private:
  bool contains(const cv::Point2f& px) const;

  cv::Rect2f cell_px_;                                     ///< the first cell, frame pixels
  std::array<std::uint32_t, TemplateGrid::kSide> rows_{};  ///< a bit for each column
};

/// Describes how a template is compared.
struct ComparisonOptions {
  float size = 1.0F;         ///< object size over the template's
  std::size_t row_step = 1;  ///< every row_step-th row of cells is compared
};

/// Compares a template with the frame, cell by cell, after moving it along the ray by at most a few centimetres to
/// where most of it agrees: the depth of a vote is less exact than that of a surface. Brightness, contrast and colour
/// cast, which the light decides, do not change the match.
TemplateMatch match_template(const ViewTemplate& view, const Eigen::Vector3f& centre_camera, const LabFrame& frame,
                             const ComparisonOptions& options = {});

/// Measures whether surface and colour end where the template's outline is. Places where something lies in front of the
/// object, within or beyond the outline, are left out.
BoundaryContinuation measure_boundary_continuation(const ViewTemplate& view, const Eigen::Vector3f& centre_camera,
                                                   const LabFrame& frame);

}  // namespace houghstream
