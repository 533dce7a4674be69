#pragma once

#include <array>
#include <cstddef>

#include "detector/evidence/appearance.hpp"
#include "pipeline/geometry/across_outline.hpp"

namespace houghstream {

/// What is seen across an outline: the first `count`.
struct OutlineLooks {
  std::size_t count = 0;
  std::array<AcrossOutline, Appearance::kMostCrossings> seen;
};

/// Whether what a hypothesis takes for the object ends where the object's outline is: shares of the outline, 0 to 1; 0
/// where nothing of it is seen. A part of a larger thing, or of a longer one, looks like the object within the outline
/// only. Depth cannot tell it where the object touches what it stands on; that its colour goes on, or its own slope,
/// can. (By the contrast of a window with what surrounds it Alexe, Deselaers and Ferrari 2010 tell objects.)
struct OutlineFit {
  float surface_goes_on = 0.0F;  ///< straight on from within
  float colour_goes_on = 0.0F;   ///< the same colour, with no step back in depth
  float goes_on = 0.0F;          ///< the surface, in the same colour
};

/// `tolerance`: of depth, metres.
OutlineFit fit_outline(const OutlineLooks& looks, float tolerance);

}  // namespace houghstream
