#include "tools/studies/tracks/add_metric.hpp"

#include <gtest/gtest.h>

namespace houghstream::studies {
namespace {

Eigen::Isometry3d at_height(double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, z));
}

/// A stick of 20 cm: its diameter.
AddModel stick() {
  AddModel model;
  for (int i = 0; i <= 20; ++i) model.points.emplace_back(0.01F * static_cast<float>(i) - 0.1F, 0.0F, 0.0F);
  model.diameter_m = 0.2;
  return model;
}

SequenceFile one_stick(int frames) {
  SequenceFile out;
  for (int i = 0; i < frames; ++i) {
    out.utimes.push_back(100000 * i);
    out.frames.push_back({{1, "stick", at_height(0.0), 1.0}});
  }
  return out;
}

OrderedJson measure(const SequenceFile& sequence, const std::vector<PublishedFrame>& published,
                    const ClassSymmetries& symmetries = {}) {
  return add_metrics(match_published(sequence, published, symmetries), {{"stick", stick()}});
}

TEST(AddMetrics, ATenthOfTheDiameterDividesRightFromWrong) {
  const SequenceFile sequence = one_stick(4);
  Eigen::Isometry3d rotated = at_height(0.0);
  rotated.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  std::vector<PublishedFrame> published = {{0, {{0, "stick", at_height(0.019)}}, {0.95}},
                                           {1, {{0, "stick", at_height(0.021)}}, {0.95}},
                                           {2, {{0, "stick", rotated}}, {0.5}},
                                           {3, {}}};
  const OrderedJson json = measure(sequence, published);
  EXPECT_EQ(json["add"]["stick"], 0.25) << "what is not published is not right";
  EXPECT_EQ(json["wrong_above_0_9"]["published"], 2);
  EXPECT_EQ(json["wrong_above_0_9"]["wrong"], 1);
  Symmetries half_turn;
  half_turn.discrete.push_back(Eigen::Isometry3d(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ())));
  const OrderedJson alike = measure(sequence, published, {{"stick", half_turn}});
  EXPECT_EQ(alike["add"]["stick"], 0.5);
  EXPECT_NEAR(alike["median_error"]["stick"]["mm"], 19.0, 1e-3) << "of 0, 19 and 21";
  EXPECT_NEAR(alike["median_error"]["stick"]["deg"], 0.0, 1e-3);
  EXPECT_NEAR(json["median_error"]["stick"]["deg"], 0.0, 1e-3);
}

TEST(AddMetrics, WhatIsHardlyVisibleHasNoPlaceInTheMedians) {
  SequenceFile sequence = one_stick(1);
  sequence.frames[0][0].visible = 0.3;
  const OrderedJson json = measure(sequence, {{0, {{0, "stick", at_height(0.01)}}}});
  EXPECT_EQ(json["add"]["stick"], 1.0);
  EXPECT_TRUE(json["median_error"].empty());
}

TEST(AddMetrics, TracksHaveNoQualities) {
  const SequenceFile sequence = one_stick(1);
  const OrderedJson json = measure(sequence, {{0, {{3, "stick", at_height(0.0)}}}});
  EXPECT_EQ(json["add"]["stick"], 1.0);
  EXPECT_EQ(json["wrong_above_0_9"]["published"], 0);
}

TEST(AddMetrics, AModelOfAMeshHasItsDiameter) {
  Mesh mesh;
  mesh.vertices = {{0.0F, 0.0F, 0.0F}, {0.3F, 0.0F, 0.0F}, {0.0F, 0.4F, 0.0F}};
  mesh.triangles = {{0, 1, 2}};
  const AddModel model = make_add_model(mesh);
  EXPECT_NEAR(model.diameter_m, 0.5, 1e-6);
  EXPECT_EQ(model.points.size(), 500U);
}

}  // namespace
}  // namespace houghstream::studies
