#pragma once

#include <string>
#include <vector>

#include "tools/render/render_jobs.hpp"

namespace houghstream::render {

/// Selects the sequences to render, and their frame rate.
struct SequencesJob {
  std::vector<std::string> names = {"all"};  ///< names of world/sequences/sequence_plan.hpp, or only "all"
  double fps = 30.0;                         ///< 1 to 120
  bool development = false;                  ///< rooms of training seeds, to choose settings on
};

/// OUT/NAME/00000C/ for each sequence and camera C from 1 on, a BOP scene with truth for every frame, OUT/models/, and
/// OUT/NAME/sequence.json:
///
///   "name", "fps"
///   "objects": [{"instance", "object_id", "name"}], instances from 1, two may be equal objects
///   "cameras": [{"scene", "channel"}]
///   "frames": [{"utime", "objects": per instance, "cameras": [{"T_world_camera", "visible": per instance}]}]
///
/// Poses are x, y, z in metres and w, x, y, z of a unit quaternion, null for an object that has been taken away;
/// `visible` is the share of the object's silhouette that the camera sees, 0 where it sees less than 50 pixels. Throws
/// InputError for an unknown name.
void render_sequences(const RenderOptions& options, const SequencesJob& job);

}  // namespace houghstream::render
