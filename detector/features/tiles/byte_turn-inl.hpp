// Compiled once for each instruction set: no #pragma once, but Highway's guard.
#if defined(HOUGHSTREAM_BYTE_TURN_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef HOUGHSTREAM_BYTE_TURN_INL_HPP
#undef HOUGHSTREAM_BYTE_TURN_INL_HPP
#else
#define HOUGHSTREAM_BYTE_TURN_INL_HPP
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace houghstream::HWY_NAMESPACE {

constexpr int kTurnSide = 16;  // bytes of a block of a vector

#if HWY_TARGET != HWY_SCALAR

/// Turns squares of kTurnSide x kTurnSide bytes about their diagonal: byte j of row i becomes byte i of row j, in each
/// block of the vectors of tag `d`.
template <class D>
HWY_INLINE void turn_bytes(D d, hwy::HWY_NAMESPACE::Vec<D> (&rows)[kTurnSide]) {
  namespace hn = hwy::HWY_NAMESPACE;
  for (int round = 0; round < 4; ++round) {  // each one merges row i with row i + 8
    hn::Vec<D> merged[kTurnSide];
    for (int i = 0; i < kTurnSide / 2; ++i) {
      merged[2 * i] = hn::InterleaveLower(d, rows[i], rows[i + kTurnSide / 2]);
      merged[2 * i + 1] = hn::InterleaveUpper(d, rows[i], rows[i + kTurnSide / 2]);
    }
    for (int i = 0; i < kTurnSide; ++i) rows[i] = merged[i];
  }
}

#endif

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
