#pragma once

#include "pose/registration/pair_block.hpp"

namespace houghstream {

// What pose/registration/pair_block does with vector units, point by point and row by row: the reference that tests
// hold it against, bit for bit.

/// find_gaps()
void reference_find_gaps(const RgbdFrame& frame, const PairSearch& search, PairBlock& block);

/// add_products()
void reference_add_products(const PairRows& rows, const PairBlock::Values& weights, std::size_t count, PairSums& sums);

}  // namespace houghstream
