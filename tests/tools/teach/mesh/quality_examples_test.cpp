#include "tools/teach/mesh/quality_examples.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace houghstream::quality {
namespace {

const cv::Rect kBox(100, 100, 80, 80);
const cv::Rect kElsewhere(300, 100, 80, 80);

/// A corner of three points, 0.2 m in diameter.
std::map<std::string, PoseModel> corner() {
  return {{"corner", {{{0.1F, 0.0F, 0.0F}, {0.0F, 0.1F, 0.0F}, {0.0F, 0.0F, 0.1F}}, 0.2}}};
}

Eigen::Isometry3d at(double x) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(x, 0.0, 2.0);
  return T;
}

/// One corner at x = 0, half visible, and no detections yet.
FoundPoses one_frame() {
  FoundPoses found;
  found.scene = "desk";
  found.frames.resize(1);
  NamedObject object{"corner", {}};
  object.truth.box_visible_px = kBox;
  object.truth.visible_fraction = 0.5;
  object.truth.T_camera_object = at(0.0);
  found.frames[0].objects = {object};
  found.frames[0].detections = Detections();
  found.frames[0].poses = ObjectPoses();
  found.terms.resize(1);
  return found;
}

/// The detection's pose is at `x`; nothing: it has none. Its number is known again by its visible term.
void add(FoundPoses& found, const std::string& class_name, const cv::Rect& box_px, std::optional<double> x) {
  Detection detection;
  detection.class_name = class_name;
  detection.box_px = box_px;
  detection.score = 0.9F - 0.1F * static_cast<float>(found.terms[0].size());
  ObjectPose pose;
  pose.class_name = class_name;
  QualityTerms terms;
  terms.visible = static_cast<double>(found.terms[0].size());
  if (x) pose.T_camera_object = at(*x);
  found.frames[0].detections->detections.push_back(detection);
  found.frames[0].poses->poses.push_back(pose);
  found.terms[0].push_back(x ? std::optional<PoseTerms>({terms, terms}) : std::nullopt);
}

TEST(QualityExamples, APoseIsRightWithinATenthOfTheDiameter) {
  for (const double x : {0.0, 0.019, 0.021}) {
    FoundPoses found = one_frame();
    add(found, "corner", kBox, x);
    const std::vector<Example> examples = label_examples(found, corner());
    ASSERT_EQ(examples.size(), 1U);
    EXPECT_EQ(examples[0].scene, "desk");
    EXPECT_EQ(examples[0].score, 0.9F);
    EXPECT_TRUE(examples[0].is_present) << "whether its pose is right or not";
    EXPECT_EQ(examples[0].is_correct, x < 0.02) << x;
    EXPECT_EQ(examples[0].is_correct_up_to_shape, x < 0.02) << x;
    EXPECT_EQ(examples[0].with_swapped_texture.has_value(), x < 0.02) << "of a wrong pose another print says nothing";
  }
}

TEST(QualityExamples, APoseThatIsTurnedByItsShapeIsRightUpToThatOnlyUnlessTheDatasetListsIt) {
  const Eigen::Isometry3d rotation(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  PoseModel bar{{{0.1F, 0.0F, 0.0F}, {-0.1F, 0.0F, 0.0F}}, 0.2};
  for (const bool is_listed : {false, true}) {
    FoundPoses found = one_frame();
    add(found, "corner", kBox, 0.0);
    found.frames[0].poses->poses[0].T_camera_object = at(0.0) * rotation;
    if (is_listed) bar.symmetries.push_back(rotation);
    const std::vector<Example> examples = label_examples(found, {{"corner", bar}});
    ASSERT_EQ(examples.size(), 1U);
    EXPECT_EQ(examples[0].is_correct, is_listed);
    EXPECT_TRUE(examples[0].is_correct_up_to_shape);
    EXPECT_TRUE(examples[0].with_swapped_texture.has_value()) << "which is what today's fit learns from";
  }
}

TEST(QualityExamples, OfFalseDetectionsEveryPoseIsWrong) {
  FoundPoses found = one_frame();
  add(found, "corner", kBox, 0.0);
  add(found, "corner", kElsewhere, 0.0);  // as good a pose, but the object has been found
  add(found, "mug", kBox, 0.0);           // has no model: nobody's
  const std::vector<Example> examples = label_examples(found, corner());
  ASSERT_EQ(examples.size(), 2U);
  EXPECT_TRUE(examples[0].is_correct);
  EXPECT_FALSE(examples[1].is_correct);
  EXPECT_FALSE(examples[1].is_correct_up_to_shape);
  EXPECT_FALSE(examples[1].is_present);
  EXPECT_EQ(examples[1].terms.visible, 1.0) << "with its own evidence";
}

TEST(QualityExamples, WhatCannotBeJudgedIsLeftOut) {
  FoundPoses without_pose = one_frame();
  add(without_pose, "corner", kBox, std::nullopt);
  EXPECT_TRUE(label_examples(without_pose, corner()).empty());
  FoundPoses hardly_visible = one_frame();
  hardly_visible.frames[0].objects[0].truth.visible_fraction = 0.05;
  add(hardly_visible, "corner", kBox, 0.0);
  EXPECT_TRUE(label_examples(hardly_visible, corner()).empty());
  FoundPoses box_only = one_frame();
  box_only.frames[0].objects[0].truth.has_pose = false;
  add(box_only, "corner", kBox, 0.0);
  EXPECT_TRUE(label_examples(box_only, corner()).empty());
}

}  // namespace
}  // namespace houghstream::quality
