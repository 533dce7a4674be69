// Compiled once for each instruction set, see foreach_target.h of Highway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/evidence/cell_comparison.cpp"
#include "detector/evidence/cell_comparison.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace houghstream::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Float = hn::CappedTag<float, 8>;
using Floats = hn::Vec<Float>;
using Int = hn::Rebind<std::int32_t, Float>;
using Ints = hn::Vec<Int>;
using Short = hn::Rebind<std::int16_t, Float>;

static_assert(kTemplateSide % hn::MaxLanes(Float()) == 0 && sizeof(TemplateCell) == sizeof(std::int32_t));

/// For each set of up to eight lanes: its lanes, in ascending order, then zeros.
constexpr std::array<std::array<std::int32_t, 8>, 256> kLanesOfSet = [] {
  std::array<std::array<std::int32_t, 8>, 256> lanes{};
  for (std::size_t set = 0; set < lanes.size(); ++set) {
    std::size_t count = 0;
    for (std::int32_t lane = 0; lane < 8; ++lane) {
      if ((set >> static_cast<unsigned>(lane) & 1U) != 0U) lanes[set][count++] = lane;
    }
  }
  return lanes;
}();

/// Moves the lanes of the mask to the front. Highway's Compress does the same; compilers make a call of `rep movs` of
/// its table's lines, which takes longer than all the rest.
template <typename D, typename V, typename M>
HWY_INLINE V compress(D d, V values, M mask) {
  std::array<std::uint8_t, 8> bits{};
  hn::StoreMaskBits(d, mask, bits.data());
  return hn::TableLookupLanes(values, hn::SetTableIndices(d, kLanesOfSet[bits[0]].data()));
}

/// Returns the cells of a row from a column on, as TemplateCell lies in memory.
HWY_INLINE Ints cell_numbers(std::size_t row, std::size_t column) {
  const Int d;
  const Ints columns = hn::Iota(d, static_cast<std::int32_t>(column));
  const Ints index = hn::Add(columns, hn::Set(d, static_cast<std::int32_t>(row * kTemplateSide)));
  return hn::Or(hn::Or(index, hn::Set(d, static_cast<std::int32_t>(row << 16U))), hn::ShiftLeft<24>(columns));
}

/// Returns measured minus template depth, metres; NaN where the template has no depth.
HWY_INLINE Floats excess_over(Floats beyond_centre, Ints template_mm, float metres_per_mm) {
  const Float d;
  const Floats template_depth = hn::Mul(hn::Set(d, metres_per_mm), hn::ConvertTo(d, template_mm));
  const auto is_known = hn::RebindMask(d, hn::Gt(template_mm, hn::Set(Int(), TemplateGrid::kNoDepth)));
  const Floats nothing = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  return hn::IfThenElse(is_known, hn::Sub(beyond_centre, template_depth), nothing);
}

void compare_in_vectors(const TemplateGrid& grid, const CellPlaces& places, const cv::Mat& depth, std::size_t row_step,
                        CellDepths& out) {
  const Float d;
  const Int di;
  const Short ds;
  const Ints none = hn::Set(di, TemplateGrid::kBeside);
  const Ints last_px = hn::Set(di, depth.cols - 1);
  out.object_cells = 0;
  out.beside_cells = 0;
  for (std::size_t row = row_step / 2; row < kTemplateSide; row += row_step) {
    const int y = places.row_px[row];
    if (y < 0 || y >= depth.rows) continue;
    const auto* measured = depth.ptr<float>(y);
    const Floats row_depth = hn::Set(d, places.row_depth[row]);
    for (std::size_t column = 0; column < kTemplateSide; column += hn::Lanes(d)) {
      const Ints x = hn::LoadU(di, places.column_px.data() + column);
      const Ints inside_x = hn::Min(hn::Max(x, hn::Zero(di)), last_px);
      const auto is_inside = hn::Eq(x, inside_x);
      const Floats expected = hn::Add(row_depth, hn::LoadU(d, places.column_depth.data() + column));
      const Floats beyond_centre = hn::Sub(hn::GatherIndex(d, measured, inside_x), expected);
      const std::size_t cell = row * kTemplateSide + column;
      const Ints on_object = hn::PromoteTo(di, hn::LoadU(ds, grid.mm.data() + cell));
      const Ints beside = hn::PromoteTo(di, hn::LoadU(ds, grid.beside.data() + cell));
      const auto shows_object = hn::And(is_inside, hn::Ne(on_object, none));
      const auto is_beside = hn::And(is_inside, hn::Ne(beside, none));
      hn::StoreU(compress(di, cell_numbers(row, column), shows_object), di,
                 reinterpret_cast<std::int32_t*>(out.cells.data() + out.object_cells));
      hn::StoreU(
          compress(d, excess_over(beyond_centre, on_object, places.metres_per_mm), hn::RebindMask(d, shows_object)), d,
          out.excess.data() + out.object_cells);
      hn::StoreU(compress(d, excess_over(beyond_centre, beside, places.metres_per_mm), hn::RebindMask(d, is_beside)), d,
                 out.excess_beside.data() + out.beside_cells);
      out.object_cells += hn::CountTrue(di, shows_object);
      out.beside_cells += hn::CountTrue(di, is_beside);
    }
  }
}

/// Returns the median of the excesses within reach. Only the class of a histogram that holds it is searched: searching
/// all of them mispredicts a branch for about every second value.
float median_within_reach(const CellDepths& depths) {
  constexpr float kReach = 0.03F;
  constexpr int kClasses = 64;
  const Float d;
  const Int di;
  PerCell<std::int32_t> classes;
  std::array<std::size_t, kClasses + 1> counts{};  // the last: out of reach
  const std::size_t cells = depths.object_cells;
  for (std::size_t i = 0; i < cells; i += hn::Lanes(d)) {
    const Floats e = hn::LoadU(d, depths.excess.data() + i);
    const auto within = hn::Lt(hn::Abs(e), hn::Set(d, kReach));
    const Floats position = hn::Mul(hn::Add(e, hn::Set(d, kReach)), hn::Set(d, kClasses / (2.0F * kReach)));
    const Ints bin = hn::Min(hn::ConvertTo(di, hn::IfThenElseZero(within, position)), hn::Set(di, kClasses - 1));
    hn::StoreU(hn::IfThenElse(hn::RebindMask(di, within), bin, hn::Set(di, kClasses)), di, classes.data() + i);
  }
  for (std::size_t i = 0; i < cells; ++i) ++counts[static_cast<std::size_t>(classes[i])];
  const std::size_t total = cells - counts[kClasses];
  if (total == 0) return 0.0F;
  std::size_t rank = total / 2;
  std::int32_t middle = 0;
  for (; rank >= counts[static_cast<std::size_t>(middle)]; ++middle) rank -= counts[static_cast<std::size_t>(middle)];
  PerCell<float> near;
  std::size_t count = 0;
  for (std::size_t i = 0; i < cells; i += hn::Lanes(d)) {
    const auto is_meant =
        hn::And(hn::Eq(hn::LoadU(di, classes.data() + i), hn::Set(di, middle)), hn::FirstN(di, cells - i));
    hn::StoreU(compress(d, hn::LoadU(d, depths.excess.data() + i), hn::RebindMask(d, is_meant)), d,
               near.data() + count);
    count += hn::CountTrue(di, is_meant);
  }
  auto* const median = near.data() + rank;
  std::nth_element(near.data(), median, near.data() + count);
  return *median;
}

/// Returns the lanes' bits together.
HWY_INLINE std::uint32_t bits_of(Ints lanes) {
  const Int d;
  std::array<std::int32_t, hn::MaxLanes(Int())> each;
  hn::StoreU(lanes, d, each.data());
  std::uint32_t all = 0;
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) all |= static_cast<std::uint32_t>(each[i]);
  return all;
}

void tally_in_vectors(const CellDepths& depths, float shift, float tolerance, CellTally& out) {
  const Float d;
  const Int di;
  const Floats limit = hn::Set(d, tolerance);
  const Ints one = hn::Set(di, 1);
  PerCell<float> residuals;
  Ints rows = hn::Zero(di);
  Ints columns = hn::Zero(di);
  out.cells = depths.object_cells;
  out.visible = out.occluded = out.free_space_violations = out.no_depth = out.unoccluded = 0;
  for (std::size_t i = 0; i < depths.object_cells; i += hn::Lanes(d)) {
    const auto present = hn::FirstN(d, depths.object_cells - i);
    const Floats e = hn::Sub(hn::LoadU(d, depths.excess.data() + i), hn::Set(d, shift));
    const Ints cell = hn::LoadU(di, reinterpret_cast<const std::int32_t*>(depths.cells.data() + i));
    const auto no_depth = hn::And(hn::IsNaN(e), present);
    const auto visible = hn::And(hn::Le(hn::Abs(e), limit), present);
    const auto unoccluded = hn::RebindMask(di, hn::Or(visible, no_depth));
    hn::StoreU(compress(d, hn::Div(hn::Abs(e), limit), visible), d, residuals.data() + out.visible);
    hn::StoreU(compress(di, cell, unoccluded), di,
               reinterpret_cast<std::int32_t*>(out.unoccluded_cells.data() + out.unoccluded));
    const Ints row = hn::And(hn::ShiftRight<16>(cell), hn::Set(di, 0xFF));
    rows = hn::Or(rows, hn::IfThenElseZero(unoccluded, hn::Shl(one, row)));
    columns = hn::Or(columns, hn::IfThenElseZero(unoccluded, hn::Shl(one, hn::ShiftRight<24>(cell))));
    out.no_depth += hn::CountTrue(d, no_depth);
    out.visible += hn::CountTrue(d, visible);
    out.unoccluded += hn::CountTrue(di, unoccluded);
    out.occluded += hn::CountTrue(d, hn::And(hn::Lt(e, hn::Neg(limit)), present));
    out.free_space_violations += hn::CountTrue(d, hn::And(hn::Gt(e, limit), present));
  }
  out.rows = bits_of(rows);
  out.columns = bits_of(columns);
  out.depth_residual = 0.0F;  // cell by cell: the same for vectors of any length
  for (std::size_t i = 0; i < out.visible; ++i) out.depth_residual += residuals[i];
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {

HWY_EXPORT(compare_in_vectors);
HWY_EXPORT(median_within_reach);
HWY_EXPORT(tally_in_vectors);

void compare_depths(const TemplateGrid& grid, const CellPlaces& places, const cv::Mat& depth, std::size_t row_step,
                    CellDepths& out) {
  HWY_DYNAMIC_DISPATCH(compare_in_vectors)(grid, places, depth, row_step, out);
}

float common_shift(const CellDepths& depths) {
  return HWY_DYNAMIC_DISPATCH(median_within_reach)(depths);
}

void tally_cells(const CellDepths& depths, float shift, float tolerance, CellTally& tally) {
  HWY_DYNAMIC_DISPATCH(tally_in_vectors)(depths, shift, tolerance, tally);
}

}  // namespace houghstream
#endif
