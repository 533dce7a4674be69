#include "tools/render/ordered_frames.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

namespace houghstream::render {
namespace {

TEST(OrderedFrames, AreWrittenInOrderByAnyNumberOfThreads) {
  for (const int threads : {1, 3}) {
    std::vector<std::int64_t> order;
    render_in_order(
        "test", threads, 20,
        [](int index) {
          world::RenderedFrame frame;
          frame.frame.id.utime = index;
          return frame;
        },
        [&](const world::RenderedFrame& frame) { order.push_back(frame.frame.id.utime); });
    ASSERT_EQ(order.size(), 20U);
    for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], static_cast<std::int64_t>(i));
  }
}

TEST(OrderedFrames, AFailureEndsTheLoopAndIsRethrown) {
  const auto render = [](int) { return world::RenderedFrame{}; };
  const auto write = [](const world::RenderedFrame&) { fail("disk full"); };
  EXPECT_THROW(render_in_order("test", 3, 20, render, write), InputError);
}

}  // namespace
}  // namespace houghstream::render
