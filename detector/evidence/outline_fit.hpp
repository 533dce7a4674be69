#pragma once

#include <array>
#include <cstddef>
#include <tuple>

#include "detector/evidence/appearance.hpp"

namespace houghstream {

/// What is seen across an outline, from within the object to beyond it: the first `count` of each.
struct OutlineLooks {
  using Numbers = std::array<float, std::tuple_size_v<decltype(Appearance::outline)>>;
  std::size_t count = 0;
  Numbers apart;   ///< metres from one to the other, across the ray
  Numbers gained;  ///< depth, metres; NaN where it is not measured
  /// Gained if the object's surface goes on straight, metres; NaN where that is not known.
  Numbers expected;
  Numbers colour_sq;  ///< squared distance of the colours, 8-bit L*a*b*, lightness at half its weight
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
