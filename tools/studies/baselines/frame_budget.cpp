#include "tools/studies/baselines/frame_budget.hpp"

#include <algorithm>
#include <chrono>

namespace houghstream {

std::vector<std::size_t> spread_order(std::size_t count) {
  std::size_t whole = 1;
  while (whole < count) whole *= 2;
  std::vector<std::size_t> order;
  // The order is the odd multiples of each step: of the whole, of its half, of its quarter and so on.
  if (count > 0) order.push_back(0);
  for (std::size_t step = whole / 2; step > 0; step /= 2) {
    for (std::size_t i = step; i < count; i += 2 * step) order.push_back(i);
  }
  return order;
}

std::vector<std::size_t> visit_within(double seconds, std::size_t count,
                                      const std::function<void(std::size_t)>& visit) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  std::vector<std::size_t> visited;
  for (const std::size_t i : spread_order(count)) {
    const double elapsed = std::chrono::duration<double>(Clock::now() - start).count();
    if (!visited.empty() && seconds > 0.0 && elapsed >= seconds) break;
    visit(i);
    visited.push_back(i);
  }
  std::sort(visited.begin(), visited.end());
  return visited;
}

}  // namespace houghstream
