#include "tools/evaluate/metrics/average_recall.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/datasets/bop_writer.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

BopErrors errors(double mssd, double mspd, double vsd) {
  BopErrors out{mssd, mspd, {}};
  out.vsd.fill(vsd);
  return out;
}

const BopErrors kWrong = errors(9.0, 900.0, 1.0);

TEST(AverageRecall, IsTheShareOfThresholdsThatAreKept) {
  // MSSD 0.12 is below 0.15 to 0.5: 8 of 10. MSPD 22 below 25 to 50: 6. VSD 0.43 below 0.45 and 0.5: 2.
  const AverageRecall recall = average_recall({{1, {{errors(0.12, 22.0, 0.43)}}}});
  EXPECT_EQ(recall.targets, 1);
  EXPECT_NEAR(recall.mssd, 0.8, 1e-12);
  EXPECT_NEAR(recall.mspd, 0.6, 1e-12);
  EXPECT_NEAR(recall.vsd, 0.2, 1e-12);
  EXPECT_NEAR(recall.mean, 1.6 / 3.0, 1e-12);
}

TEST(AverageRecall, VsdIsAveragedOverItsTausToo) {
  BopErrors row = errors(0.0, 0.0, 1.0);
  row.vsd[9] = 0.0;  // right at the widest tau only, but at every threshold
  EXPECT_NEAR(average_recall({{1, {{row}}}}).vsd, 0.1, 1e-12);
}

TEST(AverageRecall, WhatWasMissedCountsAsWrong) {
  EXPECT_NEAR(average_recall({{1, {{errors(0, 0, 0)}}}, {3, {}}}).mean, 0.25, 1e-12);
  EXPECT_TRUE(std::isnan(average_recall({}).mean));
}

TEST(AverageRecall, ATargetIsTakenOnceByTheStrongest) {
  // Both poses lie at the first target: one target of two is right.
  EXPECT_NEAR(average_recall({{2, {{errors(0, 0, 0), kWrong}, {errors(0, 0, 0), kWrong}}}}).mean, 0.5, 1e-12);
  // The strongest takes the nearer of two within reach and leaves the other to the next.
  EXPECT_NEAR(average_recall({{2, {{errors(0.02, 2, 0.02), errors(0.01, 1, 0.01)}, {errors(0, 0, 0), kWrong}}}}).mean,
              1.0, 1e-12);
}

TEST(AverageRecall, OverAllClassesEveryTargetCountsOnce) {
  const LocalisationScores scores = localisation_scores({{"mug", {{1, {{errors(0, 0, 0)}}}}}, {"can", {{3, {}}}}});
  EXPECT_EQ(scores.by_class.at("mug").mean, 1.0);
  EXPECT_EQ(scores.by_class.at("can").mean, 0.0);
  EXPECT_EQ(scores.all.targets, 4);
  EXPECT_NEAR(scores.all.mean, 0.25, 1e-12);
}

TEST(BopModels, HaveTheSymmetriesOfTheirInfo) {
  BopModels info;
  info.names = {{1, "bowl"}, {2, "mug"}};
  info.diameters = {{1, 0.2}, {2, 0.1}};
  info.symmetries[1].continuous = {ContinuousSymmetry{}};
  info.symmetries[2] = {};
  const auto models = make_bop_models({{"bowl", Mesh()}, {"mug", Mesh()}}, info);
  EXPECT_EQ(models.at("bowl").symmetries.size(), 315U);
  EXPECT_EQ(models.at("mug").symmetries.size(), 1U);
  EXPECT_EQ(models.at("mug").diameter, 0.1);
}

const Camera kCamera = {64, 48, 60.0, 60.0, 31.5, 23.5};

Eigen::Isometry3d at(double x) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, 0.0, 1.0));
}

NamedObject mug_at(double x, double visible) {
  NamedObject out;
  out.class_name = "mug";
  out.truth.object_id = 1;
  out.truth.T_camera_object = at(x);
  out.truth.visible_fraction = visible;
  return out;
}

ObjectPose pose_at(double x, float score) {
  ObjectPose out;
  out.class_name = "mug";
  out.detection_score = score;
  out.T_camera_object = at(x);
  return out;
}

/// Holds a square plate in front of the camera, and a scene of one image with its measured depth.
struct MeasuredScene {
  std::map<std::string, BopModel> models;
  BopScene scene;
};

MeasuredScene measured_scene() {
  Mesh mesh;
  mesh.vertices = {{-0.05F, -0.05F, 0}, {0.05F, -0.05F, 0}, {0.05F, 0.05F, 0}, {-0.05F, 0.05F, 0}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  const auto folder = fresh_folder("average_recall");
  RgbdFrame frame = plain_frame(kCamera.width, kCamera.height);
  frame.camera = kCamera;
  BopWriter writer(folder);
  writer.add(frame, {}, {});
  writer.finish();
  return {{{"mug", {mesh, 0.1 * std::sqrt(2.0), {Eigen::Isometry3d::Identity()}}}}, BopScene(folder)};
}

TEST(MeasurePoses, OnlyAsManyPosesAsTargetsAreTried) {
  const MeasuredScene measured = measured_scene();
  EvaluatedFrame frame;
  frame.objects = {mug_at(0.0, 1.0)};
  frame.poses = ObjectPoses{{}, {pose_at(0.0, 0.4F), pose_at(0.2, 0.9F)}, {}};
  const ClassErrors errors = measure_poses({frame}, measured.scene, measured.models, 1);
  ASSERT_EQ(errors.at("mug").size(), 1U);
  ASSERT_EQ(errors.at("mug")[0].errors.size(), 1U);
  EXPECT_NEAR(errors.at("mug")[0].errors[0][0].mssd, std::sqrt(2.0), 1e-6) << "the stronger one is the wrong one";
  EXPECT_EQ(average_recall(errors.at("mug")).mean, 0.0);
}

TEST(MeasurePoses, HardlyVisibleObjectsAndThoseWithoutTruePoseAreNoTargets) {
  const MeasuredScene measured = measured_scene();
  EvaluatedFrame frame;
  frame.objects = {mug_at(0.0, 0.09), mug_at(0.1, 0.1), mug_at(0.2, 1.0)};
  frame.objects[2].truth.has_pose = false;
  frame.poses = ObjectPoses{{}, {pose_at(0.1, 0.4F)}, {}};
  const ClassErrors errors = measure_poses({frame}, measured.scene, measured.models, 2);
  EXPECT_EQ(errors.at("mug")[0].targets, 1);
  EXPECT_EQ(average_recall(errors.at("mug")).mean, 1.0);
}

TEST(MeasurePoses, WhereAListSaysWhatIsATargetItCounts) {
  const MeasuredScene measured = measured_scene();
  EvaluatedFrame frame;
  frame.objects = {mug_at(0.0, 0.05), mug_at(0.1, 1.0)};
  frame.objects[0].is_target = true;
  frame.objects[1].is_target = false;
  frame.poses = ObjectPoses{{}, {pose_at(0.0, 0.4F)}, {}};
  const ClassErrors errors = measure_poses({frame}, measured.scene, measured.models, 1);
  EXPECT_EQ(errors.at("mug")[0].targets, 1);
  EXPECT_EQ(average_recall(errors.at("mug")).mean, 1.0);
}

TEST(MeasurePoses, FramesWithoutPosesHaveTargets) {
  const MeasuredScene measured = measured_scene();
  EvaluatedFrame skipped;
  skipped.objects = {mug_at(0.0, 1.0)};
  EvaluatedFrame refused = skipped;
  refused.poses = ObjectPoses{{}, {ObjectPose{}}, {}};
  const ClassErrors errors = measure_poses({skipped, refused}, measured.scene, measured.models, 1);
  const AverageRecall recall = average_recall(errors.at("mug"));
  EXPECT_EQ(recall.targets, 2);
  EXPECT_EQ(recall.mean, 0.0);
  EXPECT_TRUE(measure_poses({skipped}, measured.scene, {}, 1).empty()) << "no model";
}

}  // namespace
}  // namespace houghstream
