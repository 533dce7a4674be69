#pragma once

#include <string>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/training_view.hpp"
#include "pose/reconstruction/model/model_deviation.hpp"
#include "pose/reconstruction/tracking/take.hpp"

namespace houghstream::reconstruction {

/// Result of a take: model and views of its object.
struct ReconstructedModel {
  Mesh mesh;               ///< metres; origin at the middle of its foot, z up as it stood; closed, normals, colours
  std::vector<bool> seen;  ///< per vertex: some view shows it; the others close the surface
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();  ///< world: of the take
  std::vector<MaskedKeyframe> views;                                 ///< keyframes that show it, in their order
  double deviation_m = 0.0;           ///< surface_deviation() over all views of the model, metres
  double free_space_violation = 0.0;  ///< see free_space_violation()
};

struct ReconstructionSettings {
  double voxel_m = 0.0015;  ///< voxels of the model; twice that for an object larger than 0.3 m
  double coarse_voxel_m = 0.004;
  /// Height below which table and object cannot be separated: the object is continued downwards.
  double foot_m = 0.005;
  double margin_m = 0.01;  ///< margin about the object whose surface may belong to it
  int threads = 1;         ///< any number gives the same result
};

/// Reconstructs the model of a take's object: the keyframes are fused about its position (Curless & Levoy 1996), the
/// connected component above the table where the object was selected is kept, and the masks follow from that model and
/// the depth, so that they contain neither table nor hand. Throws InputError where there is no such component.
ReconstructedModel reconstruct_model(const Take& take, const ReconstructionSettings& settings);

/// Returns DepthView::lighting_id of the take's keyframes: `number` where the camera moved and the lighting was static
/// relative to the object, and -1 where the object moved.
int lighting_of(const Take& take, int number);

/// Surface that was fused from views of one object.
struct FusedSurface {
  Mesh mesh;
  std::vector<bool> seen;  ///< per vertex
};

/// Views of one object, with poses in one object frame.
struct MaskedViews {
  std::vector<TrainingView> views;
  std::vector<int> lighting_ids;  ///< DepthView::lighting_id of each view; empty: all -1
  bool whole_images = false;      ///< false: crops of larger images, which continue around them
};

/// Fuses masked views from all sides (Curless & Levoy 1996). Occluders in a view, within the outline of `prior_mesh`,
/// are ignored; space beside that outline is free, but beside whole images nothing is known. Where `foot_m` is set, the
/// object ends there, since no view shows it from below. Throws InputError naming `name` where nothing is left.
FusedSurface fuse_masked_views(const std::string& name, const MaskedViews& views, const Mesh& prior_mesh,
                               std::optional<double> foot_m, const ReconstructionSettings& settings);

/// Registers views of an object to one another, by their masks' pixels alone, from poses that are nearly right, and
/// corrects their T_camera_object.
void register_views(std::vector<TrainingView>& views, int threads);

/// Adds a mesh's triangles to another one's.
void append_mesh(const Mesh& mesh, const Eigen::Isometry3d& T_to_from, Mesh& to);

/// Returns the centre of the lowest centimetre of the mesh, at the height of its lowest vertex. Foot: the part with
/// which the object stands on the table.
Eigen::Vector3d foot_of(const Mesh& mesh);

/// Returns the keyframes of a take as views of its object.
std::vector<TrainingView> training_views(const Take& take, const std::vector<MaskedKeyframe>& views,
                                         const std::string& name);

/// Registers the second take's model to the first and fuses both into one, in the first one's frame; the views of both
/// get poses and masks of it, and deviation_m is that of all of them. Returns false where the second does not fit, or
/// the fused model violates free space (kMaxFreeSpaceViolation): then nothing is changed.
bool merge_takes(const Take& first, ReconstructedModel& model, const Take& second, ReconstructedModel& other,
                 const ReconstructionSettings& settings);

}  // namespace houghstream::reconstruction
