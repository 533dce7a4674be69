#include "detector/evidence/template_alignment.hpp"

#include <gtest/gtest.h>

#include "pipeline/types/detection.hpp"
#include "tests/detector/evidence/template_view.hpp"

namespace houghstream {
namespace {

TEST(BestTemplates, AreInOrderAndOfEqualOnesTheFirstStay) {
  BestTemplates<3> best;
  EXPECT_EQ(best.size(), 0U);
  std::uint32_t view = 0;
  for (const float visible : {0.2F, 0.5F, 0.1F, 0.5F, 0.2F, 0.9F}) {
    PlacedTemplate placed;
    placed.view = view++;
    placed.fit.visible_fraction = visible;
    best.add(placed);
  }
  std::vector<std::uint32_t> views;
  for (const PlacedTemplate& placed : best) views.push_back(placed.view);
  EXPECT_EQ(views, (std::vector<std::uint32_t>{5, 1, 3}));
  EXPECT_EQ(best.front().view, 5U);
}

TEST(ViewAlignment, AVoteBesideTheCentreFindsItsWayBack) {
  const TrainingView seen = toy::training_views().front();
  const ViewTemplate view = toy::template_view();
  const LabFrame frame = toy::lab_frame(seen.frame, seen.frame.colour, 1.0F);
  const cv::Rect2f truth(cv::boundingRect(seen.mask));
  const float cell = (view.box[2] - view.box[0]) / TemplateGrid::kBoxSide;
  for (const float sideways : {-2.0F, 2.0F}) {
    const Eigen::Vector3f beside(sideways * cell, 0.0F, toy::kDistance);
    const PlacedTemplate before = {0, beside, match_template(view, beside, frame)};
    const PlacedTemplate placed = align_template({view}, before, frame);
    const TemplateMatch& after = placed.fit;
    EXPECT_GT(match_quality(after), match_quality(before.fit));
    EXPECT_EQ(match_quality(after), match_quality(match_template(view, placed.centre_camera, frame)));
    EXPECT_GT(after.visible_fraction, 0.97F);
    EXPECT_GT(box_iou(after.visible_box_px, truth), 0.9F);
  }
}

TEST(ViewAlignment, WhereNothingIsBetterNothingMoves) {
  const TrainingView seen = toy::training_views().front();
  const ViewTemplate view = toy::template_view();
  const LabFrame frame = toy::lab_frame(seen.frame, seen.frame.colour, 1.0F);
  const Eigen::Vector3f outside(3.0F, 0.0F, toy::kDistance);
  const PlacedTemplate nothing = {0, outside, match_template(view, outside, frame)};
  const PlacedTemplate aligned = align_template({view}, nothing, frame);
  EXPECT_EQ(match_quality(aligned.fit), match_quality(nothing.fit));
  EXPECT_EQ(aligned.centre_camera, outside);
}

/// The votes meet beside the centre, where a plain grey view of the same shape agrees better than the right one.
TEST(ViewAlignment, TheViewThatAgreesBestOnceAlignedIsTaken) {
  const TrainingView seen = toy::training_views().front();
  const LabFrame frame = toy::lab_frame(seen.frame, seen.frame.colour, 1.0F);
  const ViewTemplate right = toy::template_view();
  const float cell = (right.box[2] - right.box[0]) / TemplateGrid::kBoxSide;
  const Eigen::Vector3f beside(cell, 0.0F, toy::kDistance);
  ViewTemplate wrong = right;
  wrong.box[0] -= cell;
  wrong.box[2] -= cell;
  for (auto& lab : wrong.appearance.lab) lab = {128, 128, 128};
  const std::vector<ViewTemplate> views = {right, wrong};
  std::vector<PlacedTemplate> compared = {{0, beside, match_template(right, beside, frame)},
                                          {1, beside, match_template(wrong, beside, frame)}};
  ASSERT_EQ(best_match(compared).view, 1U);
  const std::vector<PlacedTemplate> before = compared;
  const PlacedTemplate aligned = align_best_templates(views, frame, compared);
  EXPECT_EQ(aligned.view, 0U);
  EXPECT_EQ(match_quality(aligned.fit), match_quality(align_template(views, before[0], frame).fit));
  EXPECT_GT(match_quality(aligned.fit), match_quality(align_template(views, before[1], frame).fit));
}

TEST(ViewAlignment, AnObjectOfAnotherSizeAgreesBetterInThatSize) {
  const TrainingView seen = toy::training_views().front();
  const LabFrame frame = toy::lab_frame(seen.frame, seen.frame.colour, 1.0F);
  const ViewTemplate right = toy::template_view();
  const Eigen::Vector3f centre(0.0F, 0.0F, toy::kDistance);
  const auto gain = [&](const ViewTemplate& view) {
    return alternative_scale_gain(view, {0, centre, match_template(view, centre, frame)}, frame);
  };
  EXPECT_LT(gain(right), -0.05F);
  for (const float seen_size : {0.7F, 1.4F}) {  // ratio of the frame's object to the template's
    EXPECT_GT(gain(toy::resized(right, 1.0F / seen_size)), 0.05F) << seen_size;
  }
}

}  // namespace
}  // namespace houghstream
