#include "pose/registration/candidates.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pose/model/angles.hpp"
#include "tests/pose/test_scene.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

Eigen::Quaternionf rotation_of(const Eigen::Isometry3d& T) {
  return Eigen::Quaternionf(T.linear().cast<float>());
}

double degrees_between(const Eigen::Quaternionf& a, const Eigen::Quaternionf& b) {
  return a.angularDistance(b) * 57.29577951308232;
}

TEST(RotationClusters, TwoModesComeOutHeaviestFirst) {
  const Eigen::Isometry3d first = standing(10.0, 30.0, 1.0);
  const Eigen::Isometry3d second = standing(130.0, 30.0, 1.0);
  Random random(3);
  std::vector<RotationVote> votes;
  for (int i = 0; i < 20; ++i) {
    Eigen::Quaternionf q = rotation_of(perturbed(first, 8.0, 0.0, random));
    if (i % 2 == 0) q.coeffs() = -q.coeffs();  // the same rotation
    votes.push_back({q, 1.0F});
    votes.push_back({rotation_of(perturbed(second, 8.0, 0.0, random)), 0.7F});
  }
  InitialSettings settings;
  settings.rotated_clusters = 0;
  const std::vector<RotationCandidate> found = rotation_clusters(votes, settings);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_LT(degrees_between(found[0].R_camera_object, rotation_of(first)), 4.0);
  EXPECT_LT(degrees_between(found[1].R_camera_object, rotation_of(second)), 4.0);
  EXPECT_NEAR(found[0].weight, 20.0F, 1e-4F);
  EXPECT_NEAR(found[1].weight, 14.0F, 1e-4F);
}

TEST(RotationClusters, HeaviestIsAlsoTurnedByQuartersAboutTheObjectsAxis) {
  const Eigen::Quaternionf q = rotation_of(standing(10.0, 30.0, 1.0));
  const std::vector<RotationCandidate> found = rotation_clusters({{q, 2.0F}}, InitialSettings());
  ASSERT_EQ(found.size(), 4U);
  for (std::size_t i = 1; i < 4; ++i) {
    const Eigen::Quaternionf expected = rotation_of(standing(10.0 + 90.0 * static_cast<double>(i), 30.0, 1.0));
    EXPECT_LT(degrees_between(found[i].R_camera_object, expected), 0.1);
    EXPECT_EQ(found[i].weight, 0.0F);
  }
}

TEST(RotationClusters, NumberIsCappedEvenWithANarrowRadius) {
  Random random(4);
  std::vector<RotationVote> votes;
  votes.reserve(64);
  for (int i = 0; i < 64; ++i) {
    votes.push_back({rotation_of(perturbed(standing(0, 0, 1), 180.0 * random.uniform(), 0.0, random)), 1.0F});
  }
  InitialSettings settings;
  settings.cluster_radius_deg = 0.0;
  settings.rotated_clusters = 0;
  EXPECT_EQ(rotation_clusters(votes, settings).size(), 6U);
}

TEST(RotationClusters, UnusableVotesAreLeftOut) {
  const Eigen::Quaternionf good = rotation_of(standing(10.0, 30.0, 1.0));
  const float nan = std::nanf("");
  const std::vector<RotationVote> bad{{Eigen::Quaternionf(0, 0, 0, 0), 1.0F},
                                      {Eigen::Quaternionf(nan, 0, 0, 1), 1.0F},
                                      {good, nan},
                                      {good, 0.0F},
                                      {good, -1.0F}};
  EXPECT_TRUE(rotation_clusters(bad, InitialSettings()).empty());
  EXPECT_TRUE(rotation_clusters({}, InitialSettings()).empty());
}

TEST(RotationClusters, VotesSupportWhatTheyAgreeOn) {
  const auto about_z = [](double degrees) {
    return Eigen::Quaternionf(Eigen::AngleAxisf(static_cast<float>(degrees * kRadPerDeg), Eigen::Vector3f::UnitZ()));
  };
  const std::vector<RotationCandidate> votes = {{about_z(0.0), 4.0F}, {about_z(120.0), 1.0F}, {about_z(200.0), 0.0F}};
  const auto support = [&](double degrees) {
    return vote_support(votes, Eigen::Isometry3d(about_z(degrees).cast<double>()), {});
  };
  EXPECT_NEAR(support(0.0), 1.0F, 1e-3F);
  EXPECT_NEAR(support(120.0), 0.25F, 1e-2F);
  EXPECT_LT(support(200.0), 0.05F);
  EXPECT_EQ(vote_support({}, Eigen::Isometry3d::Identity(), {}), 0.0F);
}

/// Places candidates of a box from votes for this point of it.
void expect_best_placed_first(const Eigen::Vector3f& vote_centre) {
  const Mesh object = cereal_box();
  const Mesh ground = table();
  const Eigen::Isometry3d truth = standing(60.0, 30.0, 0.9);
  const RgbdFrame frame =
      noisy_frame({{&object, truth, 1}, {&ground, truth * Eigen::Translation3d(0, 0, -0.13), 2}}, 1);
  ModelSettings of_model;
  of_model.vote_centres["box"] = vote_centre;
  const ObjectModel model = make_object_model("box", object, of_model);
  const auto rotation = [](double azimuth) {
    return Eigen::Quaternionf(standing(azimuth, 30.0, 1.0).linear().cast<float>());
  };
  const Eigen::Vector3f centre = truth.cast<float>() * vote_centre + Eigen::Vector3f(0.01F, -0.01F, 0.02F);
  ObjectObservation observation{frame, model};
  observation.centre_camera = centre;
  const SearchSettings settings;
  const std::vector<PoseCandidate> found = place_candidates(
      observation, {{rotation(150.0), 3.0F}, {rotation(60.0), 1.0F}, {rotation(100.0), 1.0F}, {rotation(330.0), 1.0F}},
      settings);
  ASSERT_EQ(found.size(), static_cast<std::size_t>(settings.keep));
  EXPECT_GE(found[0].score, found[1].score);
  EXPECT_GE(found[1].score, found[2].score);
  EXPECT_LT((found[0].T_camera_object.translation() - truth.translation()).norm(), 0.015);
  const Eigen::Quaterniond R_camera_object(found[0].T_camera_object.linear());
  EXPECT_LT(R_camera_object.angularDistance(Eigen::Quaterniond(truth.linear())), 0.01);
}

TEST(Candidates, BestPlacedRotationComesFirst) {
  expect_best_placed_first(Eigen::Vector3f::Zero());
}

TEST(Candidates, VotesMayBeForAPointThatIsNotTheOrigin) {
  expect_best_placed_first({0.3F, -0.2F, 0.1F});
}

TEST(Candidates, TheOriginMayLieBesideTheLineOfSight) {
  const Eigen::Vector3f offset(0.5F, 0.0F, -0.4F);  // the box stands there in the frame of its mesh
  Mesh object = cereal_box();
  for (Eigen::Vector3f& vertex : object.vertices) vertex += offset;
  const Mesh ground = table();
  const Eigen::Isometry3d box = standing(60.0, 30.0, 0.9);
  const Eigen::Isometry3d truth = box * Eigen::Translation3d(-offset.cast<double>());
  const RgbdFrame frame = noisy_frame({{&object, truth, 1}, {&ground, box * Eigen::Translation3d(0, 0, -0.13), 2}}, 1);
  ModelSettings of_model;
  of_model.vote_centres["box"] = offset;
  const ObjectModel model = make_object_model("box", object, of_model);
  const Eigen::Vector3f centre = box.translation().cast<float>() + Eigen::Vector3f(0.01F, -0.01F, 0.04F);
  ObjectObservation observation{frame, model};
  observation.centre_camera = centre;
  const RotationCandidate rotation{Eigen::Quaternionf(truth.linear().cast<float>()), 1.0F};
  const std::vector<PoseCandidate> found = place_candidates(observation, {rotation}, {});
  ASSERT_FALSE(found.empty());
  EXPECT_LT((found[0].T_camera_object.translation() - truth.translation()).norm(), 0.015);
}

TEST(Candidates, OfEarlierPosesOnlyThoseOfTheClassNearInTimeAndPlaceCount) {
  const Eigen::Isometry3d truth = standing(60.0, 30.0, 0.9);
  RgbdFrame frame;
  frame.id.utime = 2000000;
  ObjectModel model;
  model.vote_centre = {0.5F, 0.0F, 0.0F};
  ObjectObservation observation{frame, model};
  observation.centre_camera = truth.cast<float>() * model.vote_centre;
  ObjectPose pose;
  pose.class_name = "box";
  pose.T_camera_object = truth;
  const auto count = [&](std::int64_t utime, const ObjectPose& earlier) {
    ObjectPoses poses;
    poses.frame.utime = utime;
    poses.poses = {earlier};
    return earlier_candidates(observation, "box", poses, {}).size();
  };
  EXPECT_EQ(count(1900000, pose), 1U);
  EXPECT_EQ(count(1400000, pose), 0U);  // too long ago
  EXPECT_EQ(count(2000000, pose), 0U);  // this frame
  EXPECT_EQ(count(2100000, pose), 0U);  // later: the log was started again
  ObjectPose other = pose;
  other.class_name = "mug";
  EXPECT_EQ(count(1900000, other), 0U);
  other = pose;
  other.T_camera_object = Eigen::Translation3d(0.2, 0.0, 0.0) * truth;
  EXPECT_EQ(count(1900000, other), 0U);
  other.T_camera_object.reset();
  EXPECT_EQ(count(1900000, other), 0U);
}

TEST(Candidates, ASurePoseIsContinuedByOneRotatedAlikeForALimitedTime) {
  const Eigen::Isometry3d truth = standing(60.0, 30.0, 0.9);
  RgbdFrame frame;
  frame.id.utime = 2000000;
  const ObjectModel model;
  ObjectObservation observation{frame, model};
  observation.centre_camera = truth.translation().cast<float>();
  const WarmStartSettings settings;
  ObjectPoses earlier;
  earlier.frame.utime = 1966667;
  ObjectPose sure;
  sure.class_id = 2;
  sure.class_name = "box";
  sure.T_camera_object = truth;
  sure.quality = sure.shape_quality = 0.95F;
  const auto continues = [&](const ObjectPose& pose, double turn_deg, int maximum) {
    earlier.poses = {pose};
    WarmStartSettings limited = settings;
    limited.max_continued = maximum;
    const Eigen::Isometry3d turned = truth * Eigen::AngleAxisd(turn_deg * kRadPerDeg, Eigen::Vector3d::UnitX());
    return find_continued(observation, turned, "box", earlier, limited) != nullptr;
  };
  EXPECT_TRUE(continues(sure, 8.0, 8));
  EXPECT_FALSE(continues(sure, 12.0, 8));
  EXPECT_FALSE(continues(sure, 180.0, 8)) << "an alternative by its shape";
  EXPECT_FALSE(continues(sure, 0.0, 0)) << "each pose is searched anew";
  ObjectPose doubtful = sure;
  doubtful.quality = 0.85F;
  EXPECT_FALSE(continues(doubtful, 0.0, 8));
  ObjectPose old = sure;
  old.continued_frames = 9;
  EXPECT_TRUE(continues(old, 0.0, 8)) << "two frames more by its class";
  old.continued_frames = 10;
  EXPECT_FALSE(continues(old, 0.0, 8));
}

}  // namespace
}  // namespace houghstream
