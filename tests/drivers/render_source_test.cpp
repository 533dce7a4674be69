#include "drivers/render_source.hpp"

#include <gtest/gtest.h>

#include "drivers/bop_dataset.hpp"
#include "pipeline/checks.hpp"

namespace houghstream {
namespace {

TEST(RenderSource, GivesStampedFramesAt30Hz) {
  const auto source = open_frame_source("render:table_small_1");
  EXPECT_EQ(source->rate_hz(), 30.0);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->utime, dataset_utime(i));
    check_frame(*frame, "render:table_small_1");
  }
}

TEST(RenderSource, RefusesUnknownScenes) {
  EXPECT_THROW(open_render_source("cellar_1"), InputError);
}

}  // namespace
}  // namespace houghstream
