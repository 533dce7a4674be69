#include "pipeline/parallel.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace houghstream {
namespace {

TEST(ParallelFor, EveryItemIsDoneOnceForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 5}) {
    std::vector<int> done(1000, 0);
    parallel_for(threads, 1000, [&](int i) { ++done[static_cast<std::size_t>(i)]; });
    EXPECT_EQ(done, std::vector<int>(1000, 1)) << threads << " threads";
  }
}

TEST(ParallelFor, NothingToDoIsFine) {
  parallel_for(2, 0, [](int) { FAIL() << "called"; });
}

TEST(ParallelFor, TheFirstErrorComesOut) {
  const auto work = [](int i) {
    if (i == 3 || i == 7) throw std::runtime_error("item " + std::to_string(i));
  };
  try {
    parallel_for(2, 10, work);
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "item 3");
  }
}

}  // namespace
}  // namespace houghstream
