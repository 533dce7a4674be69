#include "detector/evidence/outline_fit.hpp"

#include <algorithm>
#include <cmath>

namespace houghstream {
namespace {

/// 1 at 0, falling as a Gaussian of variance 1 does, to nothing at 8. Its exponential would take most of the time.
float falling(float square) {
  const float base = std::max(0.0F, 1.0F - 0.125F * square);
  return (base * base) * (base * base);
}

float sum(const OutlineLooks::Numbers& numbers, std::size_t count) {
  float total = 0.0F;
  for (std::size_t i = 0; i < count; ++i) total += numbers[i];
  return total;
}

}  // namespace

/// Each look by itself first, without branches, so that several are reckoned at once.
OutlineFit fit_outline(const OutlineLooks& looks, float tolerance) {
  constexpr float kPlain = 1.0F / 16.0F;    // over the squared distance of colours that a plain thing has
  constexpr float kPrinted = 1.0F / 36.0F;  // where the surface goes on, more of it may be print
  constexpr float kUnknown = 0.5F;
  OutlineLooks::Numbers surface;
  OutlineLooks::Numbers colour;
  OutlineLooks::Numbers both;
  for (std::size_t i = 0; i < looks.count; ++i) {
    const float slack = 0.4F * looks.apart[i] + 0.25F * tolerance;  // surfaces bend
    const float off = looks.gained[i] - looks.expected[i];
    const float straight = falling(off * off / (slack * slack));
    surface[i] = std::isnan(off) ? kUnknown : straight;
    colour[i] = looks.gained[i] > 2.0F * tolerance + looks.apart[i] ? 0.0F : falling(looks.colour_sq[i] * kPlain);
    both[i] = surface[i] * falling(looks.colour_sq[i] * kPrinted);
  }
  OutlineFit fit;
  if (looks.count == 0) return fit;
  const float share = 1.0F / static_cast<float>(looks.count);
  fit.surface_goes_on = share * sum(surface, looks.count);
  fit.colour_goes_on = share * sum(colour, looks.count);
  fit.goes_on = share * sum(both, looks.count);
  return fit;
}

}  // namespace houghstream
