#pragma once

#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream::reconstruction {

/// Returns the intersection over union of a view's mask and the model's silhouette, 0 to 1. The mask must be
/// independent of the model.
double silhouette_iou(const Mesh& mesh, const TrainingView& view);

/// Translates each view's T_camera_object to where the model's silhouette fits the mask best and its surface lies at
/// the measured depth. It is meant for views whose rotation is known better than their position, such as those of a
/// turntable whose axis is not known exactly. `mesh`: metres, object frame. The result is the same for any number of
/// threads.
void align_silhouettes(const Mesh& mesh, int threads, std::vector<TrainingView>& views);

}  // namespace houghstream::reconstruction
