#include "detector/evidence/view_alignment.hpp"

#include <gtest/gtest.h>

#include "pipeline/detection.hpp"
#include "tests/detector/evidence/remembered_view.hpp"

namespace houghstream {
namespace {

TEST(ViewAlignment, AVoteBesideTheCentreFindsItsWayBack) {
  const TrainingView seen = toy::training_views().front();
  const TrainedView view = toy::remembered_view();
  const LabFrame frame = make_lab_frame(seen.frame, seen.frame.colour, 1.0F);
  const cv::Rect2f truth(cv::boundingRect(seen.mask));
  const float cell = (view.box[2] - view.box[0]) / Appearance::kBoxSide;
  for (const float sideways : {-2.0F, 2.0F}) {
    const Eigen::Vector3f beside(sideways * cell, 0.0F, toy::kDistance);
    const ViewFit before = fit_view(view, beside, frame);
    const ViewFit after = align_view(view, beside, before, frame);
    EXPECT_GT(agreement(after), agreement(before));
    EXPECT_GT(after.visible, 0.97F);
    EXPECT_GT(box_iou(after.visible_box_px, truth), 0.9F);
  }
}

TEST(ViewAlignment, WhereNothingIsBetterNothingMoves) {
  const TrainingView seen = toy::training_views().front();
  const TrainedView view = toy::remembered_view();
  const LabFrame frame = make_lab_frame(seen.frame, seen.frame.colour, 1.0F);
  const Eigen::Vector3f outside(3.0F, 0.0F, toy::kDistance);
  const ViewFit nothing = fit_view(view, outside, frame);
  EXPECT_EQ(agreement(align_view(view, outside, nothing, frame)), agreement(nothing));
}

/// The votes meet beside the centre, where a plain grey view of the same shape agrees better than the right one.
TEST(ViewAlignment, TheViewThatAgreesBestOnceAlignedIsTaken) {
  const TrainingView seen = toy::training_views().front();
  const LabFrame frame = make_lab_frame(seen.frame, seen.frame.colour, 1.0F);
  const TrainedView right = toy::remembered_view();
  const float cell = (right.box[2] - right.box[0]) / Appearance::kBoxSide;
  const Eigen::Vector3f beside(cell, 0.0F, toy::kDistance);
  TrainedView wrong = right;
  wrong.box[0] -= cell;
  wrong.box[2] -= cell;
  for (auto& lab : wrong.appearance.lab) lab = {128, 128, 128};
  const std::vector<ComparedView> compared = {{0, fit_view(right, beside, frame)}, {1, fit_view(wrong, beside, frame)}};
  ASSERT_EQ(best_unaligned(compared).view, 1U);
  const ViewFit aligned = best_aligned({right, wrong}, compared, beside, frame);
  EXPECT_EQ(agreement(aligned), agreement(align_view(right, beside, compared[0].fit, frame)));
  EXPECT_GT(agreement(aligned), agreement(align_view(wrong, beside, compared[1].fit, frame)));
}

}  // namespace
}  // namespace houghstream
