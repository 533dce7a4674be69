#pragma once

#include <string>
#include <vector>

#include "pipeline/types/training_view.hpp"
#include "pose/reconstruction/take_model.hpp"

namespace houghstream::reconstruction {

/// Views of one object, whose poses mean one frame.
struct ModelOfViews {
  Mesh mesh;
  std::vector<bool> seen;  ///< per vertex
};

struct MaskedViews {
  std::vector<TrainingView> views;
  std::vector<int> lights;      ///< DepthView::light of each view; empty: all -1
  bool whole_pictures = false;  ///< false: cut out of larger ones, which go on around them
};

/// Fuses masked views from all sides (Curless & Levoy 1996). What hides the object in a view, within the outline of
/// `known`, says nothing; what is beside that outline is free, but beside whole pictures nothing is known. Where
/// `foot_m` is set, the object ends there: nobody has seen it from below. Throws InputError naming `name` where nothing
/// is left.
ModelOfViews fuse_masked_views(const std::string& name, const MaskedViews& views, const Mesh& known,
                               std::optional<double> foot_m, const ModelMaking& settings);

/// Registers views of an object to one another, by their masks' pixels alone, from poses that are nearly right, and
/// corrects their T_camera_object.
void register_views(std::vector<TrainingView>& views, int threads);

/// Adds a mesh's triangles to another one's.
void append_mesh(const Mesh& mesh, const Eigen::Isometry3d& T_to_from, Mesh& to);

/// The middle of what is lowest, on its height.
Eigen::Vector3d foot_of(const Mesh& mesh);

/// The keyframes of a take as views of its object.
std::vector<TrainingView> training_views(const Take& take, const std::vector<ShownView>& views,
                                         const std::string& name);

/// Lays the second take's model on the first and makes one of both, in the first one's frame; the views of both get
/// poses and masks of it, and agreement_m is that of all of them. False where the second does not fit, or what comes of
/// both is seen through (kMostSeenThrough): then nothing is changed.
bool merge_takes(const Take& first, ShownModel& model, const Take& second, ShownModel& other,
                 const ModelMaking& settings);

}  // namespace houghstream::reconstruction
