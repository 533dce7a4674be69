#include "pose/verification/colour_score.hpp"

#include <gtest/gtest.h>

#include "tests/pose/printed_box.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

const Eigen::Isometry3d kPose = standing(30.0, 30.0, 0.8);
const DepthTolerance kTolerance{0.008, {}};

std::optional<ColourComparison> compare(const RgbdFrame& frame, const Mesh& mesh,
                                        const Eigen::Isometry3d& T_camera_object) {
  const ObjectModel model = make_object_model("box", mesh, {});
  const LabRegion colours = lab_region(frame, cv::Rect(0, 0, 640, 480));
  return compare_colours(colours, look_at_view(frame, model, T_camera_object, 400), kTolerance);
}

float agreement(const RgbdFrame& frame, const Mesh& mesh, const Eigen::Isometry3d& T_camera_object) {
  return compare(frame, mesh, T_camera_object).value().agreement;
}

ColourComparison agreeing_by(float share) {
  return {100, share, 10.0F, 1.0F};
}

TEST(ColourScore, TheRightSideExplainsWhatIsSeenAndTheOppositeDoesNot) {
  const Mesh box = printed_box();
  const RgbdFrame frame = coloured_frame(box, kPose, 1);
  const float right = agreement(frame, box, kPose);
  EXPECT_GT(right, 0.8F);
  EXPECT_LT(agreement(frame, box, turned(kPose, 180.0)), right - 0.4F);
  const ColourComparison front = compare(frame, box, kPose).value();
  EXPECT_LT(front.left_over, 0.6F * compare(frame, box, turned(kPose, 180.0))->left_over);
  EXPECT_LT(front.chroma_shift, 6.0F);
  EXPECT_GT(front.points, 200);
}

TEST(ColourScore, ADimmerAndYellowerLightDecidesNothing) {
  const Mesh box = printed_box();
  RgbdFrame frame = coloured_frame(box, kPose, 1);
  const float before = agreement(frame, box, kPose);
  cv::multiply(frame.colour, cv::Scalar(0.5, 0.6, 0.65), frame.colour);
  EXPECT_GT(agreement(frame, box, kPose), before - 0.12F);
}

TEST(ColourScore, WithoutColoursOrMeasuredDepthThereIsNoAnswer) {
  const Mesh box = printed_box();
  RgbdFrame frame = coloured_frame(box, kPose, 1);
  EXPECT_FALSE(compare(frame, cereal_box(), kPose).has_value());
  frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_FALSE(compare(frame, box, kPose).has_value());
}

TEST(ColourScore, OnlyThePartThatIsGivenIsLookedAt) {
  const Mesh box = printed_box();
  const RgbdFrame frame = coloured_frame(box, kPose, 1);
  const ObjectModel model = make_object_model("box", box, {});
  const LabRegion corner = lab_region(frame, cv::Rect(0, 0, 20, 20));
  EXPECT_FALSE(compare_colours(corner, look_at_view(frame, model, kPose, 400), kTolerance).has_value());
}

TEST(ColourScore, ColourLowersOnlyWhatDepthSpeaksFor) {
  EXPECT_GT(joint_score(0.8F, agreeing_by(0.9F)), joint_score(0.8F, agreeing_by(0.2F)));
  EXPECT_GT(joint_score(0.8F, std::nullopt), joint_score(0.8F, agreeing_by(0.0F)));
  EXPECT_GT(joint_score(0.8F, agreeing_by(-2.0F)), 0.0F);
  EXPECT_EQ(joint_score(-0.3F, agreeing_by(0.9F)), -0.3F);
}

}  // namespace
}  // namespace houghstream
