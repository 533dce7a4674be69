// Compiled once for each instruction set, see foreach_target.h of Highway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/features/tile_derivatives.cpp"
#include "detector/features/tile_derivatives.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <opencv2/imgproc.hpp>

HWY_BEFORE_NAMESPACE();
namespace houghstream::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kVector = TilePlane<float>::kVector;

/// Returns half of a derivative's size, rounded to even, as a byte.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void store_half(D d, V derivative, std::uint8_t* to) {
  const hn::Rebind<std::uint8_t, D> bytes;
  const auto size = hn::Abs(derivative);
  const auto odd = hn::And(hn::ShiftRight<1>(size), hn::Set(d, 1));
  hn::StoreU(hn::DemoteTo(bytes, hn::ShiftRight<1>(hn::Add(size, odd))), bytes, to);
}

void lightness_bytes(const TilePlane<std::uint8_t>& lightness, LightnessDerivatives& out) {
  const hn::CappedTag<std::int16_t, kVector / 2> d;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const int margin = out.bytes[0].margin();
  std::int16_t memory[3][kWidestRow];
  std::int16_t* smooth = memory[0] + kWidestMargin;
  std::int16_t* slope = memory[1] + kWidestMargin;
  std::int16_t* bend = memory[2] + kWidestMargin;
  const auto twice = [](auto v) HWY_ATTR { return hn::Add(v, v); };
  for (int y = -margin; y < out.bytes[0].height() + margin; ++y) {
    for (int x = -margin - 1; x < out.bytes[0].width() + margin + 1; x += lanes) {
      const std::uint8_t* at = lightness.row(y) + x;
      const auto above = hn::PromoteTo(d, hn::LoadU(bytes, at - lightness.stride()));
      const auto here = twice(hn::PromoteTo(d, hn::LoadU(bytes, at)));
      const auto below = hn::PromoteTo(d, hn::LoadU(bytes, at + lightness.stride()));
      hn::StoreU(hn::Add(hn::Add(above, below), here), d, smooth + x);
      hn::StoreU(hn::Sub(below, above), d, slope + x);
      hn::StoreU(hn::Sub(hn::Add(above, below), here), d, bend + x);
    }
    for (int x = -margin; x < out.bytes[0].width() + margin; x += lanes) {
      const auto across = [&](const std::int16_t* row) HWY_ATTR {
        return hn::Add(hn::Add(hn::LoadU(d, row + x - 1), hn::LoadU(d, row + x + 1)), twice(hn::LoadU(d, row + x)));
      };
      const auto left = hn::LoadU(d, smooth + x - 1);
      const auto right = hn::LoadU(d, smooth + x + 1);
      store_half(d, hn::Sub(right, left), out.bytes[0].row(y) + x);
      store_half(d, across(slope), out.bytes[1].row(y) + x);
      store_half(d, hn::Sub(hn::Add(left, right), twice(hn::LoadU(d, smooth + x))), out.bytes[2].row(y) + x);
      store_half(d, across(bend), out.bytes[3].row(y) + x);
    }
  }
}

void lightness_gradients(const TilePlane<std::uint8_t>& lightness, LightnessDerivatives& out) {
  const hn::CappedTag<float, kVector / 4> d;
  const hn::RebindToSigned<decltype(d)> whole;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const int margin = out.dx.margin();
  const auto eighth = hn::Set(d, 0.125F);
  for (int y = -margin; y < out.dx.height() + margin; ++y) {
    for (int x = -margin; x < out.dx.width() + margin; x += lanes) {
      const auto pixel = [&](int right, int down) HWY_ATTR {
        return hn::PromoteTo(whole, hn::LoadU(bytes, lightness.row(y + down) + x + right));
      };
      const auto rising = hn::Sub(pixel(1, 1), pixel(-1, -1));
      const auto falling = hn::Sub(pixel(1, -1), pixel(-1, 1));
      const auto across = hn::Sub(pixel(1, 0), pixel(-1, 0));
      const auto down = hn::Sub(pixel(0, 1), pixel(0, -1));
      const auto dx = hn::Add(hn::Add(rising, falling), hn::Add(across, across));
      const auto dy = hn::Add(hn::Sub(rising, falling), hn::Add(down, down));
      hn::StoreU(hn::Mul(hn::ConvertTo(d, dx), eighth), d, out.dx.row(y) + x);
      hn::StoreU(hn::Mul(hn::ConvertTo(d, dy), eighth), d, out.dy.row(y) + x);
    }
  }
}

void lightness(const TilePlane<std::uint8_t>& plane, LightnessDerivatives& out) {
  lightness_bytes(plane, out);
  lightness_gradients(plane, out);
}

/// Returns the sum of a kernel's products, from its first one to its last.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V filtered(D d, const float* first, std::ptrdiff_t step, const float* kernel, int size) {
  auto sum = hn::Mul(hn::LoadU(d, first), hn::Set(d, kernel[0]));
  for (int i = 1; i < size; ++i) sum = hn::Add(sum, hn::Mul(hn::LoadU(d, first + i * step), hn::Set(d, kernel[i])));
  return sum;
}

/// Clamps to the limits; NaN becomes 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V limited(D d, V value, float limit) {
  const auto inside = hn::Min(hn::Max(value, hn::Set(d, -limit)), hn::Set(d, limit));
  return hn::IfThenElseZero(hn::Eq(value, value), inside);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE void store_signed(D d, V value, float limit, std::uint8_t* to) {
  const hn::RebindToSigned<D> whole;
  const hn::Rebind<std::uint8_t, D> bytes;
  const auto steps = hn::Add(hn::Mul(value, hn::Set(d, 127.0F / limit)), hn::Set(d, 128.5F));
  hn::StoreU(hn::DemoteTo(bytes, hn::ConvertTo(whole, steps)), bytes, to);
}

void depth(const TilePlane<float>& plane, const SobelKernels& kernels, float focal_px, DepthDerivatives& out) {
  const hn::CappedTag<float, kVector / 4> d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const int margin = out.dx.margin();
  const int size = static_cast<int>(kernels[0].size());
  const int half = size / 2;
  float memory[3][kWidestRow];
  for (int y = -margin; y < out.dx.height() + margin; ++y) {
    for (int x = -margin - half; x < out.dx.width() + margin + half; x += lanes) {
      const float* first = plane.row(y - half) + x;
      for (int order = 0; order < 3; ++order) {
        hn::StoreU(filtered(d, first, plane.stride(), kernels[order].data(), size), d,
                   memory[order] + kWidestMargin + x);
      }
    }
    for (int x = -margin; x < out.dx.width() + margin; x += lanes) {
      const auto along = [&](int order, int across) HWY_ATTR {
        return filtered(d, memory[across] + kWidestMargin + x - half, 1, kernels[order].data(), size);
      };
      const auto per_metre = hn::Div(hn::Set(d, focal_px), hn::LoadU(d, plane.row(y) + x));
      const auto squared = hn::Mul(per_metre, per_metre);
      const auto dx = limited(d, hn::Mul(along(1, 0), per_metre), SlopeLimits::kSlope);
      const auto dy = limited(d, hn::Mul(along(0, 1), per_metre), SlopeLimits::kSlope);
      const auto dxx = limited(d, hn::Mul(along(2, 0), squared), SlopeLimits::kCurvature);
      const auto dyy = limited(d, hn::Mul(along(0, 2), squared), SlopeLimits::kCurvature);
      hn::StoreU(dx, d, out.dx.row(y) + x);
      hn::StoreU(dy, d, out.dy.row(y) + x);
      store_signed(d, dx, SlopeLimits::kSlope, out.bytes[0].row(y) + x);
      store_signed(d, dy, SlopeLimits::kSlope, out.bytes[1].row(y) + x);
      store_signed(d, dxx, SlopeLimits::kCurvature, out.bytes[2].row(y) + x);
      store_signed(d, dyy, SlopeLimits::kCurvature, out.bytes[3].row(y) + x);
    }
  }
}

void steps(const TilePlane<float>& plane, float step, TilePlane<std::uint16_t>& out) {
  const hn::CappedTag<float, kVector / 4> d;
  const hn::RebindToSigned<decltype(d)> whole;
  const hn::Rebind<std::uint16_t, decltype(d)> narrow;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  for (int y = -out.margin(); y < out.height() + out.margin(); ++y) {
    for (int x = -out.margin(); x < out.width() + out.margin(); x += lanes) {
      const auto value = hn::Add(hn::Div(hn::LoadU(d, plane.row(y) + x), hn::Set(d, step)), hn::Set(d, 0.5F));
      const auto known = hn::And(hn::Ge(value, hn::Zero(d)), hn::Lt(value, hn::Set(d, 1e6F)));  // false for NaN
      const auto count = hn::ConvertTo(whole, hn::IfThenElseZero(known, value));
      hn::StoreU(hn::DemoteTo(narrow, count), narrow, out.row(y) + x);
    }
  }
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {

HWY_EXPORT(lightness);
HWY_EXPORT(depth);
HWY_EXPORT(steps);

void differentiate_lightness(const TilePlane<std::uint8_t>& plane, LightnessDerivatives& out) {
  HWY_DYNAMIC_DISPATCH(lightness)(plane, out);
}

SobelKernels sobel_kernels(int size_px) {
  SobelKernels kernels;
  for (int order = 0; order < 3; ++order) {
    cv::Mat along;
    cv::Mat across;
    cv::getDerivKernels(along, across, std::max(order, 1), 0, size_px, true, CV_32F);
    const cv::Mat& kernel = order == 0 ? across : along;
    kernels[static_cast<std::size_t>(order)].assign(kernel.ptr<float>(), kernel.ptr<float>() + size_px);
  }
  return kernels;
}

void differentiate_depth(const TilePlane<float>& plane, const SobelKernels& kernels, float focal_px,
                         DepthDerivatives& out) {
  HWY_DYNAMIC_DISPATCH(depth)(plane, kernels, focal_px, out);
}

void quantise_depth(const TilePlane<float>& plane, float step, TilePlane<std::uint16_t>& out) {
  HWY_DYNAMIC_DISPATCH(steps)(plane, step, out);
}

}  // namespace houghstream
#endif
