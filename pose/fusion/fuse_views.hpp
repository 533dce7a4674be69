#pragma once

#include <string>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/training_view.hpp"
#include "pose/fusion/axis_alignment.hpp"
#include "pose/fusion/tsdf_volume.hpp"

namespace houghstream::fusion {

/// Settings of the fusion of an object's training views into a model.
struct FusionSettings {
  TsdfSettings grid;
  AlignmentSettings alignment;
  bool align = true;  ///< false where T_camera_object is exact, as in rendered views
  int threads = 1;    ///< any number gives the same result
};

/// A model and how it came about.
struct FusedModel {
  Mesh mesh;                     ///< object frame of the views, metres; closed, with normals and colours
  std::vector<bool> seen;        ///< per vertex: some view shows it; the others close the surface
  AlignmentError before, after;  ///< errors of the views, before and after their alignment
};

/// Makes a model of one object of which there is no CAD model, from views with depth, mask and pose: the views are
/// laid on each other, their distances are fused in a grid (Curless & Levoy 1996), and the surface of its largest part
/// is coloured by the views. What was never seen is closed: a standing object by a flat bottom at its lowest seen
/// height, other gaps by what the outlines leave. Throws InputError naming `name` where there is nothing to fuse.
FusedModel fuse_views(const std::string& name, const std::vector<TrainingView>& views, const FusionSettings& settings);

}  // namespace houghstream::fusion
