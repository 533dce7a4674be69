#pragma once

#include "pipeline/geometry/boundary_sample.hpp"

namespace houghstream {

/// Whether what a hypothesis takes for the object ends where the object's outline is: shares of the outline, 0 to 1; 0
/// where nothing of it is seen. A part of a larger thing, or of a longer one, looks like the object within the outline
/// only. Depth cannot tell it where the object touches what it stands on; that its colour goes on, or its own slope,
/// can. (By the contrast of a window with what surrounds it Alexe, Deselaers and Ferrari 2010 tell objects.)
class BoundaryContinuation {
 public:
  /// `tolerance`: of depth, metres.
  void add(const BoundarySample& seen, float tolerance) {
    const float surface = houghstream::surface_goes_on(seen, tolerance);
    ++count_;
    surface_ += surface;
    colour_ += is_background_step(seen, tolerance) ? 0.0F : uniform_colour_continuation(seen);
    both_ += surface * houghstream::colour_goes_on(seen);
  }

  float surface_goes_on() const { return share(surface_); }  ///< straight on from within
  float colour_goes_on() const { return share(colour_); }    ///< the same colour, with no step back in depth
  float goes_on() const { return share(both_); }             ///< the surface, in the same colour

 private:
  float share(float sum) const { return count_ > 0 ? sum / static_cast<float>(count_) : 0.0F; }

  int count_ = 0;
  float surface_ = 0.0F;
  float colour_ = 0.0F;
  float both_ = 0.0F;
};

}  // namespace houghstream
