#pragma once

#include <gtest/gtest.h>
#include <hwy/highway.h>

namespace houghstream::simd {

inline void use(std::int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().DeInit();  // the next call selects the target again
}

/// Runs a check with every instruction set that the processor has.
template <typename Check>
void with_every_target(const Check& check) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    use(target);
    check();
  }
  use(0);
}

}  // namespace houghstream::simd
