// Compiled once for each instruction set, see foreach_target.h of Highway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/features/tile_extremes.cpp"
#include "detector/features/tile_extremes.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace houghstream::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Extremes {
  V maximum;
  V minimum;
};

/// Returns the extremes of `side` vectors, `step` values apart.
template <int kSide, class D, typename T, class V = hn::Vec<D>>
HWY_INLINE Extremes<V> extremes(D d, const T* largest, const T* smallest, std::ptrdiff_t step, int side) {
  Extremes<V> found{hn::LoadU(d, largest), hn::LoadU(d, smallest)};
  const int count = kSide > 0 ? kSide : side;
  for (int i = 1; i < count; ++i) {
    found.maximum = hn::Max(found.maximum, hn::LoadU(d, largest + i * step));
    found.minimum = hn::Min(found.minimum, hn::LoadU(d, smallest + i * step));
  }
  return found;
}

/// Calls store(largest, smallest, x, y) for each vector of pixels. `kSide` is that of the neighbourhood where it is
/// known beforehand, else 0.
template <int kSide, class D, typename T = hn::TFromD<D>, class Store>
HWY_INLINE void for_extremes(D d, const TilePlane<T>& plane, Neighbourhood around, const Store& store) {
  const auto lanes = static_cast<int>(hn::Lanes(d));
  T largest_of_columns[kWidestRow];
  T min_of_columns[kWidestRow];
  T* largest = largest_of_columns + kWidestMargin;
  T* smallest = min_of_columns + kWidestMargin;
  const int before = around.before();
  for (int y = 0; y < plane.height(); ++y) {
    const T* first = plane.row(y - before);
    for (int x = -before; x < plane.width() + around.after(); x += lanes) {
      const auto column = extremes<kSide>(d, first + x, first + x, plane.stride(), around.side);
      hn::StoreU(column.maximum, d, largest + x);
      hn::StoreU(column.minimum, d, smallest + x);
    }
    for (int x = 0; x < plane.width(); x += lanes) {
      const auto square = extremes<kSide>(d, largest + x - before, smallest + x - before, 1, around.side);
      store(square.maximum, square.minimum, x, y);
    }
  }
}

template <class D, typename T = hn::TFromD<D>, class Store>
HWY_INLINE void for_all_extremes(D d, const TilePlane<T>& plane, Neighbourhood around, const Store& store) {
  constexpr int kUsual = 5;
  if (around.side == kUsual) {
    for_extremes<kUsual>(d, plane, around, store);
  } else {
    for_extremes<0>(d, plane, around, store);
  }
}

void bytes(const TilePlane<std::uint8_t>& plane, Neighbourhood around, ExtremePlanes planes, TileRows& rows) {
  const hn::CappedTag<std::uint8_t, TilePlane<std::uint8_t>::kVector> d;
  for_all_extremes(d, plane, around, [&](auto maximum, auto minimum, int x, int y) HWY_ATTR {
    hn::StoreU(maximum, d, rows.row(y, planes.largest) + x);
    hn::StoreU(minimum, d, rows.row(y, planes.smallest) + x);
  });
}

void steps(const TilePlane<std::uint16_t>& plane, Neighbourhood around, StepBytes kind, ExtremePlanes planes,
           TileRows& rows) {
  const hn::CappedTag<std::uint16_t, TilePlane<std::uint16_t>::kVector / 2> d;
  const hn::Rebind<std::uint8_t, decltype(d)> half;
  const auto byte = hn::Set(d, 255);
  const auto to_byte = [&](auto value) HWY_ATTR {
    const auto limited = kind == StepBytes::kWrapped ? hn::And(value, byte) : hn::Min(value, byte);
    return hn::DemoteTo(half, hn::BitCast(hn::RebindToSigned<decltype(d)>(), limited));
  };
  for_all_extremes(d, plane, around, [&](auto maximum, auto minimum, int x, int y) HWY_ATTR {
    hn::StoreU(to_byte(maximum), half, rows.row(y, planes.largest) + x);
    hn::StoreU(to_byte(minimum), half, rows.row(y, planes.smallest) + x);
  });
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {

HWY_EXPORT(bytes);
HWY_EXPORT(steps);

void byte_extremes(const TilePlane<std::uint8_t>& plane, Neighbourhood around, ExtremePlanes planes, TileRows& rows) {
  HWY_DYNAMIC_DISPATCH(bytes)(plane, around, planes, rows);
}

void step_extremes(const TilePlane<std::uint16_t>& plane, Neighbourhood around, StepBytes bytes, ExtremePlanes planes,
                   TileRows& rows) {
  HWY_DYNAMIC_DISPATCH(steps)(plane, around, bytes, planes, rows);
}

}  // namespace houghstream
#endif
