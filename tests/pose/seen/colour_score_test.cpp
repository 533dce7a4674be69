#include "pose/seen/colour_score.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "pipeline/base/random.hpp"
#include "tests/pose/printed_box.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

const Eigen::Isometry3d kPose = standing(30.0, 30.0, 0.8);
const DepthTolerance kColourTolerance{0.008, {}};

std::optional<ColourComparison> compare(const RgbdFrame& frame, const Mesh& mesh,
                                        const Eigen::Isometry3d& T_camera_object) {
  const ObjectModel model = make_object_model("box", mesh, {});
  const LabRegion colours = lab_region(frame, cv::Rect(0, 0, 640, 480), {});
  return compare_colours(colours, project_view(frame, model, T_camera_object, 400), kColourTolerance);
}

float agreement(const RgbdFrame& frame, const Mesh& mesh, const Eigen::Isometry3d& T_camera_object) {
  return compare(frame, mesh, T_camera_object).value().agreement;
}

ColourComparison agreeing_by(float fraction) {
  ColourComparison comparison;
  comparison.agreement = fraction;
  return comparison;
}

TEST(ColourScore, TheRightSideExplainsWhatIsSeenAndTheOppositeDoesNot) {
  const Mesh box = printed_box();
  const RgbdFrame frame = coloured_frame(box, kPose, 1);
  const float right = agreement(frame, box, kPose);
  EXPECT_GT(right, 0.8F);
  EXPECT_LT(agreement(frame, box, rotated(kPose, 180.0)), right - 0.4F);
  const ColourComparison front = compare(frame, box, kPose).value();
  EXPECT_LT(front.residual_stddev, 0.6F * compare(frame, box, rotated(kPose, 180.0))->residual_stddev);
  EXPECT_LT(front.chroma_difference, 0.4F);
  EXPECT_GT(front.points, 200);
}

TEST(ColourScore, ADimmerAndYellowerLightDecidesNothing) {
  const Mesh box = printed_box();
  RgbdFrame frame = coloured_frame(box, kPose, 1);
  const float before = agreement(frame, box, kPose);
  cv::multiply(frame.colour, cv::Scalar(0.5, 0.6, 0.65), frame.colour);
  EXPECT_GT(agreement(frame, box, kPose), before - 0.12F);
}

TEST(ColourScore, WhereTheCameraWasAtItsLimitNothingIsCompared) {
  const Mesh box = printed_box();
  RgbdFrame frame = coloured_frame(box, kPose, 1);
  const ColourComparison before = compare(frame, box, kPose).value();
  frame.colour.rowRange(200, 250).setTo(cv::Scalar::all(255));  // a highlight across the box
  const ColourComparison after = compare(frame, box, kPose).value();
  EXPECT_LT(after.points, before.points - 50);
  EXPECT_EQ(after.points + after.clipped, before.points + before.clipped);
  EXPECT_GT(after.agreement, before.agreement - 0.1F);
  frame.colour.setTo(cv::Scalar(60, 120, 255));
  EXPECT_FALSE(compare(frame, box, kPose)) << "one channel is enough";
}

/// Returns the image with its colours' distance from grey times `strength`.
RgbdFrame with_saturation(RgbdFrame frame, double strength) {
  cv::Mat grey;
  cv::cvtColor(frame.colour, grey, cv::COLOR_BGR2GRAY);
  cv::cvtColor(grey, grey, cv::COLOR_GRAY2BGR);
  cv::addWeighted(frame.colour, strength, grey, 1.0 - strength, 0.0, frame.colour);
  return frame;
}

TEST(ColourScore, PalerColoursAreNoConflictAndOthersAre) {
  Mesh box = printed_box();
  for (cv::Vec3b& colour : box.colours) colour = cv::Vec3b(40, colour[1] / 3, 200);  // all sides reddish
  RgbdFrame frame = coloured_frame(box, kPose, 1);
  frame.colour *= 1.4;  // as bright as the model, on the whole
  EXPECT_LT(compare(frame, box, kPose)->chroma_difference, 0.4F);
  EXPECT_LT(compare(with_saturation(frame, 0.75), box, kPose)->chroma_difference, 0.4F);
  RgbdFrame blue = frame;
  cv::cvtColor(frame.colour, blue.colour, cv::COLOR_BGR2RGB);
  const float other = compare(blue, box, kPose)->chroma_difference;
  EXPECT_GT(other, 2.0F);
  EXPECT_LE(other, 4.0F);
  EXPECT_GT(compare(with_saturation(frame, 0.0), box, kPose)->chroma_difference, 1.0F) << "grey is not pale red";
}

TEST(ColourScore, TheMeanChromaIsOfWhatTheCameraWasAtItsLimitForToo) {
  Mesh box = printed_box();
  for (cv::Vec3b& colour : box.colours) colour = cv::Vec3b(40, 200, 220);  // yellow
  RgbdFrame frame = coloured_frame(box, kPose, 1);
  frame.colour.rowRange(265, 480).setTo(cv::Scalar(40, 60, 180));  // its lower edge beside something red
  const float in_full_sight = compare(frame, box, kPose)->chroma_difference;
  frame.colour.rowRange(0, 260).setTo(cv::Scalar(60, 220, 255));  // all of the rest at the limit
  const ColourComparison after = compare(frame, box, kPose).value();
  EXPECT_GT(after.clipped, after.points);
  EXPECT_LT(after.chroma_difference, in_full_sight + 0.3F);
}

TEST(ColourScore, ContrastsAreOfWhatIsCompared) {
  const Mesh box = printed_box();
  RgbdFrame frame = coloured_frame(box, kPose, 1);
  const ColourComparison printed = compare(frame, box, kPose).value();
  EXPECT_GT(printed.model_contrast, 20.0F);
  EXPECT_GT(printed.observed_contrast, printed.residual_stddev);
  frame.colour.setTo(cv::Scalar(90, 90, 90));
  const ColourComparison plain = compare(frame, box, kPose).value();
  EXPECT_LT(plain.observed_contrast, 2.0F);
  EXPECT_EQ(plain.model_contrast, printed.model_contrast);
}

TEST(ColourScore, ATextureIsJudgedWhereItAgreesBestWithinTwoPixels) {
  const Mesh box = printed_box();
  const ObjectModel model = make_object_model("box", box, {});
  const auto judged = [&](const Eigen::Isometry3d& T_camera_object, double moved_px) {
    RgbdFrame frame = coloured_frame(box, kPose, 1);
    const cv::Mat move = (cv::Mat_<double>(2, 3) << 1.0, 0.0, moved_px, 0.0, 1.0, 0.0);
    cv::warpAffine(frame.colour, frame.colour, move, frame.colour.size());
    ObjectObservation observation{frame, model};
    observation.colours = lab_region(frame, cv::Rect(0, 0, 640, 480), {});
    return compare_texture(observation, project_view(frame, model, T_camera_object, 400), kColourTolerance)->agreement;
  };
  EXPECT_GT(judged(kPose, 2.0), judged(kPose, 0.0) - 0.02F);
  EXPECT_LT(judged(kPose, 12.0), judged(kPose, 0.0) - 0.1F);
  EXPECT_LT(judged(rotated(kPose, 180.0), 0.0), judged(kPose, 0.0) - 0.4F);
}

TEST(ColourScore, JudgingATextureLeavesTheImageAsItIs) {
  const Mesh box = printed_box();
  const ObjectModel model = make_object_model("box", box, {});
  const RgbdFrame frame = coloured_frame(box, kPose, 1);
  ObjectObservation observation{frame, model};
  observation.colours = lab_region(frame, cv::Rect(0, 0, 640, 480), {});
  const ProjectedView look = project_view(frame, model, kPose, 400);
  const float first = compare_texture(observation, look, kColourTolerance)->agreement;
  EXPECT_EQ(compare_texture(observation, look, kColourTolerance)->agreement, first);
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
  const LabRegion corner = lab_region(frame, cv::Rect(0, 0, 20, 20), {});
  EXPECT_FALSE(compare_colours(corner, project_view(frame, model, kPose, 400), kColourTolerance).has_value());
}

TEST(ColourScore, ColourLowersOnlyWhatDepthSpeaksFor) {
  EXPECT_GT(joint_score(0.8F, agreeing_by(0.9F)), joint_score(0.8F, agreeing_by(0.2F)));
  EXPECT_GT(joint_score(0.8F, std::nullopt), joint_score(0.8F, agreeing_by(0.0F)));
  EXPECT_GT(joint_score(0.8F, agreeing_by(-2.0F)), 0.0F);
  EXPECT_EQ(joint_score(-0.3F, agreeing_by(0.9F)), -0.3F);
}

std::vector<ComparedPoint> random_points(std::size_t count) {
  Random random(9);
  std::vector<ComparedPoint> points(count);
  for (ComparedPoint& point : points) {
    const auto colour = [&] { return static_cast<float>(random.below(256) - 128); };
    const auto along = [&] { return static_cast<float>(random.uniform(-100.0, 100.0)); };
    point.model = {colour(), colour(), colour(), 1.0F};
    point.observed = {colour(), colour(), colour(), 1.0F};
    point.normal = {along(), along(), along(), 1.0F};
  }
  return points;
}

/// Returns all products of the columns, in double precision.
ColourProducts reference_means(const std::vector<ComparedPoint>& points) {
  ColourProducts means = ColourProducts::Zero();
  for (const ComparedPoint& point : points) {
    Eigen::Matrix<double, kColourColumns, 1> row;
    row << point.model[0], point.normal[0], point.normal[1], point.normal[2], 1.0, point.model[1], point.model[2],
        point.observed[0], point.observed[1], point.observed[2];
    means += row * row.transpose() / static_cast<double>(points.size());
  }
  return means;
}

TEST(ColourSums, MeansAreThoseOfAllProductsWhereTheyAreSummed) {
  const std::vector<ComparedPoint> points = random_points(300);
  ColourSums sums;
  sums.add(points, 64);
  sums.add(std::vector<ComparedPoint>(points.begin() + 64, points.end()), points.size() - 64);
  EXPECT_EQ(sums.count(), 300);
  const ColourProducts means = sums.means();
  const ColourProducts expected = reference_means(points);
  constexpr Eigen::Index kTerms = kOne + 1;
  const auto near = [&](Eigen::Index a, Eigen::Index b) {
    EXPECT_NEAR(means(a, b), expected(a, b), 1e-2) << a << ' ' << b;
    EXPECT_EQ(means(a, b), means(b, a));
  };
  for (Eigen::Index a = 0; a < kTerms; ++a) {
    for (Eigen::Index b = 0; b < kTerms; ++b) near(a, b);
    near(a, kObservedLightness);
  }
  for (const Eigen::Index column : {kA, kB, kObservedLightness, kObservedA, kObservedB}) {
    near(column, column);
    near(column, kOne);
  }
  near(kA, kObservedA);
  near(kB, kObservedB);
}

}  // namespace
}  // namespace houghstream
