#pragma once

#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream::reconstruction {

/// Share of the pixels of a view's mask and of the model's outline that both have, 0 to 1. The mask must not have been
/// made of the model.
double silhouette_iou(const Mesh& mesh, const TrainingView& view);

/// Moves each view's T_camera_object, without turning it, to where the model's outline fits the mask best and its
/// surface lies at the measured depth. For views whose turn is known better than their place, such as those of a
/// turntable whose axis is not known exactly. `mesh`: metres, object frame. Any number of threads gives the same
/// result.
void align_silhouettes(const Mesh& mesh, int threads, std::vector<TrainingView>& views);

}  // namespace houghstream::reconstruction
