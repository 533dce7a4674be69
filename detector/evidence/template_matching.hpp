#pragma once

#include <Eigen/Core>
#include <vector>

#include "detector/evidence/boundary_continuation.hpp"
#include "detector/evidence/likeness.hpp"
#include "detector/features/working_frame.hpp"
#include "detector/forest/forest.hpp"
#include "pipeline/types/chroma_map.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

/// A frame with its colours as views remember them.
struct LabFrame {
  const RgbdFrame& frame;
  LabLevels lab;       ///< see make_smoothed_lab
  float scale = 1.0F;  ///< size of the first level over the frame's
  /// How the camera renders the colours of each class, by its index: views are brought to these colours before they are
  /// compared. Empty = as they were taught.
  std::vector<ChromaMap> cameras = {};
};

/// How a remembered training view, put at a hypothesis' centre, agrees with the depth image: shares of the view's
/// surface, the first four of which sum to 1.
struct TemplateMatch {
  float visible = 0.0F;         ///< depth as remembered
  float hidden = 0.0F;          ///< something is in front of it
  float seen_through = 0.0F;    ///< what is there lies behind: the object cannot be there
  float unknown = 0.0F;         ///< no depth
  float unevenness = 0.0F;      ///< mean error of the visible depth over the tolerance, 0 to 1
  float continued = 0.0F;       ///< of the rim beside the outline: the surface goes on, or comes nearer
  float likeness = 0.0F;        ///< of the colours of what is visible or unknown with the remembered ones, -1 to 1
  float foreign_colour = 0.0F;  ///< see Likeness
  float hue_conflict = 0.0F;    ///< see Likeness
  float paleness = 0.0F;        ///< see Likeness
  float contrast = 0.0F;        ///< see Likeness
  MeanColours colours;          ///< of the compared cells
  cv::Rect2f visible_box_px;    ///< of what is visible or unknown, frame pixels; empty where nothing is
};

/// The view's relief compared with the frame, pixel by pixel of the relief, after moving it along the ray by at most
/// a few centimetres to where most of it agrees: a vote's depth is less exact than a surface's.
/// The likeness is blind to brightness, contrast and colour cast, which the light decides. With a `size` other than 1
/// the view is taken for one of an object so many times as large.
TemplateMatch match_template(const ViewTemplate& view, const Eigen::Vector3f& centre_camera, const LabFrame& frame,
                             float size = 1.0F);

/// Whether what is seen ends where the view's outline is. What lies in front of the object, within or beyond, has no
/// say.
BoundaryContinuation measure_boundary_continuation(const ViewTemplate& view, const Eigen::Vector3f& centre_camera,
                                                   const LabFrame& frame);

}  // namespace houghstream
