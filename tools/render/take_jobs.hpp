#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/render/render_jobs.hpp"

namespace houghstream::render {

/// Selects the takes to render, and their length.
struct TakesJob {
  std::vector<std::string> objects = {"all"};  ///< names among the twelve, or only "all"
  std::optional<int> take;                     ///< 1 or 2, without it both
  int frames = 240;
  double fps = 15.0;         ///< frames per second of the motion; 1 to 120
  int world = 0;             ///< 0 to 999: another room, lighting and movement for each
  bool development = false;  ///< rooms of training seeds, to choose settings on
};

/// Renders OUT/test/00000N/ for each take, a BOP scene with ground truth for every frame, OUT/models/ and
/// OUT/takes.json, which names scene, object, id, kind, take, frames and fps of each. See world/takes/take.hpp. Throws
/// InputError for an object without takes.
void render_takes(const RenderOptions& options, const TakesJob& job);

}  // namespace houghstream::render
