// Compiled once for each instruction set, see foreach_target.h of Highway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pose/registration/correspondence_block.cpp"
#include "pose/registration/correspondence_block.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace houghstream::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Float = hn::CappedTag<float, CorrespondenceBlock::kSize>;
using Floats = hn::Vec<Float>;
using Int = hn::RebindToSigned<Float>;
using Ints = hn::Vec<Int>;

/// Pixels of one vector of points, and how far apart those of their lattices are.
struct Lattices {
  hn::Mask<Int> inside;  // the image; the others are 0
  Ints u, v, stride;
};

HWY_INLINE Lattices lattices(const PixelRays& rays, const CorrespondenceSearch& search, Floats x, Floats y, Floats z) {
  const Float d;
  const Int di;
  const auto set = [d](float value) { return hn::Set(d, value); };
  const Floats half = set(0.5F);
  const Floats scale = hn::Div(set(1.0F), z);
  const Floats u = hn::Add(hn::Add(hn::Mul(hn::Mul(set(rays.focal.x()), x), scale), set(rays.centre.x())), half);
  const Floats v = hn::Add(hn::Add(hn::Mul(hn::Mul(set(rays.focal.y()), y), scale), set(rays.centre.y())), half);
  const auto inside = hn::And(hn::And(hn::Ge(u, half), hn::Lt(u, set(static_cast<float>(rays.columns)))),
                              hn::And(hn::Ge(v, half), hn::Lt(v, set(static_cast<float>(rays.rows)))));
  const Floats pitch = hn::Mul(hn::Mul(set(rays.step.x()), z), set(static_cast<float>(search.steps)));
  const Floats stride = hn::Min(hn::Div(set(search.distance_m), pitch), set(PixelRays::kWidest));
  const auto whole = [&](Floats value) { return hn::ConvertTo(di, hn::IfThenElseZero(inside, value)); };
  return {hn::RebindMask(di, inside), whole(u), whole(v), hn::Max(hn::Set(di, 1), whole(stride))};
}

HWY_INLINE hn::Mask<Int> within(Ints value, int limit) {
  const Int di;
  return hn::And(hn::Gt(value, hn::Set(di, -1)), hn::Lt(value, hn::Set(di, limit)));
}

/// Processes the points of one vector.
HWY_INLINE void search_vector(const PixelRays& rays, const float* depth, const CorrespondenceSearch& search,
                              std::size_t first, CorrespondenceBlock& block) {
  const Float d;
  const Int di;
  const Floats px = hn::Load(d, block.x.data() + first);
  const Floats py = hn::Load(d, block.y.data() + first);
  const Floats pz = hn::Load(d, block.z.data() + first);
  const Lattices at = lattices(rays, search, px, py, pz);
  const auto ray = [&](float start, float step, Ints pixel) {
    return hn::Add(hn::Set(d, start), hn::Mul(hn::Set(d, step), hn::ConvertTo(d, pixel)));
  };
  Floats best_sq = hn::Set(d, search.distance_m * search.distance_m);
  Floats best_x = hn::Zero(d);
  Floats best_y = hn::Zero(d);
  Floats best_z = hn::Zero(d);
  for (int j = -search.steps; j <= search.steps; ++j) {
    const Ints v = hn::Add(at.v, hn::Mul(hn::Set(di, j), at.stride));
    const auto row_inside = hn::And(at.inside, within(v, rays.rows));
    const Ints row = hn::Mul(v, hn::Set(di, rays.row_step));
    const Floats ray_y = ray(rays.first.y(), rays.step.y(), v);
    for (int i = -search.steps; i <= search.steps; ++i) {
      const Ints u = hn::Add(at.u, hn::Mul(hn::Set(di, i), at.stride));
      const auto inside = hn::And(row_inside, within(u, rays.columns));
      const Floats z = hn::GatherIndex(d, depth, hn::IfThenElseZero(inside, hn::Add(row, u)));
      const Floats x = hn::Sub(hn::Mul(z, ray(rays.first.x(), rays.step.x(), u)), px);
      const Floats y = hn::Sub(hn::Mul(z, ray_y), py);
      const Floats z_difference = hn::Sub(z, pz);
      const Floats distance_sq = hn::Add(hn::Mul(x, x), hn::Add(hn::Mul(y, y), hn::Mul(z_difference, z_difference)));
      const auto closer = hn::And(hn::RebindMask(d, inside), hn::Lt(distance_sq, best_sq));  // not where z is NaN
      best_sq = hn::IfThenElse(closer, distance_sq, best_sq);
      best_x = hn::IfThenElse(closer, x, best_x);
      best_y = hn::IfThenElse(closer, y, best_y);
      best_z = hn::IfThenElse(closer, z_difference, best_z);
    }
  }
  hn::Store(best_sq, d, block.distance_sq.data() + first);
  hn::Store(best_x, d, block.residual_x.data() + first);
  hn::Store(best_y, d, block.residual_y.data() + first);
  hn::Store(best_z, d, block.residual_z.data() + first);
}

void find_all(const PixelRays& rays, const float* depth, const CorrespondenceSearch& search,
              CorrespondenceBlock& block) {
  for (std::size_t i = 0; i < block.count; i += hn::Lanes(Float())) search_vector(rays, depth, search, i, block);
}

void add_all(const ResidualRows& rows, const CorrespondenceBlock::Values& weights, std::size_t count, float* sums) {
  constexpr std::size_t kWidth = 8;
  const hn::CappedTag<float, kWidth> d;
  using Part = hn::Vec<decltype(d)>;
  constexpr std::size_t kLanes = hn::MaxLanes(hn::CappedTag<float, kWidth>());
  for (std::size_t first = 0; first < kWidth; first += kLanes) {
    Part columns[kWidth];
    for (std::size_t j = 0; j < kWidth; ++j) columns[j] = hn::LoadU(d, sums + j * kWidth + first);
    for (std::size_t i = 0; i < count; ++i) {
      const float* row = rows[i].values.data();
      const Part weighted = hn::Mul(hn::Set(d, weights[i]), hn::Load(d, row + first));
      for (std::size_t j = 0; j < kWidth; ++j) {
        columns[j] = hn::Add(columns[j], hn::Mul(weighted, hn::Set(d, row[j])));
      }
    }
    for (std::size_t j = 0; j < kWidth; ++j) hn::StoreU(columns[j], d, sums + j * kWidth + first);
  }
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {

HWY_EXPORT(find_all);
HWY_EXPORT(add_all);

void find_correspondences(const RgbdFrame& frame, const CorrespondenceSearch& search, CorrespondenceBlock& block) {
  HWY_DYNAMIC_DISPATCH(find_all)(PixelRays(frame), frame.depth.ptr<float>(), search, block);
}

void accumulate_outer_products(const ResidualRows& rows, const CorrespondenceBlock::Values& weights, std::size_t count,
                               OuterProductSum& sums) {
  HWY_DYNAMIC_DISPATCH(add_all)(rows, weights, count, sums.data());
}

}  // namespace houghstream
#endif
