#include "detector/evidence/boxes.hpp"

#include <gtest/gtest.h>

#include "tests/detector/small_camera.hpp"

namespace houghstream {
namespace {

/// Returns the box of one supporter per 2-pixel cell of a rectangle of the frame.
cv::Rect2f box_of(const cv::Rect& supported) {
  Forest forest;
  forest.views.resize(1);
  forest.views[0].box = {-0.1F, -0.05F, 0.1F, 0.05F};
  Hypothesis hypothesis;
  hypothesis.centre_camera = {0, 0, 1};
  hypothesis.views = {{0, 1.0F}};
  PatchGrid patches;
  for (int y = supported.y; y < supported.br().y; y += 2) {
    for (int x = supported.x; x < supported.br().x; x += 2) {
      hypothesis.patches.emplace_back(static_cast<std::uint32_t>(patches.cell_px.size()), 1.0F);
      patches.cell_px.emplace_back(x, y, 2, 2);
    }
  }
  BoxWorkspace workspace;
  return backproject_box(forest, hypothesis, patches, Camera{640, 480, 500, 500, 319.5, 239.5}, workspace);
}

TEST(Boxes, SidesMoveOutToTheRememberedOnesUnlessHidden) {
  // Whole, the object is seen from 270 to 370 and from 215 to 265.
  const cv::Rect2f whole = box_of({284, 222, 74, 38});
  EXPECT_NEAR(whole.x, 270, 0.01);
  EXPECT_NEAR(whole.y, 215, 0.01);
  EXPECT_NEAR(whole.br().x, 370, 0.01);
  EXPECT_NEAR(whole.br().y, 265, 0.01);
  const cv::Rect2f half = box_of({284, 222, 36, 38});  // the right half is hidden
  EXPECT_NEAR(half.x, 270, 0.01);
  EXPECT_NEAR(half.br().x, 320, 0.01);
  EXPECT_NEAR(half.br().y, 265, 0.01);
}

TEST(Boxes, WithoutSupportThereIsNoBox) {
  BoxWorkspace workspace;
  EXPECT_EQ(backproject_box({}, {}, {}, toy::kSmallCamera, workspace), cv::Rect2f());
}

}  // namespace
}  // namespace houghstream
