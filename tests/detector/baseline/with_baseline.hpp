#pragma once

#include "detector/baseline/use_baseline.hpp"

namespace houghstream::baseline {

/// The tests that include this have the baseline, as have all that are linked with them.
inline const bool kWithBaseline = [] {
  use_baseline();
  return true;
}();

}  // namespace houghstream::baseline
