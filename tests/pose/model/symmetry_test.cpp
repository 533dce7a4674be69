#include "pose/model/symmetry.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

Eigen::Quaterniond rotation(double degrees, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * M_PI / 180.0, axis.normalized()));
}

Eigen::Isometry3d half_turn(const Eigen::Vector3d& axis) {
  return Eigen::Isometry3d(rotation(180.0, axis));
}

Symmetries box_symmetries() {
  return {
      {half_turn(Eigen::Vector3d::UnitX()), half_turn(Eigen::Vector3d::UnitY()), half_turn(Eigen::Vector3d::UnitZ())},
      {}};
}

const Eigen::Quaterniond kSomeRotation = rotation(70.0, {0.3, -0.8, 0.5});

TEST(Symmetry, WithoutAnyThereIsTheIdentityAlone) {
  const auto all = expand_symmetries({});
  ASSERT_EQ(all.size(), 1U);
  EXPECT_TRUE(all[0].isApprox(Eigen::Isometry3d::Identity()));
}

TEST(Symmetry, AContinuousOneIsCutIntoAsManyTurnsAsBopToolkitMakes) {
  const Symmetries symmetries = {{}, {{Eigen::Vector3d::UnitZ(), {0.1, 0.0, 0.0}}}};
  const auto all = expand_symmetries(symmetries);
  ASSERT_EQ(all.size(), 315U) << "ceil(pi / 0.01)";
  EXPECT_TRUE(all[0].isApprox(Eigen::Isometry3d::Identity()));
  // A point half a diameter of 1 m from the axis moves by less than 0.01 m from one turn to the next.
  const Eigen::Vector3d rim(0.6, 0.0, 0.3);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_LT((all[i] * rim - all[(i + 1) % all.size()] * rim).norm(), 0.01);
    EXPECT_LT((all[i] * Eigen::Vector3d(0.1, 0.0, 0.7) - Eigen::Vector3d(0.1, 0.0, 0.7)).norm(), 1e-12) << "the axis";
  }
  EXPECT_EQ(expand_symmetries(symmetries, 0.5).size(), 7U);
  EXPECT_THROW(expand_symmetries(symmetries, 0.0), InputError);
}

TEST(Symmetry, DiscreteAndContinuousOnesAreCombined) {
  EXPECT_EQ(expand_symmetries(box_symmetries()).size(), 4U);
  const Symmetries cylinder = {{half_turn(Eigen::Vector3d::UnitX())}, {ContinuousSymmetry{}}};
  const auto all = expand_symmetries(cylinder);
  ASSERT_EQ(all.size(), 630U);
  // The order is bop_toolkit's: the continuous rotation comes after the discrete motion.
  const Eigen::Isometry3d expected = all[5] * half_turn(Eigen::Vector3d::UnitX());
  EXPECT_TRUE(all[315 + 5].isApprox(expected));
}

TEST(Symmetry, ABoxGoesToTheNearestOfItsFourRotations) {
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(Eigen::Vector3d::UnitX()), Eigen::Vector3d(0, 0, 1)}) {
    const Eigen::Quaterniond other = kSomeRotation * rotation(170.0, axis);
    EXPECT_NEAR(nearest_equivalent(other, kSomeRotation, box_symmetries()).angularDistance(kSomeRotation),
                10.0 * M_PI / 180.0, 1e-9);
  }
  const Eigen::Quaterniond near = kSomeRotation * rotation(80.0, Eigen::Vector3d::UnitY());
  EXPECT_NEAR(nearest_equivalent(near, kSomeRotation, box_symmetries()).angularDistance(near), 0.0, 1e-9);
}

TEST(Symmetry, ABodyOfRevolutionKeepsOnlyTheTiltOfItsAxis) {
  const Symmetries bowl = {{}, {ContinuousSymmetry{}}};
  const Eigen::Quaterniond other =
      kSomeRotation * rotation(20.0, Eigen::Vector3d::UnitX()) * rotation(133.0, Eigen::Vector3d::UnitZ());
  const Eigen::Quaterniond nearest = nearest_equivalent(other, kSomeRotation, bowl);
  EXPECT_NEAR(nearest.angularDistance(kSomeRotation), 20.0 * M_PI / 180.0, 1e-9);
  const Eigen::Vector3d axis = other * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR((nearest * Eigen::Vector3d::UnitZ() - axis).norm(), 0.0, 1e-9) << "still points where it did";
}

TEST(Symmetry, NothingInTheExpansionIsNearerThanTheNearest) {
  const Symmetries cylinder = {{half_turn(Eigen::Vector3d::UnitX())},
                               {{Eigen::Vector3d(0.0, 0.6, 0.8).normalized(), Eigen::Vector3d::Zero()}}};
  const Eigen::Quaterniond other = rotation(155.0, {-0.7, 0.1, 0.4});
  const double nearest = nearest_equivalent(other, kSomeRotation, cylinder).angularDistance(kSomeRotation);
  double nearest_listed = M_PI;
  for (const Eigen::Isometry3d& symmetry : expand_symmetries(cylinder)) {
    const Eigen::Quaterniond equivalent = other * Eigen::Quaterniond(symmetry.linear());
    nearest_listed = std::min(nearest_listed, equivalent.angularDistance(kSomeRotation));
  }
  EXPECT_LE(nearest, nearest_listed + 1e-9);
  EXPECT_NEAR(nearest, nearest_listed, 0.01) << "half a step of the expansion";
}

TEST(Symmetry, ABallHasNoRotation) {
  const Symmetries ball = {
      {}, {{Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero()}, {Eigen::Vector3d::UnitX(), Eigen::Vector3d::Zero()}}};
  const Eigen::Quaterniond other = rotation(155.0, {-0.7, 0.1, 0.4});
  EXPECT_NEAR(nearest_equivalent(other, kSomeRotation, ball).angularDistance(kSomeRotation), 0.0, 1e-7);
}

TEST(Symmetry, APoseMovesAlongWhereTheAxisIsOffTheOrigin) {
  const Symmetries bowl = {{}, {{Eigen::Vector3d::UnitZ(), {0.1, 0.0, 0.0}}}};
  Eigen::Isometry3d T_ground_truth(kSomeRotation);
  T_ground_truth.pretranslate(Eigen::Vector3d(0.1, 0.2, 0.9));
  const Eigen::Translation3d offset(0.1, 0.0, 0.0);
  const Eigen::Isometry3d rotated =
      T_ground_truth * offset * rotation(120.0, Eigen::Vector3d::UnitZ()) * offset.inverse();
  EXPECT_TRUE(nearest_equivalent(rotated, T_ground_truth, bowl).isApprox(T_ground_truth, 1e-9));
}

TEST(Symmetry, HalfATurnAcrossTheAxisIsNoTwist) {
  const Symmetries bowl = {{}, {ContinuousSymmetry{}}};
  const Eigen::Quaterniond upside_down = rotation(180.0, Eigen::Vector3d::UnitX());
  const Eigen::Quaterniond nearest = nearest_equivalent(upside_down, Eigen::Quaterniond::Identity(), bowl);
  EXPECT_NEAR(nearest.angularDistance(upside_down), 0.0, 1e-9);
}

}  // namespace
}  // namespace houghstream
