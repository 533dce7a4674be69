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

/// Lists for each set of up to eight lanes its lanes in ascending order, then zeros.
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

/// Returns a vector of TemplateCells of a row of the box, beginning at a column, in their memory layout: colour_index
/// in bits 0 to 15, row in 16 to 23, column from 24 on. Lanes on the rim are not valid.
HWY_INLINE Ints box_cells(std::size_t row, std::size_t column) {
  const Int d;
  const Ints columns = hn::Iota(d, static_cast<std::int32_t>(column));
  const auto first = static_cast<std::int32_t>(TemplateGrid::colour_index(static_cast<int>(row), TemplateGrid::kRim));
  const Ints index = hn::And(hn::Add(columns, hn::Set(d, first - TemplateGrid::kRim)), hn::Set(d, 0xFFFF));
  return hn::Or(hn::Or(index, hn::Set(d, static_cast<std::int32_t>(row << 16U))), hn::ShiftLeft<24>(columns));
}

/// Returns measured minus template depth, metres; NaN where the template has no depth.
HWY_INLINE Floats difference_to(Floats depth_behind_centre, Ints template_mm, float metres_per_mm) {
  const Float d;
  const Floats template_depth = hn::Mul(hn::Set(d, metres_per_mm), hn::ConvertTo(d, template_mm));
  const auto is_known = hn::RebindMask(d, hn::Gt(template_mm, hn::Set(Int(), TemplateGrid::kNoDepth)));
  const Floats missing = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  return hn::IfThenElse(is_known, hn::Sub(depth_behind_centre, template_depth), missing);
}

void compare_in_vectors(const TemplateGrid& grid, const CellLayout& layout, const cv::Mat& depth, std::size_t row_step,
                        CellDepths& out) {
  const Float d;
  const Int di;
  const Short ds;
  const Ints no_object = hn::Set(di, TemplateGrid::kNoObject);
  const Ints last_px = hn::Set(di, depth.cols - 1);
  out.object_cells = 0;
  out.rim_cells = 0;
  for (std::size_t row = row_step / 2; row < kTemplateSide; row += row_step) {
    const int y = layout.row_px[row];
    if (y < 0 || y >= depth.rows) continue;
    const auto* measured = depth.ptr<float>(y);
    const Floats row_depth = hn::Set(d, layout.row_depth[row]);
    for (std::size_t column = 0; column < kTemplateSide; column += hn::Lanes(d)) {
      const Ints x = hn::LoadU(di, layout.column_px.data() + column);
      const Ints inside_x = hn::Min(hn::Max(x, hn::Zero(di)), last_px);
      const auto is_inside = hn::Eq(x, inside_x);
      const Floats expected = hn::Add(row_depth, hn::LoadU(d, layout.column_depth.data() + column));
      const Floats depth_behind_centre = hn::Sub(hn::GatherIndex(d, measured, inside_x), expected);
      if (TemplateGrid::is_in_box(static_cast<int>(row))) {
        const std::size_t cell = TemplateGrid::depth_index(static_cast<int>(row), static_cast<int>(column));
        const Ints on_object = hn::PromoteTo(di, hn::LoadU(ds, grid.mm.data() + cell));
        const auto shows_object = hn::And(is_inside, hn::Ne(on_object, no_object));
        hn::StoreU(compress(di, box_cells(row, column), shows_object), di,
                   reinterpret_cast<std::int32_t*>(out.cells.data() + out.object_cells));
        hn::StoreU(compress(d, difference_to(depth_behind_centre, on_object, layout.metres_per_mm),
                            hn::RebindMask(d, shows_object)),
                   d, out.depth_difference.data() + out.object_cells);
        out.object_cells += hn::CountTrue(di, shows_object);
      }
      if (row < TemplateGrid::kRimRows) {
        const std::int16_t* cell = grid.beside.data() + row * kTemplateSide + column;
        const Ints beside = hn::PromoteTo(di, hn::LoadU(ds, cell));
        const auto is_beside = hn::And(is_inside, hn::Ne(beside, no_object));
        hn::StoreU(
            compress(d, difference_to(depth_behind_centre, beside, layout.metres_per_mm), hn::RebindMask(d, is_beside)),
            d, out.rim_difference.data() + out.rim_cells);
        out.rim_cells += hn::CountTrue(di, is_beside);
      }
    }
  }
}

/// Returns the median of the depth differences within the limit. Only the bin of a histogram that holds it is searched,
/// since searching all of them mispredicts a branch for about every second value.
float median_within_limit(const CellDepths& depths) {
  constexpr float kMaxShift = 0.03F;
  constexpr int kBins = 64;
  const Float d;
  const Int di;
  PerCell<std::int32_t> bins;
  std::array<std::size_t, kBins + 1> counts{};  // the last: beyond the limit
  const std::size_t cells = depths.object_cells;
  for (std::size_t i = 0; i < cells; i += hn::Lanes(d)) {
    const Floats e = hn::LoadU(d, depths.depth_difference.data() + i);
    const auto is_within = hn::Lt(hn::Abs(e), hn::Set(d, kMaxShift));
    const Floats position = hn::Mul(hn::Add(e, hn::Set(d, kMaxShift)), hn::Set(d, kBins / (2.0F * kMaxShift)));
    const Ints bin = hn::Min(hn::ConvertTo(di, hn::IfThenElseZero(is_within, position)), hn::Set(di, kBins - 1));
    hn::StoreU(hn::IfThenElse(hn::RebindMask(di, is_within), bin, hn::Set(di, kBins)), di, bins.data() + i);
  }
  for (std::size_t i = 0; i < cells; ++i) ++counts[static_cast<std::size_t>(bins[i])];
  const std::size_t total = cells - counts[kBins];
  if (total == 0) return 0.0F;
  std::size_t rank = total / 2;
  std::int32_t median_bin = 0;
  for (; rank >= counts[static_cast<std::size_t>(median_bin)]; ++median_bin)
    rank -= counts[static_cast<std::size_t>(median_bin)];
  PerCell<float> bin_values;
  std::size_t count = 0;
  for (std::size_t i = 0; i < cells; i += hn::Lanes(d)) {
    const auto is_in_bin =
        hn::And(hn::Eq(hn::LoadU(di, bins.data() + i), hn::Set(di, median_bin)), hn::FirstN(di, cells - i));
    hn::StoreU(compress(d, hn::LoadU(d, depths.depth_difference.data() + i), hn::RebindMask(d, is_in_bin)), d,
               bin_values.data() + count);
    count += hn::CountTrue(di, is_in_bin);
  }
  auto* const median = bin_values.data() + rank;
  std::nth_element(bin_values.data(), median, bin_values.data() + count);
  return *median;
}

/// Returns the lanes' bits together.
HWY_INLINE std::uint32_t bits_of(Ints lanes) {
  const Int d;
  std::array<std::int32_t, hn::MaxLanes(Int())> lane_bits;
  hn::StoreU(lanes, d, lane_bits.data());
  std::uint32_t all = 0;
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) all |= static_cast<std::uint32_t>(lane_bits[i]);
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
    const Floats e = hn::Sub(hn::LoadU(d, depths.depth_difference.data() + i), hn::Set(d, shift));
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
HWY_EXPORT(median_within_limit);
HWY_EXPORT(tally_in_vectors);

void compare_depths(const TemplateGrid& grid, const CellLayout& layout, const cv::Mat& depth, std::size_t row_step,
                    CellDepths& out) {
  HWY_DYNAMIC_DISPATCH(compare_in_vectors)(grid, layout, depth, row_step, out);
}

float median_depth_shift(const CellDepths& depths) {
  return HWY_DYNAMIC_DISPATCH(median_within_limit)(depths);
}

void tally_cells(const CellDepths& depths, float shift, float tolerance, CellTally& tally) {
  HWY_DYNAMIC_DISPATCH(tally_in_vectors)(depths, shift, tolerance, tally);
}

}  // namespace houghstream
#endif
