// Compiled once for each instruction set, see foreach_target.h of Highway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/features/tile_histograms.cpp"
#include "detector/features/tile_histograms.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace houghstream::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kVector = TilePlane<float>::kVector;
constexpr int kBinCount = HistogramSteps::kBins;

/// Computes the orientations of gradients in [0, 9) bins, unsigned, by a polynomial arctangent (error below 0.3
/// degrees), so that the result does not depend on the machine's mathematics library.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V orientation_bins(D d, V dx, V dy) {
  const auto zero = hn::Zero(d);
  const auto ax = hn::Abs(dx);
  const auto ay = hn::Abs(dy);
  const auto big = hn::Max(ax, ay);
  const auto ratio = hn::IfThenElseZero(hn::Gt(big, zero), hn::Div(hn::Min(ax, ay), big));
  const auto sq = hn::Mul(ratio, ratio);
  auto angle = hn::Add(hn::Mul(hn::Set(d, -0.0464964749F), sq), hn::Set(d, 0.15931422F));
  angle = hn::Sub(hn::Mul(angle, sq), hn::Set(d, 0.327622764F));
  angle = hn::Add(hn::Mul(hn::Mul(angle, sq), ratio), ratio);
  angle = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(hn::Set(d, 1.57079637F), angle), angle);
  const auto opposite = hn::Xor(hn::Lt(dx, zero), hn::Lt(dy, zero));
  angle = hn::IfThenElse(opposite, hn::Sub(hn::Set(d, 3.14159274F), angle), angle);
  const auto bin = hn::Mul(angle, hn::Set(d, static_cast<float>(kBinCount) / 3.14159274F));
  return hn::IfThenZeroElse(hn::Ge(bin, hn::Set(d, static_cast<float>(kBinCount))), bin);
}

/// Bin of each gradient of a row, with the steps that go there and to the next one.
struct RowShares {
  std::uint16_t low_bin[kWidestRow];
  std::uint16_t low[kWidestRow];
  std::uint16_t high[kWidestRow];
};

void share_row(const float* dx, const float* dy, int count, float steps, RowShares& row) {
  const hn::CappedTag<float, kVector> d;
  const hn::RebindToSigned<decltype(d)> whole;
  const hn::Rebind<std::uint16_t, decltype(d)> narrow;
  const auto rounding = hn::Set(d, 0.5F);
  const auto lanes = static_cast<int>(hn::Lanes(d));
  for (int x = 0; x < count; x += lanes) {
    const auto gx = hn::LoadU(d, dx + x);
    const auto gy = hn::LoadU(d, dy + x);
    const auto squared = hn::Add(hn::Mul(gx, gx), hn::Mul(gy, gy));
    const auto magnitude = hn::Mul(hn::Sqrt(squared), hn::Set(d, steps));
    const auto bin = orientation_bins(d, gx, gy);
    const auto low = hn::ConvertTo(whole, bin);
    const auto fraction = hn::Sub(bin, hn::ConvertTo(d, low));
    const auto to_high = hn::Add(hn::Mul(magnitude, fraction), rounding);
    const auto to_low = hn::Add(hn::Mul(magnitude, hn::Sub(hn::Set(d, 1.0F), fraction)), rounding);
    hn::StoreU(hn::DemoteTo(narrow, low), narrow, row.low_bin + x);
    hn::StoreU(hn::DemoteTo(narrow, hn::ConvertTo(whole, to_low)), narrow, row.low + x);
    hn::StoreU(hn::DemoteTo(narrow, hn::ConvertTo(whole, to_high)), narrow, row.high + x);
  }
}

void sort_row(const RowShares& row, int y, BinPlanes& bins) {
  const hn::CappedTag<std::uint16_t, kVector> d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const int margin = bins[0].margin();
  const int count = bins[0].width() + 2 * margin;
  for (int b = 0; b < kBinCount; ++b) {
    const auto here = hn::Set(d, static_cast<std::uint16_t>(b));
    const auto before = hn::Set(d, static_cast<std::uint16_t>(b == 0 ? kBinCount - 1 : b - 1));
    std::uint16_t* out = bins[static_cast<std::size_t>(b)].row(y) - margin;
    for (int x = 0; x < count; x += lanes) {
      const auto bin = hn::LoadU(d, row.low_bin + x);
      const auto low = hn::IfThenElseZero(hn::Eq(bin, here), hn::LoadU(d, row.low + x));
      const auto high = hn::IfThenElseZero(hn::Eq(bin, before), hn::LoadU(d, row.high + x));
      hn::StoreU(hn::Or(low, high), d, out + x);
    }
  }
}

void fraction(const TilePlane<float>& dx, const TilePlane<float>& dy, float gain, BinPlanes& bins) {
  RowShares row;
  const int margin = dx.margin();
  const int count = dx.width() + 2 * margin;
  for (int y = -margin; y < dx.height() + margin; ++y) {
    share_row(dx.row(y) - margin, dy.row(y) - margin, count, gain * HistogramSteps::kPerByte, row);
    sort_row(row, y, bins);
  }
}

/// Returns five values side by side, or one above the other.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V weighted(D d, const std::uint16_t* middle, std::ptrdiff_t step) {
  const auto near = hn::Add(hn::LoadU(d, middle - step), hn::LoadU(d, middle + step));
  const auto far = hn::Add(hn::LoadU(d, middle - 2 * step), hn::LoadU(d, middle + 2 * step));
  const auto inner = hn::MulHigh(hn::LoadU(d, middle), hn::Set(d, HistogramSteps::kWeights[0]));
  const auto outer = hn::Add(hn::MulHigh(near, hn::Set(d, HistogramSteps::kWeights[1])),
                             hn::MulHigh(far, hn::Set(d, HistogramSteps::kWeights[2])));
  return hn::Add(inner, outer);
}

void smooth(const TilePlane<std::uint16_t>& bin, TilePlane<std::uint8_t>& bytes) {
  const hn::CappedTag<std::uint16_t, kVector / 2> d;
  const hn::RebindToSigned<decltype(d)> with_sign;
  const hn::Rebind<std::uint8_t, decltype(d)> half;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const int margin = bytes.margin();
  const int end = bytes.width() + margin;
  const auto rounding = hn::Set(d, static_cast<std::uint16_t>(HistogramSteps::kPerByte / 2 + HistogramSteps::kCut));
  std::uint16_t columns_memory[kWidestRow];
  std::uint16_t* columns = columns_memory + kWidestMargin;
  for (int y = -margin; y < bytes.height() + margin; ++y) {
    for (int x = -margin - 2; x < end + 2; x += lanes)
      hn::StoreU(weighted(d, bin.row(y) + x, bin.stride()), d, columns + x);
    for (int x = -margin; x < end; x += lanes) {
      const auto steps = hn::ShiftRight<4>(hn::Add(weighted(d, columns + x, 1), rounding));
      hn::StoreU(hn::DemoteTo(half, hn::BitCast(with_sign, steps)), half, bytes.row(y) + x);
    }
  }
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {

HWY_EXPORT(fraction);
HWY_EXPORT(smooth);

void bin_gradients(const TilePlane<float>& dx, const TilePlane<float>& dy, float gain, BinPlanes& bins) {
  HWY_DYNAMIC_DISPATCH(fraction)(dx, dy, gain, bins);
}

void smooth_bin(const TilePlane<std::uint16_t>& bin, TilePlane<std::uint8_t>& bytes) {
  HWY_DYNAMIC_DISPATCH(smooth)(bin, bytes);
}

}  // namespace houghstream
#endif
