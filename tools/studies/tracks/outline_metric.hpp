#pragma once

#include <map>
#include <string>
#include <vector>

#include "drivers/files/json_file.hpp"
#include "pipeline/types/camera.hpp"
#include "pose/model/object_model.hpp"
#include "tools/studies/tracks/track_metrics.hpp"

namespace houghstream::studies {

/// Returns how far outlines of published poses stand beside the true ones in the image of the sequence's first camera:
/// by class the median over frames of the mean distance across the true outline, pixels. Counted where the object is
/// published and at least a third of it visible; a class that never is has no entry. Throws InputError where the
/// camera's scene cannot be read.
OrderedJson outline_metrics(const SequenceFile& sequence, const std::vector<MatchedPose>& poses,
                            const std::map<std::string, ObjectModel>& models);

/// Returns the mean distance in pixels, across the outline of the model at `truth`, to where its points are at `found`.
/// NaN where no point of the outline is before the camera.
double outline_distance_px(const ObjectModel& model, const Camera& camera, const Eigen::Isometry3d& truth,
                           const Eigen::Isometry3d& found);

}  // namespace houghstream::studies
