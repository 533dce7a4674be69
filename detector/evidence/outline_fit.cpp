#include "detector/evidence/outline_fit.hpp"

namespace houghstream {
namespace {

using Shares = std::array<float, Appearance::kMostCrossings>;

float mean(const Shares& shares, std::size_t count) {
  float sum = 0.0F;
  for (std::size_t i = 0; i < count; ++i) sum += shares[i];
  return sum / static_cast<float>(count);
}

}  // namespace

/// Each look by itself first, without branches, so that several are reckoned at once.
OutlineFit fit_outline(const OutlineLooks& looks, float tolerance) {
  if (looks.count == 0) return {};
  Shares surface;
  Shares colour;
  Shares both;
  for (std::size_t i = 0; i < looks.count; ++i) {
    const AcrossOutline& seen = looks.seen[i];
    const float plain = plain_colour_goes_on(seen);
    surface[i] = surface_goes_on(seen, tolerance);
    colour[i] = steps_back(seen, tolerance) ? 0.0F : plain;
    both[i] = surface[i] * colour_goes_on(seen);
  }
  return {mean(surface, looks.count), mean(colour, looks.count), mean(both, looks.count)};
}

}  // namespace houghstream
