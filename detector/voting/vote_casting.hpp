#pragma once

#include <vector>

#include "detector/voting/hough_space.hpp"
#include "pipeline/types/camera.hpp"

namespace houghstream {

/// The image of cells in which votes are counted.
struct CellGrid {
  CellGrid(const Camera& camera, int cell_px);

  std::uint32_t outside() const { return static_cast<std::uint32_t>(width * height); }

  int width = 0;  ///< cells
  int height = 0;
  float fx = 0.0F;  ///< of the camera, in cells; a cell's centre is at a half
  float fy = 0.0F;
  float cx = 0.0F;
  float cy = 0.0F;
};

/// Who casts votes, and where to.
struct CastInput {
  const Forest& forest;
  const PatchGrid& patches;
  const std::vector<Voter>& voters;
  const CellGrid& grid;
};

/// Casts the votes of all voters, several at once: the same on every machine, since each vote's numbers depend on it
/// alone. What `cast` held is overwritten and its memory used again.
void cast_all(const CastInput& input, CastVotes& cast);

}  // namespace houghstream
