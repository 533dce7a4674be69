#include "pose/fusion/fuse_views.hpp"

#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"
#include "pose/fusion/surface_nets.hpp"
#include "pose/fusion/view_colours.hpp"

namespace houghstream::fusion {

FusedModel fuse_views(const std::string& name, const std::vector<TrainingView>& views, const FusionSettings& settings) {
  require(!views.empty(), "{}: no views, expected some to fuse", name);
  std::vector<DepthView> depth_views(views.size());
  parallel_for(settings.threads, static_cast<int>(views.size()),
               [&](int i) { depth_views[i] = make_depth_view(views[i]); });
  AlignmentSettings alignment = settings.alignment;
  alignment.threads = settings.threads;
  FusedModel model;
  model.before = measure_alignment_error(depth_views, alignment);
  if (settings.align) align_views(depth_views, alignment);
  model.after = settings.align ? measure_alignment_error(depth_views, alignment) : model.before;
  TsdfSettings grid = settings.grid;
  grid.threads = settings.threads;
  try {
    model.mesh = largest_part(extract_surface(integrate_views(depth_views, grid)));
  } catch (const InputError& error) {
    fail("{}: {}", name, error.what());
  }
  require(!model.mesh.triangles.empty(), "{}: {} views without a common surface, expected one", name, views.size());
  model.seen = colour_mesh(depth_views, grid.truncation_voxels * grid.voxel, settings.threads, model.mesh);
  return model;
}

}  // namespace houghstream::fusion
