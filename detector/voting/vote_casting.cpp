// Compiled once for each instruction set, see foreach_target.h of Highway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/voting/vote_casting.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "detector/voting/hough_space.hpp"

HWY_BEFORE_NAMESPACE();
namespace houghstream::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Float = hn::CappedTag<float, 4>;  // more votes than many leaves have would be computed in vain
using Floats = hn::Vec<Float>;
using Int = hn::Rebind<std::int32_t, Float>;

using Short = hn::Rebind<std::int16_t, Float>;
using UnsignedShort = hn::Rebind<std::uint16_t, Float>;

static_assert(sizeof(LeafVote) == 4 * sizeof(std::int16_t) && sizeof(Vote) == 4 * sizeof(float));

/// Transform from the frame of a patch's ray to that of the camera: a rotation and the patch's point.
struct VoteTransform {
  struct Row {
    Floats x, y, z, origin;
  };
  Row x;
  Row y;
  Row z;
};

HWY_INLINE VoteTransform vote_transform(const Eigen::Vector3f& point) {
  const Float d;
  const Eigen::Matrix3f r = ray_rotation(point);
  const auto row = [&](int i) HWY_ATTR {
    return VoteTransform::Row{hn::Set(d, r(i, 0)), hn::Set(d, r(i, 1)), hn::Set(d, r(i, 2)), hn::Set(d, point[i])};
  };
  return {row(0), row(1), row(2)};
}

HWY_INLINE Floats transformed(const VoteTransform::Row& to, Floats x, Floats y, Floats z) {
  return hn::Add(to.origin, hn::Add(hn::Mul(to.x, x), hn::Add(hn::Mul(to.y, y), hn::Mul(to.z, z))));
}

/// Returns the cells in which centres are seen.
HWY_INLINE hn::Vec<Int> cells_of(Floats x, Floats y, Floats z, const CellGrid& grid) {
  const Float d;
  const Int di;
  const Floats scale = hn::Div(hn::Set(d, 1.0F), z);
  const Floats u = hn::Add(hn::Mul(hn::Mul(hn::Set(d, grid.fx), x), scale), hn::Set(d, grid.cx));
  const Floats v = hn::Add(hn::Mul(hn::Mul(hn::Set(d, grid.fy), y), scale), hn::Set(d, grid.cy));
  const auto in_columns = hn::And(hn::Ge(u, hn::Zero(d)), hn::Lt(u, hn::Set(d, static_cast<float>(grid.width))));
  const auto in_rows = hn::And(hn::Ge(v, hn::Zero(d)), hn::Lt(v, hn::Set(d, static_cast<float>(grid.height))));
  const auto seen = hn::And(hn::And(in_columns, in_rows), hn::Ge(z, hn::Set(d, 0.1F)));
  const auto inside = [&](Floats at) { return hn::ConvertTo(di, hn::IfThenElseZero(seen, at)); };
  const auto cell = hn::Add(hn::Mul(inside(v), hn::Set(di, grid.width)), inside(u));
  return hn::IfThenElse(hn::RebindMask(di, seen), cell, hn::Set(di, static_cast<std::int32_t>(grid.outside())));
}

/// Values that the votes of one voter share.
struct VoteBatch {
  float probability;    // p(class | leaf)
  float tree_fraction;  // fraction of one tree
  std::uint32_t voter;
  const CellGrid& grid;
};

/// Casts one vector of a leaf's votes and writes them from index `at` on.
HWY_INLINE void cast_vote_vector(const std::int16_t* leaf_votes, const VoteTransform& m, const VoteBatch& batch,
                                 std::size_t at, CastVotes& cast) {
  const Float d;
  const Int di;
  const Short ds;
  hn::Vec<Short> x_steps, y_steps, z_steps, weight_steps;
  hn::LoadInterleaved4(ds, leaf_votes, x_steps, y_steps, z_steps, weight_steps);
  const auto metres = [&](hn::Vec<Short> steps) HWY_ATTR {
    return hn::Mul(hn::Set(d, LeafVote::kStep_m), hn::ConvertTo(d, hn::PromoteTo(di, steps)));
  };
  const Floats x = metres(x_steps);
  const Floats y = metres(y_steps);
  const Floats z = metres(z_steps);
  const auto unsigned_steps = hn::BitCast(UnsignedShort(), weight_steps);
  const Floats weight = hn::Mul(hn::Set(d, Share::kStep), hn::ConvertTo(d, hn::PromoteTo(di, unsigned_steps)));
  const Floats cx = transformed(m.x, x, y, z);
  const Floats cy = transformed(m.y, x, y, z);
  const Floats cz = transformed(m.z, x, y, z);
  const Floats w = hn::Mul(hn::Mul(hn::Set(d, batch.probability), weight), hn::Set(d, batch.tree_fraction));
  hn::StoreInterleaved4(cx, cy, cz, w, d, cast.votes[at].centre_camera.data());
  hn::StoreU(cells_of(cx, cy, cz, batch.grid), di, reinterpret_cast<std::int32_t*>(cast.cells.data() + at));
  hn::StoreU(hn::Set(di, static_cast<std::int32_t>(batch.voter)), di,
             reinterpret_cast<std::int32_t*>(cast.voters.data() + at));
}

/// Lets the cache misses of many voters overlap, since the votes of their leaves lie anywhere in the forest.
HWY_INLINE void prefetch_ahead(const Forest& forest, const std::vector<Voter>& voters, std::size_t now) {
  constexpr std::size_t kAhead = 12;  // voters
  if (now + kAhead >= voters.size()) return;
  const LeafVote* soon = forest.votes.data() + voters[now + kAhead].entry.start.vote;
  for (std::size_t line = 0; line < 2; ++line) hwy::Prefetch(soon + 8 * line);
}

/// Casts the votes of the voters from `first` on until the memory is full; returns the first voter that is left.
std::size_t cast_until_full(const CastInput& input, std::size_t first, CastVotes& cast) {
  const Forest& forest = input.forest;
  const std::vector<Voter>& voters = input.voters;
  constexpr std::size_t kLanes = hn::MaxLanes(Float());
  static_assert(kLanes <= CastVotes::kPadding);
  const float tree_fraction = 1.0F / static_cast<float>(forest.roots.size());
  std::uint32_t patch = voters[first].patch;
  VoteTransform transform = vote_transform(input.patches.point_camera[patch]);
  std::size_t count = cast.count;
  const std::size_t room = cast.votes.size() - CastVotes::kPadding;
  std::size_t i = first;
  for (; i < voters.size(); ++i) {
    prefetch_ahead(forest, voters, i);
    const LeafClass& entry = voters[i].entry.leaf_class;
    const std::size_t first_vote = voters[i].entry.start.vote;
    if (count + entry.vote_count > room) break;
    if (voters[i].patch != patch) transform = vote_transform(input.patches.point_camera[patch = voters[i].patch]);
    const VoteBatch batch{entry.probability, tree_fraction, static_cast<std::uint32_t>(i), input.grid};
    for (std::size_t v = 0; v < entry.vote_count; v += kLanes) {
      const LeafVote* votes = forest.votes.data() + first_vote + v;
      std::array<LeafVote, kLanes> last;
      if (first_vote + v + kLanes > forest.votes.size()) {  // no reading beyond the end
        std::copy(votes, forest.votes.data() + forest.votes.size(), last.begin());
        votes = last.data();
      }
      cast_vote_vector(votes->steps.data(), transform, batch, count + v, cast);
    }
    count += entry.vote_count;
  }
  cast.count = count;
  return i;
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {

HWY_EXPORT(cast_until_full);

CellGrid::CellGrid(const Camera& camera, int cell_px)
    : width((camera.width + cell_px - 1) / cell_px),
      height((camera.height + cell_px - 1) / cell_px),
      fx(static_cast<float>(camera.fx / cell_px)),
      fy(static_cast<float>(camera.fy / cell_px)),
      cx(static_cast<float>((camera.cx + 0.5) / cell_px)),
      cy(static_cast<float>((camera.cy + 0.5) / cell_px)) {}

void cast_all(const CastInput& input, CastVotes& cast) {
  constexpr std::size_t kMaxPerVoter = UINT8_MAX;
  cast.count = 0;
  for (std::size_t next = 0; next < input.voters.size();) {
    if (cast.count + kMaxPerVoter + CastVotes::kPadding > cast.votes.size()) {
      cast.votes.resize(2 * cast.votes.size() + kMaxPerVoter + CastVotes::kPadding);
      cast.cells.resize(cast.votes.size());
      cast.voters.resize(cast.votes.size());
    }
    next = HWY_DYNAMIC_DISPATCH(cast_until_full)(input, next, cast);
  }
}

}  // namespace houghstream
#endif
