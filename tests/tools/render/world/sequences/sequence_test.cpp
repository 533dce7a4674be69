#include "tools/render/world/sequences/sequence.hpp"

#include <gtest/gtest.h>

namespace houghstream::world {
namespace {

SequencePlan plan_of(const std::string& name) {
  for (const SequencePlan& plan : sequence_plans()) {
    if (plan.name == name) return plan;
  }
  throw std::logic_error(name);
}

TEST(Sequence, WhatIsPushedStaysOnTheTableAndMovesSteadilyBetweenItsStops) {
  const Sequence sequence(plan_of("pushed"), DatasetSplit::kTraining);
  const double height = sequence.truth(0.0).T_world_object.at(2)->translation().z();
  double before = sequence.truth(2.0).T_world_object.at(2)->translation().y();
  for (double seconds = 2.1; seconds < 4.0; seconds += 0.1) {
    const Eigen::Vector3d place = sequence.truth(seconds).T_world_object.at(2)->translation();
    EXPECT_NEAR(place.z(), height, 1e-12);
    EXPECT_GT(place.y(), before);
    EXPECT_LT(place.y() - before, 0.02);
    before = place.y();
  }
}

TEST(Sequence, WhatIsTakenAwayIsNotThereAndComesBackElsewhere) {
  const Sequence sequence(plan_of("removed"), DatasetSplit::kTraining);
  EXPECT_TRUE(sequence.truth(1.0).T_world_object.at(3).has_value());
  EXPECT_FALSE(sequence.truth(6.0).T_world_object.at(3).has_value());
  ASSERT_TRUE(sequence.truth(12.0).T_world_object.at(3).has_value());
  EXPECT_FALSE(sequence.truth(12.0).T_world_object.at(0).has_value());
}

TEST(Sequence, TheArmHidesObjectsAndThreeCamerasLookFromThreeSides) {
  const Sequence arm(plan_of("arm"), DatasetSplit::kTraining);
  const auto visible = [&](double seconds) {
    double minimum = 1.0;
    const RenderedFrame view = arm.render(0, seconds, 0);
    for (const GroundTruthObject& object : view.objects) minimum = std::min(minimum, object.visible_fraction);
    return view.objects.size() < 4 ? 0.0 : minimum;
  };
  EXPECT_GT(visible(0.0), 0.5);
  EXPECT_LT(visible(4.7), 0.5);
  const Sequence three(plan_of("cameras"), DatasetSplit::kTraining);
  ASSERT_EQ(three.cameras(), 3);
  const SequenceGroundTruth truth = three.truth(0.0);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < i; ++k) {
      const Eigen::Vector3d a = truth.T_camera_world[static_cast<std::size_t>(i)].inverse().translation();
      const Eigen::Vector3d b = truth.T_camera_world[static_cast<std::size_t>(k)].inverse().translation();
      EXPECT_GT((a - b).norm(), 0.8);
    }
  }
}

}  // namespace
}  // namespace houghstream::world
