#pragma once

#include <cstdint>
#include <vector>

#include "detector/evidence/template_matching.hpp"

namespace houghstream {

/// How well a view agrees with the frame; larger is better.
float agreement(const TemplateMatch& fit);

/// A remembered view, and how it agrees with the frame where it stands.
struct PlacedTemplate {
  std::uint32_t view = 0;  ///< in the forest's
  Eigen::Vector3f centre_camera = Eigen::Vector3f::Zero();
  TemplateMatch fit;
};

/// Moves the view sideways, by cells of its relief or parts of them and at most a few times, to where it agrees best:
/// votes meet within a few centimetres only. The result agrees at least as well.
PlacedTemplate align_template(const std::vector<ViewTemplate>& views, PlacedTemplate placed, const LabFrame& frame,
                              float step_cells = 1.0F);

/// The one that agrees best where it stands; ties go to the first. `compared` is not empty.
const PlacedTemplate& best_match(const std::vector<PlacedTemplate>& compared);

/// Sorts the views by how they agree where they stand, best first, aligns the first few, and returns that which then
/// agrees best. `compared` is not empty.
PlacedTemplate align_best_templates(const std::vector<ViewTemplate>& views, const LabFrame& frame,
                                    std::vector<PlacedTemplate>& compared);

/// How much better the view agrees where it stands if it is taken for one of a smaller or larger object, whichever
/// agrees better; mostly below 0 if the object has its own size.
float alternative_scale_gain(const ViewTemplate& view, const PlacedTemplate& placed, const LabFrame& frame);

}  // namespace houghstream
