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

}  // namespace
}  // namespace houghstream
