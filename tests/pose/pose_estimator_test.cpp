#include "pose/pose_estimator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"
#include "tests/pose/printed_box.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

/// A rendered frame of an object that stands on a table at z = `foot` of its own frame.
struct StandingScene {
  Mesh object;
  Mesh ground = table();
  Eigen::Isometry3d truth;
  RgbdFrame frame;

  StandingScene(Mesh mesh, double foot, const Eigen::Isometry3d& pose, std::uint64_t seed)
      : object(std::move(mesh)), truth(pose) {
    frame = noisy_frame({{&object, truth, 1}, {&ground, truth * Eigen::Translation3d(0, 0, foot), 2}}, seed);
  }
};

PoseEstimator estimator_for(const std::string& name, const Mesh& mesh, PoseSettings settings = {}) {
  return PoseEstimator({{name, mesh}}, std::move(settings));
}

Detections only(const Detection& detection) {
  Detections detections;
  detections.frame.utime = 1000;
  detections.detections = {detection};
  return detections;
}

double error_of(const StandingScene& scene, const ObjectPose& pose) {
  return SurfaceError(scene.object)(scene.truth, *pose.T_camera_object);
}

TEST(PoseEstimator, KnownPosesComeBackFromVotesWithOutliers) {
  const PoseEstimator estimator({{"box", cereal_box()}, {"mug", mug()}}, PoseSettings());
  for (int i = 0; i < 6; ++i) {
    const Eigen::Isometry3d pose = standing(40.0 * i + 20.0, 25.0 + 3.0 * i, 0.7 + 0.15 * i);
    for (const bool is_box : {true, false}) {
      const StandingScene scene(is_box ? cereal_box() : mug(), is_box ? -0.13 : -0.05, pose, 10 + i);
      const Detection detection = detection_of(is_box ? "box" : "mug", scene.object, scene.truth, 100 + i);
      const ObjectPose found = estimator.estimate(scene.frame, only(detection)).poses.at(0);
      // A box without colours looks the same turned over; so does the mug turned, where its handle is hidden.
      ASSERT_TRUE(has_pose(found.status)) << to_string(found.status) << " " << i << is_box;
      EXPECT_TRUE(!is_box || found.status == PoseStatus::kValidUpToSymmetry) << i;
      ASSERT_TRUE(found.T_camera_object.has_value());
      EXPECT_LT(error_of(scene, found), 0.003) << i << is_box;
      EXPECT_GT(found.visible_fraction, 0.8F);
      EXPECT_LT(found.free_space_violation, 0.1F);
      EXPECT_GT(found.inliers, 200);
      EXPECT_GT(found.inlier_fraction, 0.8F);
      EXPECT_LT(found.residual, 0.004F);
      EXPECT_GT(found.residual, 0.0F);
      EXPECT_EQ(found.class_name, detection.class_name);
      EXPECT_EQ(found.detection_index, 0);
    }
  }
}

TEST(PoseEstimator, HalfHiddenObjectIsFoundAndItsVisibleFractionTold) {
  StandingScene scene(cereal_box(), -0.13, standing(30.0, 30.0, 1.0), 3);
  Mesh screen;  // hides the left half, 20 cm in front
  add_box(screen, {-0.3F, -0.3F, 0.75F}, {0.02F, 0.3F, 0.76F});
  scene.frame = noisy_frame({{&scene.object, scene.truth, 1},
                             {&scene.ground, scene.truth * Eigen::Translation3d(0, 0, -0.13), 2},
                             {&screen, Eigen::Isometry3d::Identity(), 3}},
                            4);
  const ObjectPose found = estimator_for("box", scene.object)
                               .estimate(scene.frame, only(detection_of("box", scene.object, scene.truth, 5)))
                               .poses.at(0);
  ASSERT_EQ(found.status, PoseStatus::kValidUpToSymmetry) << to_string(found.status);
  EXPECT_LT(error_of(scene, found), 0.006);
  EXPECT_GT(found.visible_fraction, 0.3F);
  EXPECT_LT(found.visible_fraction, 0.75F);
  EXPECT_LT(found.free_space_violation, 0.1F);
}

TEST(PoseEstimator, NothingThereAndSomethingElseAreRejectedWithoutAPose) {
  // A mug is seen, a box four times its size is claimed; and a box is claimed in the air above the table.
  const StandingScene scene(mug(), -0.05, standing(30.0, 30.0, 1.0), 3);
  const PoseEstimator estimator = estimator_for("box", cereal_box());
  for (int seed = 5; seed < 10; ++seed) {
    const Detection wrong = detection_of("box", cereal_box(), scene.truth, seed);
    Detection empty = wrong;
    empty.centre_camera.y() -= 0.2F;
    empty.box_px.y -= 105.0F;
    Detections both = only(wrong);
    both.detections.push_back(empty);
    for (const ObjectPose& pose : estimator.estimate(scene.frame, both).poses) {
      const bool has_reason = pose.status == PoseStatus::kRejectedByDepth || pose.status == PoseStatus::kRefuted ||
                              pose.status == PoseStatus::kRejectedByOutline || pose.status == PoseStatus::kNotConverged;
      EXPECT_TRUE(has_reason) << seed << " " << pose.detection_index << " " << to_string(pose.status);
      EXPECT_FALSE(pose.T_camera_object.has_value());
      EXPECT_EQ(std::isnan(pose.residual), pose.inliers == 0);
    }
  }
}

ObjectPoses earlier_pose(const std::string& name, const Eigen::Isometry3d& T_camera_object, std::int64_t utime) {
  ObjectPose pose;
  pose.class_name = name;
  pose.status = PoseStatus::kValid;
  pose.T_camera_object = T_camera_object;
  ObjectPoses poses;
  poses.frame.utime = utime;
  poses.poses = {pose};
  return poses;
}

TEST(PoseEstimator, AWrongEarlierPoseDoesNotStick) {
  const StandingScene scene(cereal_box(), -0.13, standing(30.0, 30.0, 1.0), 3);
  const Detections seen = only(detection_of("box", scene.object, scene.truth, 5));
  const Eigen::Isometry3d wrong = scene.truth * Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitX());
  const ObjectPose found =
      estimator_for("box", cereal_box()).estimate(scene.frame, seen, earlier_pose("box", wrong, 500)).poses.at(0);
  ASSERT_EQ(found.status, PoseStatus::kValidUpToSymmetry);
  EXPECT_LT(error_of(scene, found), 0.003);
}

TEST(PoseEstimator, AnEarlierPoseHelpsWhereNoVoteRemembersTheRotation) {
  const StandingScene scene(cereal_box(), -0.13, standing(30.0, 30.0, 1.0), 3);
  Detections seen = only(detection_of("box", scene.object, scene.truth, 5));
  seen.detections[0].rotations.clear();
  const PoseEstimator estimator = estimator_for("box", cereal_box());
  EXPECT_EQ(estimator.estimate(scene.frame, seen).poses.at(0).status, PoseStatus::kNoInitialPose);
  const Eigen::Isometry3d moved = Eigen::Translation3d(0.01, 0.005, -0.01) * scene.truth;
  const ObjectPose found = estimator.estimate(scene.frame, seen, earlier_pose("box", moved, 500)).poses.at(0);
  ASSERT_EQ(found.status, PoseStatus::kValidUpToSymmetry);
  EXPECT_LT(error_of(scene, found), 0.003);
}

TEST(PoseEstimator, TwoDetectionsOfOneObjectHaveOnePose) {
  const StandingScene scene(mug(), -0.05, standing(30.0, 30.0, 0.8), 3);
  Detections two = only(detection_of("mug", scene.object, scene.truth, 5));
  two.detections.push_back(detection_of("mug", scene.object, scene.truth, 6));
  two.detections[1].score *= 0.9F;
  const ObjectPoses found = estimator_for("mug", mug()).estimate(scene.frame, two);
  ASSERT_EQ(found.poses.size(), 2U);
  EXPECT_NE(found.poses[0].T_camera_object.has_value(), found.poses[1].T_camera_object.has_value());
  const ObjectPose& withheld = found.poses[found.poses[0].T_camera_object ? 1 : 0];
  EXPECT_EQ(withheld.status, PoseStatus::kLowScore);
  PoseSettings settings;
  settings.duplicate_distance_ratio = 0.0;
  const ObjectPoses both = estimator_for("mug", mug(), settings).estimate(scene.frame, two);
  EXPECT_TRUE(both.poses[0].T_camera_object.has_value() && both.poses[1].T_camera_object.has_value());
}

TEST(PoseEstimator, OneSurfaceIsOfOneClass) {
  const StandingScene scene(cereal_box(), -0.13, standing(10.0, 20.0, 0.8), 3);
  Mesh deeper;  // the same front, which hides what lies behind it
  add_box(deeper, {-0.09F, -0.03F, -0.13F}, {0.09F, 0.05F, 0.13F});
  const PoseEstimator estimator({{"box", cereal_box()}, {"deeper", deeper}}, PoseSettings());
  Detections two = only(detection_of("box", scene.object, scene.truth, 5));
  two.detections.push_back(detection_of("deeper", deeper, scene.truth, 6));
  const ObjectPoses found = estimator.estimate(scene.frame, two);
  ASSERT_TRUE(found.poses.at(0).T_camera_object.has_value()) << to_string(found.poses[0].status);
  EXPECT_LT(error_of(scene, found.poses[0]), 0.003);
  EXPECT_EQ(found.poses.at(1).status, PoseStatus::kRefuted) << "its surface is the box's";
  EXPECT_FALSE(found.poses[1].T_camera_object.has_value());
  PoseSettings settings;
  settings.max_shared_surface = 1.0F;
  const PoseEstimator trusting({{"box", cereal_box()}, {"deeper", deeper}}, settings);
  EXPECT_TRUE(trusting.estimate(scene.frame, two).poses.at(1).T_camera_object.has_value()) << "fits as well";
}

TEST(PoseEstimator, WhatIsHardlyAnObjectIsNotLookedAt) {
  const StandingScene scene(mug(), -0.05, standing(30.0, 30.0, 1.0), 3);
  PoseSettings settings;
  Detection weak = detection_of("mug", scene.object, scene.truth, 5);
  weak.score = 0.99F * settings.min_score;
  EXPECT_EQ(estimator_for("mug", mug()).estimate(scene.frame, only(weak)).poses.at(0).status, PoseStatus::kLowScore);
  settings.min_score = 0.0F;
  set_min_quality(0.0F, settings);
  const ObjectPose found = estimator_for("mug", mug(), settings).estimate(scene.frame, only(weak)).poses.at(0);
  EXPECT_EQ(found.status, PoseStatus::kValid);
}

TEST(PoseEstimator, ACandidateWhoseRegistrationExplainsLittleIsGivenUp) {
  const StandingScene scene(mug(), -0.05, standing(30.0, 30.0, 1.0), 3);
  Detection wrong = detection_of("box", cereal_box(), scene.truth, 5);  // a box four times the size of what is there
  wrong.score = 0.15F;
  wrong.reported = false;
  PoseSettings settings;
  const auto status = [&] {
    return estimator_for("box", cereal_box(), settings).estimate(scene.frame, only(wrong)).poses.at(0).status;
  };
  EXPECT_EQ(status(), PoseStatus::kLowScore);
  settings.min_publication_probability = 0.0F;
  EXPECT_NE(status(), PoseStatus::kLowScore) << "is judged by what was measured";
  settings = PoseSettings();
  wrong.reported = true;
  EXPECT_NE(status(), PoseStatus::kLowScore) << "who published it wants to know why it is not there";
}

TEST(PoseEstimator, ACandidateOnTheSurfaceOfAPublishedObjectIsGivenUp) {
  const StandingScene scene(cereal_box(), -0.13, standing(10.0, 20.0, 0.8), 3);
  Mesh deeper;  // the same front, which hides what lies behind it
  add_box(deeper, {-0.09F, -0.03F, -0.13F}, {0.09F, 0.05F, 0.13F});
  PoseSettings settings;
  settings.max_shared_surface = 1.0F;
  Detections two = only(detection_of("deeper", deeper, scene.truth, 6));
  two.detections.push_back(detection_of("box", scene.object, scene.truth, 5));
  two.detections[0].reported = false;
  ObjectPoses known;
  const auto found = [&] {
    const PoseEstimator estimator({{"box", cereal_box()}, {"deeper", deeper}}, settings);
    return estimator.estimate(scene.frame, two, {}, {}, known).poses;
  };
  const std::vector<ObjectPose> both = found();
  EXPECT_TRUE(both.at(1).T_camera_object.has_value()) << to_string(both[1].status);
  EXPECT_EQ(both.at(0).status, PoseStatus::kRefuted) << "the box explains it, though it comes later in the list";
  settings.max_explained_surface = 1.0F;
  EXPECT_NE(found().at(0).status, PoseStatus::kRefuted) << "is judged by what was measured";
  settings.max_explained_surface = PoseSettings().max_explained_surface;
  two.detections.pop_back();
  EXPECT_NE(found().at(0).status, PoseStatus::kRefuted) << "nothing explains it";
  known.poses = {both[1]};
  EXPECT_EQ(found().at(0).status, PoseStatus::kRefuted) << "what is known otherwise explains it too";
  two.detections[0].reported = true;
  EXPECT_NE(found().at(0).status, PoseStatus::kRefuted) << "who published it wants to know why it is not there";
}

TEST(PoseEstimator, AClassThatHasAQualityOfItsOwnIsJudgedByThat) {
  const StandingScene scene(mug(), -0.05, standing(30.0, 30.0, 1.0), 3);
  const Detections seen = only(detection_of("mug", scene.object, scene.truth, 5));
  const auto found = [&](const std::string& learnt_for, const QualitySettings& learnt) {
    PoseSettings settings;
    settings.class_quality[learnt_for] = learnt;
    return estimator_for("mug", mug(), settings).estimate(scene.frame, seen).poses.at(0);
  };
  const ObjectPose by_default = estimator_for("mug", mug()).estimate(scene.frame, seen).poses.at(0);
  ASSERT_EQ(by_default.status, PoseStatus::kValid);
  QualitySettings doubtful;
  doubtful.bias -= 50.0;
  doubtful.weights = {};
  doubtful.weights.detection_logit = 1.0;
  doubtful.mean_of_correct.detection_logit = 5.0;
  doubtful.presence.bias = 100.0;
  const ObjectPose withheld = found("mug", doubtful);
  EXPECT_LT(withheld.quality, 0.01F);
  EXPECT_EQ(withheld.status, PoseStatus::kLowScore) << "by its own weights and typical values";
  EXPECT_FALSE(withheld.T_camera_object.has_value());
  doubtful.min_quality = 0.0F;
  EXPECT_EQ(found("mug", doubtful).status, PoseStatus::kValid) << "by its own least quality";
  EXPECT_EQ(found("box", doubtful).quality, by_default.quality) << "another class's";
}

TEST(PoseEstimator, AReportedDetectionIsRefutedWhereItsObjectIsLessProbablyThereThanReported) {
  const StandingScene scene(mug(), -0.05, standing(30.0, 30.0, 1.0), 3);
  Detection detection = detection_of("mug", scene.object, scene.truth, 5);
  PoseSettings settings;
  QualitySettings& learnt = settings.class_quality["mug"] = QualitySettings{};
  learnt.presence = {0.6, 0.0, 0.0};  // a probability of 0.646
  const auto found = [&] {
    return estimator_for("mug", mug(), settings).estimate(scene.frame, only(detection)).poses.at(0).status;
  };
  EXPECT_EQ(found(), PoseStatus::kValid) << "what is published refutes nothing";
  set_min_quality(1.0F, settings);
  EXPECT_EQ(found(), PoseStatus::kRefuted);
  learnt.presence.bias = 0.64;  // 0.655
  const PoseStatus withheld = found();
  EXPECT_TRUE(withheld != PoseStatus::kValid && withheld != PoseStatus::kRefuted) << to_string(withheld);
  learnt.presence.bias = 0.6;
  detection.reported = false;
  EXPECT_NE(found(), PoseStatus::kRefuted) << "a candidate is not reported by its score";
}

/// Estimates the box's pose from votes for the box upside down.
ObjectPose found_from_turned_votes(const Mesh& taught, const Eigen::Isometry3d& truth, const RgbdFrame& frame) {
  Detection detection = detection_of("box", taught, truth, 5);
  for (RotationVote& vote : detection.rotations)
    vote.R_camera_object = vote.R_camera_object * Eigen::AngleAxisf(static_cast<float>(M_PI), Eigen::Vector3f::UnitZ());
  PoseSettings settings;
  settings.rotation_search.alternatives = 0;
  set_min_quality(0.3F, settings);
  return estimator_for("box", taught, settings).estimate(frame, only(detection)).poses.at(0);
}

TEST(PoseEstimator, TheTextureTellsABoxFromItselfTurnedOver) {
  const Eigen::Isometry3d truth = standing(30.0, 30.0, 0.8);
  const ObjectPose found = found_from_turned_votes(printed_box(), truth, coloured_frame(printed_box(), truth, 1));
  ASSERT_EQ(found.status, PoseStatus::kValid) << to_string(found.status);
  EXPECT_LT(Eigen::AngleAxisd(truth.linear().transpose() * found.T_camera_object->linear()).angle(), 0.1);
  EXPECT_GT(found.quality, 0.8F * found.shape_quality);
}

TEST(PoseEstimator, ASurePoseIsContinuedWithItsVerdictAndSearchedAnewAfterAWhile) {
  const Eigen::Isometry3d truth = standing(30.0, 30.0, 0.8);
  PoseSettings settings;
  settings.warm_start.max_continued = 3;
  const PoseEstimator estimator = estimator_for("box", printed_box(), settings);
  ObjectPoses earlier;
  std::vector<int> continued;
  for (int i = 0; i < 6; ++i) {
    RgbdFrame frame = coloured_frame(printed_box(), truth, 1 + i);
    frame.id.utime = 1000 + 33333 * i;
    Detections seen = only(detection_of("box", printed_box(), truth, 5 + i));
    seen.frame = frame.id;
    seen.detections[0].class_id = 4;
    const ObjectPoses poses = estimator.estimate(frame, seen, earlier);
    const ObjectPose& pose = poses.poses.at(0);
    ASSERT_EQ(pose.status, PoseStatus::kValid) << i << to_string(pose.status);
    ASSERT_GE(pose.quality, 0.9F) << i;
    EXPECT_LT((pose.T_camera_object->translation() - truth.translation()).norm(), 0.003) << i;
    EXPECT_LT(Eigen::AngleAxisd(truth.linear().transpose() * pose.T_camera_object->linear()).angle(), 0.05) << i;
    if (pose.continued_frames > 0) {
      const ObjectPose& before = earlier.poses.at(0);
      EXPECT_NEAR(pose.quality / pose.shape_quality, before.quality / before.shape_quality, 1e-5F) << i;
    }
    continued.push_back(pose.continued_frames);
    earlier = poses;
  }
  EXPECT_EQ(continued, (std::vector<int>{0, 1, 2, 3, 0, 1}));
}

TEST(PoseEstimator, AWeakDetectionIsRejectedAgainForAWhileWhereItStays) {
  const StandingScene scene(mug(), -0.05, standing(30.0, 30.0, 1.0), 3);
  Detection wrong = detection_of("box", cereal_box(), scene.truth, 5);
  wrong.reported = false;
  wrong.class_id = 4;
  PoseSettings settings;
  settings.warm_start.max_rejected_s = 0.07;
  const PoseEstimator estimator = estimator_for("box", cereal_box(), settings);
  RgbdFrame frame = scene.frame;
  ObjectPoses earlier;
  const auto searched_us_before = [&](const Detection& detection) {
    frame.id.utime += 33333;
    Detections seen = only(detection);
    seen.frame = frame.id;
    earlier = estimator.estimate(frame, seen, earlier);
    const ObjectPose& pose = earlier.poses.at(0);
    EXPECT_FALSE(pose.T_camera_object.has_value());
    EXPECT_NE(pose.status, PoseStatus::kInvalid);
    return pose.rejected_search ? frame.id.utime - pose.rejected_search->utime : -1;
  };
  std::vector<std::int64_t> before;
  for (int i = 0; i < 5; ++i) before.push_back(searched_us_before(wrong));
  EXPECT_EQ(before, (std::vector<std::int64_t>{0, 33333, 66666, 0, 33333}));
  Detection elsewhere = wrong;
  elsewhere.centre_camera.x() += 0.1F;
  EXPECT_EQ(searched_us_before(elsewhere), 0) << "another object may be there";
  EXPECT_EQ(searched_us_before(elsewhere), 33333);
  elsewhere.reported = true;
  EXPECT_EQ(searched_us_before(elsewhere), -1) << "who published it wants to know why it is not there";
}

TEST(PoseEstimator, ADoubtfulRejectionIsNotRepeated) {
  Detection weak;
  weak.class_name = "box";
  weak.centre_camera = {0.0F, 0.0F, 1.0F};
  weak.reported = false;
  ObjectPoses earlier;
  earlier.frame.utime = 1000;
  earlier.poses.resize(1);
  earlier.poses[0].class_name = "box";
  earlier.poses[0].rejected_search = RejectedSearch{weak.centre_camera, 1000};
  const WarmStartSettings settings;
  earlier.poses[0].quality = 0.05F;
  EXPECT_NE(find_rejected(weak, 34333, earlier, settings), nullptr);
  earlier.poses[0].quality = 0.4F;
  EXPECT_EQ(find_rejected(weak, 34333, earlier, settings), nullptr);
}

TEST(PoseEstimator, WhatHasNoTextureIsValidUpToTheSymmetryOfItsShape) {
  const Eigen::Isometry3d truth = standing(30.0, 30.0, 0.8);
  const ObjectPose found = found_from_turned_votes(cereal_box(), truth, coloured_frame(printed_box(), truth, 1));
  EXPECT_EQ(found.status, PoseStatus::kValidUpToSymmetry) << to_string(found.status);
  EXPECT_TRUE(found.T_camera_object.has_value());
  EXPECT_NEAR(found.quality, found.shape_quality / 4.0F, 0.01F) << "one of four";
}

TEST(PublishFrom, IsTheLimitOfEachClassAndOfCandidates) {
  PoseSettings settings;
  settings.class_quality["mug"].bias = -1.0;
  set_min_quality(0.3F, settings);
  for (const QualitySettings& judged_by : {settings.quality, settings.class_quality["mug"]}) {
    EXPECT_EQ(judged_by.min_quality, 0.3F);
    EXPECT_EQ(judged_by.min_candidate_quality, 0.3F);
  }
  EXPECT_EQ(settings.class_quality["mug"].bias, -1.0);
}

TEST(PoseEstimator, ACandidateHasALimitOfItsOwn) {
  const StandingScene scene(mug(), -0.05, standing(30.0, 30.0, 1.0), 3);
  Detection detection = detection_of("mug", scene.object, scene.truth, 5);
  PoseSettings settings;
  settings.quality.min_candidate_quality = 1.0F;
  const PoseEstimator estimator = estimator_for("mug", mug(), settings);
  EXPECT_EQ(estimator.estimate(scene.frame, only(detection)).poses.at(0).status, PoseStatus::kValid);
  detection.reported = false;
  const ObjectPose withheld = estimator.estimate(scene.frame, only(detection)).poses.at(0);
  EXPECT_NE(withheld.status, PoseStatus::kValid);
  EXPECT_GT(withheld.quality, settings.quality.min_quality);
}

TEST(PoseEstimator, MissingInputGivesAReasonAndNoPose) {
  const StandingScene scene(mug(), -0.05, standing(30.0, 30.0, 1.0), 3);
  const PoseEstimator estimator = estimator_for("mug", mug());
  const Detection good = detection_of("mug", scene.object, scene.truth, 5);
  std::vector<Detection> bad(6, good);
  bad[0].class_name = "kettle";
  bad[1].rotations.clear();
  bad[2].rotations = {{Eigen::Quaternionf(std::nanf(""), 0, 0, 0), 1.0F}, {good.rotations[0].R_camera_object, 0.0F}};
  bad[3].box_px = cv::Rect2f(-500.0F, -500.0F, 20.0F, 20.0F);
  bad[4].centre_camera.z() = std::nanf("");
  bad[5].centre_camera.z() = 3.5F;  // nothing there at that depth
  const std::vector<PoseStatus> reasons{PoseStatus::kNoModel,       PoseStatus::kNoInitialPose,
                                        PoseStatus::kNoInitialPose, PoseStatus::kTooFewPoints,
                                        PoseStatus::kNoInitialPose, PoseStatus::kTooFewPoints};
  Detections detections = only(good);
  detections.detections = bad;
  const ObjectPoses poses = estimator.estimate(scene.frame, detections);
  ASSERT_EQ(poses.poses.size(), bad.size());
  for (std::size_t i = 0; i < bad.size(); ++i) {
    EXPECT_EQ(poses.poses[i].status, reasons[i]) << i << " " << to_string(poses.poses[i].status);
    EXPECT_FALSE(poses.poses[i].T_camera_object.has_value());
    EXPECT_TRUE(std::isnan(poses.poses[i].residual));
  }
  RgbdFrame blind = scene.frame;
  blind.depth.setTo(std::nanf(""));
  EXPECT_EQ(estimator.estimate(blind, only(good)).poses.at(0).status, PoseStatus::kTooFewPoints);
  EXPECT_TRUE(estimator.estimate(scene.frame, Detections{{"", 1000}, {}, {}}).poses.empty());
}

TEST(PoseEstimator, DetectionsOfAnotherFrameAndBrokenFramesAreRefused) {
  StandingScene scene(mug(), -0.05, standing(30.0, 30.0, 1.0), 3);
  const PoseEstimator estimator = estimator_for("mug", mug());
  Detections detections = only(detection_of("mug", scene.object, scene.truth, 5));
  detections.frame.utime = 1001;
  EXPECT_THROW(estimator.estimate(scene.frame, detections), std::logic_error);
  detections.frame.utime = 1000;
  scene.frame.depth = scene.frame.depth.colRange(0, 320);
  EXPECT_THROW(estimator.estimate(scene.frame, detections), InputError);
  EXPECT_THROW(PoseEstimator({{"nothing", Mesh()}}, PoseSettings()), InputError);
}

TEST(PoseEstimator, SameResultForAnyNumberOfThreads) {
  const StandingScene scene(mug(), -0.05, standing(30.0, 30.0, 1.0), 3);
  Detections detections = only(detection_of("mug", scene.object, scene.truth, 5));
  for (int i = 6; i < 11; ++i) detections.detections.push_back(detection_of("mug", scene.object, scene.truth, i));
  detections.stages = {{"detect.leaves", 7}};
  PoseSettings settings;
  const ObjectPoses serial = estimator_for("mug", mug(), settings).estimate(scene.frame, detections);
  settings.threads = 3;
  const ObjectPoses parallel = estimator_for("mug", mug(), settings).estimate(scene.frame, detections);
  ASSERT_EQ(serial.poses.size(), 6U);
  for (std::size_t i = 0; i < serial.poses.size(); ++i) {
    EXPECT_EQ(serial.poses[i].T_camera_object.has_value(), parallel.poses[i].T_camera_object.has_value());
    EXPECT_EQ(serial.poses[i].quality, parallel.poses[i].quality);
    if (serial.poses[i].T_camera_object && parallel.poses[i].T_camera_object) {
      EXPECT_EQ(serial.poses[i].T_camera_object->matrix(), parallel.poses[i].T_camera_object->matrix());
    }
    EXPECT_EQ(serial.poses[i].inliers, parallel.poses[i].inliers);
    EXPECT_EQ(parallel.poses[i].detection_index, static_cast<int>(i));
  }
  for (const ObjectPoses& poses : {serial, parallel}) {
    std::vector<std::string> names;
    for (const StageTime& time : poses.stages) names.push_back(time.stage);
    EXPECT_EQ(names, (std::vector<std::string>{"detect.leaves", "pose.region", "pose.candidates", "pose.registration",
                                               "pose.choice", "pose.verification", "pose.print"}));
  }
}

TEST(PoseEstimator, MayBeAskedFromSeveralThreadsAtOnce) {
  const StandingScene scene(mug(), -0.05, standing(30.0, 30.0, 1.0), 3);
  const Detections seen = only(detection_of("mug", scene.object, scene.truth, 5));
  const PoseEstimator estimator = estimator_for("mug", mug());
  const ObjectPose alone = estimator.estimate(scene.frame, seen).poses.at(0);
  std::vector<ObjectPoses> together(4);
  parallel_for(4, 4, [&](int i) { together[i] = estimator.estimate(scene.frame, seen); });
  ASSERT_TRUE(alone.T_camera_object);
  for (const ObjectPoses& poses : together) {
    EXPECT_EQ(poses.poses.at(0).T_camera_object.value().matrix(), alone.T_camera_object->matrix());
    EXPECT_EQ(poses.poses.at(0).quality, alone.quality);
  }
}

}  // namespace
}  // namespace houghstream
