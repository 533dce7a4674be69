#pragma once

#include "pipeline/geometry/mesh.hpp"
#include "tools/studies/recorded/mesh_alignment.hpp"

namespace houghstream {

/// A scanned mesh made a model of the training views.
struct ScanModel {
  Mesh mesh;                ///< object frame of the views, metres; without the base's disc, in the views' colours
  MeshAlignment alignment;  ///< T_target_source maps the scan's frame to that of the views
};

/// The scan's frame is its scanner's; that of the views has z up and its origin on the turntable's axis. The scan is
/// registered to `fused`, the model made of the views, what lies less than `base_m` metres above its base is dropped
/// (scanned ground, not object), as are specks, and it is registered once more. Its colours are those of `fused` at the
/// nearest points, where that has any. Throws InputError for meshes without surface, or where nothing is left.
ScanModel fit_scan(const Mesh& scan, const Mesh& fused, double base_m);

}  // namespace houghstream
