#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "drivers/files/json_file.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "tools/studies/tracks/track_metrics.hpp"

namespace houghstream::studies {

/// Holds the points and the diameter from which ADD is computed.
struct AddModel {
  std::vector<Eigen::Vector3f> points;  ///< of the surface, object frame, metres
  double diameter_m = 0.0;
};

/// Makes a model of a few hundred points of the mesh's surface, with its diameter.
AddModel make_add_model(const Mesh& mesh);

/// Computes ADD of published poses (Hinterstoisser et al. 2012: mean distance between points of the model under both
/// poses; of the poses that look the same as the true one, the nearest), beside a tenth of the diameter:
///
///   "add"              by class: share of the frames in which the object is there whose pose is below it; a frame in
///                      which it is not published counts as one that is not
///   "median_error"     by class, of what is published and at least a third visible: "mm" between the points' means,
///                      "deg" about any axis
///   "wrong_above_0_9"  of what was published with a quality above 0.9: "published", and "wrong", which is above it
OrderedJson add_metrics(const std::vector<MatchedPose>& poses, const std::map<std::string, AddModel>& models);

}  // namespace houghstream::studies
