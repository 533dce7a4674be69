#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace houghstream {

/// Returns 0 to count - 1 in an order whose every beginning is spread over all of them: the middles of ever shorter
/// parts.
std::vector<std::size_t> spread_order(std::size_t count);

/// Calls visit(i) for each i below `count` in spread_order() until the seconds are over, the first one in any case;
/// zero seconds are no limit. Returns those that were visited, in rising order.
std::vector<std::size_t> visit_within(double seconds, std::size_t count, const std::function<void(std::size_t)>& visit);

}  // namespace houghstream
