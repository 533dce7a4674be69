// Compiled once for each instruction set, see foreach_target.h of Highway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/features/tile_extremes.cpp"
#include "detector/features/tile_extremes.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace houghstream::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Calls store(largest, smallest, x) for each vector of a row's pixels.
template <class D, typename T = hn::TFromD<D>, class Store>
HWY_INLINE void row_extremes(D d, const TilePlane<T>& plane, Neighbourhood around, int y, const Store& store) {
  T largest_of_columns[kWidestRow];
  T smallest_of_columns[kWidestRow];
  T* largest = largest_of_columns + kWidestMargin;
  T* smallest = smallest_of_columns + kWidestMargin;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  for (int x = -around.before(); x < plane.width() + around.after(); x += lanes) {
    const T* first = plane.row(y - around.before()) + x;
    auto most = hn::LoadU(d, first);
    auto least = most;
    for (int i = 1; i < around.side; ++i) {
      const auto value = hn::LoadU(d, first + i * plane.stride());
      most = hn::Max(most, value);
      least = hn::Min(least, value);
    }
    hn::StoreU(most, d, largest + x);
    hn::StoreU(least, d, smallest + x);
  }
  for (int x = 0; x < plane.width(); x += lanes) {
    auto most = hn::LoadU(d, largest + x - around.before());
    auto least = hn::LoadU(d, smallest + x - around.before());
    for (int i = 1; i < around.side; ++i) {
      most = hn::Max(most, hn::LoadU(d, largest + x - around.before() + i));
      least = hn::Min(least, hn::LoadU(d, smallest + x - around.before() + i));
    }
    store(most, least, x);
  }
}

void bytes(const TilePlane<std::uint8_t>& plane, Neighbourhood around, int largest, int smallest, TileRows& rows) {
  const hn::CappedTag<std::uint8_t, TilePlane<std::uint8_t>::kVector> d;
  for (int y = 0; y < plane.height(); ++y) {
    std::uint8_t* most_row = rows.row(y, largest);
    std::uint8_t* least_row = rows.row(y, smallest);
    row_extremes(d, plane, around, y, [&](auto most, auto least, int x) HWY_ATTR {
      hn::StoreU(most, d, most_row + x);
      hn::StoreU(least, d, least_row + x);
    });
  }
}

void steps(const TilePlane<std::uint16_t>& plane, Neighbourhood around, StepBytes kind, int largest, int smallest,
           TileRows& rows) {
  const hn::CappedTag<std::uint16_t, TilePlane<std::uint16_t>::kVector / 2> d;
  const hn::Rebind<std::uint8_t, decltype(d)> half;
  const auto byte = hn::Set(d, 255);
  const auto to_byte = [&](auto value) HWY_ATTR {
    const auto limited = kind == StepBytes::kWrapped ? hn::And(value, byte) : hn::Min(value, byte);
    return hn::DemoteTo(half, hn::BitCast(hn::RebindToSigned<decltype(d)>(), limited));
  };
  for (int y = 0; y < plane.height(); ++y) {
    std::uint8_t* most_row = rows.row(y, largest);
    std::uint8_t* least_row = rows.row(y, smallest);
    row_extremes(d, plane, around, y, [&](auto most, auto least, int x) HWY_ATTR {
      hn::StoreU(to_byte(most), half, most_row + x);
      hn::StoreU(to_byte(least), half, least_row + x);
    });
  }
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {

HWY_EXPORT(bytes);
HWY_EXPORT(steps);

void byte_extremes(const TilePlane<std::uint8_t>& plane, Neighbourhood around, int largest, int smallest,
                   TileRows& rows) {
  HWY_DYNAMIC_DISPATCH(bytes)(plane, around, largest, smallest, rows);
}

void step_extremes(const TilePlane<std::uint16_t>& plane, Neighbourhood around, StepBytes bytes, int largest,
                   int smallest, TileRows& rows) {
  HWY_DYNAMIC_DISPATCH(steps)(plane, around, bytes, largest, smallest, rows);
}

}  // namespace houghstream
#endif
