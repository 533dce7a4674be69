#include "pose/model/view_look.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/pose/printed_box.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

const Eigen::Isometry3d kPose = standing(30.0, 30.0, 0.8);

TEST(ViewLook, AtTheTruePoseDepthIsThatOfTheModel) {
  const Mesh box = printed_box();
  const ObjectModel model = make_object_model("box", box, {});
  const RgbdFrame frame = coloured_frame(box, kPose, 1);
  const ViewLook seen = look_at_view(frame, model, kPose, 300);
  ASSERT_EQ(seen.looks.size(), 300U);
  int near = 0;
  for (std::size_t i = 0; i < seen.looks.size(); ++i) {
    const Look& look = seen.looks[i];
    near += std::abs(look.beyond) < 0.01F ? 1 : 0;
    const Eigen::Vector2d pixel = frame.camera.project(kPose * seen.view.points[i].cast<double>());
    EXPECT_LE(std::abs(pixel.x() - look.x), 0.501);
    EXPECT_LE(std::abs(pixel.y() - look.y), 0.501);
  }
  EXPECT_GT(near, 270);
}

TEST(ViewLook, OutsideTheImageAndWithoutDepthNothingIsKnown) {
  const Mesh box = printed_box();
  const ObjectModel model = make_object_model("box", box, {});
  RgbdFrame frame = coloured_frame(box, kPose, 1);
  const Eigen::Isometry3d aside = Eigen::Translation3d(5.0, 0.0, 0.0) * kPose;
  for (const Look& look : look_at_view(frame, model, aside, 50).looks) EXPECT_TRUE(std::isnan(look.beyond));
  frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  for (const Look& look : look_at_view(frame, model, kPose, 50).looks) EXPECT_TRUE(std::isnan(look.beyond));
}

}  // namespace
}  // namespace houghstream
