#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "tests/pipeline/messages/over_the_wire.hpp"

namespace houghstream {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Detections make_detections() {
  Detection mug;
  mug.class_id = 3;
  mug.class_name = "coffee_mug";
  mug.score = 0.75F;
  mug.box_px = {10.5F, 20.25F, 30.0F, 40.0F};
  mug.centre_camera = {0.1F, -0.2F, 1.5F};
  mug.vote_weight = 12.5F;
  mug.vote_count = 321;
  const Eigen::Quaternionf rotated(Eigen::AngleAxisf(0.7F, Eigen::Vector3f(1, 2, 3).normalized()));
  mug.rotations = {{rotated, 2.0F}, {Eigen::Quaternionf::Identity(), 1.0F}};
  Detections all;
  all.frame = {"OPENNI_FRAME", 77};
  all.detections = {mug};
  all.stages = {{"capture.read", 5}, {"detect.leaves", 9000}};
  return all;
}

ObjectPoses make_poses() {
  ObjectPose valid;
  valid.class_id = 3;
  valid.class_name = "coffee_mug";
  valid.detection_score = 0.75F;
  valid.detection_index = 0;
  valid.status = PoseStatus::kValid;
  valid.T_camera_object = Eigen::Translation3d(0.1, 0.2, 1.3) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY());
  valid.converged = true;
  valid.iterations = 12;
  valid.inliers = 400;
  valid.inlier_fraction = 0.8F;
  valid.residual = 0.002F;
  valid.visible_fraction = 0.9F;
  valid.free_space_violation = 0.05F;
  valid.quality = 0.93F;
  valid.shape_quality = 0.97F;
  ObjectPose refused;
  refused.class_name = "bowl";
  refused.class_id = 1;
  refused.detection_index = 1;
  refused.status = PoseStatus::kTooFewPoints;
  refused.residual = kNan;
  return {{"OPENNI_FRAME", 77}, {valid, refused}, {{"pose.icp", 3000}}};
}

TEST(ResultMessages, DetectionsComeBack) {
  const Detections sent = make_detections();
  const Detections back = detections_from_message(over_the_wire(to_message(sent)));
  EXPECT_EQ(back.frame, (FrameId{"OPENNI_FRAME", 77}));
  ASSERT_EQ(back.detections.size(), 1U);
  const Detection& mug = back.detections[0];
  EXPECT_EQ(mug.class_id, 3);
  EXPECT_EQ(mug.class_name, "coffee_mug");
  EXPECT_EQ(mug.score, 0.75F);
  EXPECT_EQ(mug.box_px, sent.detections[0].box_px);
  EXPECT_EQ(mug.centre_camera, sent.detections[0].centre_camera);
  EXPECT_EQ(mug.vote_weight, 12.5F);
  EXPECT_EQ(mug.vote_count, 321);
  ASSERT_EQ(mug.rotations.size(), 2U);
  EXPECT_EQ(mug.rotations[0].R_camera_object.coeffs(), sent.detections[0].rotations[0].R_camera_object.coeffs());
  EXPECT_EQ(mug.rotations[1].weight, 1.0F);
  ASSERT_EQ(back.stages.size(), 2U);
  EXPECT_EQ(back.stages[1].stage, "detect.leaves");
}

TEST(ResultMessages, CandidatesStayCandidates) {
  Detections found = make_detections();
  EXPECT_TRUE(detections_from_message(over_the_wire(to_message(found))).detections[0].reported);
  found.detections[0].reported = false;
  EXPECT_FALSE(detections_from_message(over_the_wire(to_message(found))).detections[0].reported);
}

TEST(ResultMessages, EmptyResultsAreResults) {
  Detections none;
  none.frame.utime = 5;
  EXPECT_EQ(detections_from_message(over_the_wire(to_message(none))).frame.utime, 5);
  ObjectPoses no_poses;
  no_poses.frame.utime = 6;
  EXPECT_EQ(poses_from_message(over_the_wire(to_message(no_poses))).frame.utime, 6);
}

TEST(ResultMessages, VotesAreCapped) {
  Detections many = make_detections();
  many.detections[0].rotations.resize(200);
  EXPECT_EQ(to_message(many).detections[0].n_votes, detection_t::MAX_VOTES);
  EXPECT_EQ(over_the_wire(to_message(many)).detections[0].vote_quat.size(), 64U);
}

TEST(ResultMessages, ACentreMayBeUnknown) {
  Detections found = make_detections();
  found.detections[0].centre_camera.setConstant(kNan);
  const Detections back = detections_from_message(over_the_wire(to_message(found)));
  EXPECT_TRUE(back.detections[0].centre_camera.array().isNaN().all());
}

TEST(ResultMessages, AbsurdDetectionsAreRefused) {
  const detections_t good = to_message(make_detections());
  const auto refused = [&](const auto& change) {
    detections_t bad = good;
    change(bad.detections[0]);
    EXPECT_THROW(detections_from_message(bad), InputError);
  };
  refused([](detection_t& d) { d.class_id = detection_t::INVALID_CLASS; });
  refused([](detection_t& d) { d.class_name.clear(); });
  refused([](detection_t& d) { d.score = kNan; });
  refused([](detection_t& d) { d.box_width = -1.0F; });
  refused([](detection_t& d) { d.box_x = std::numeric_limits<float>::infinity(); });
  refused([](detection_t& d) { d.centre_camera[2] = kNan; });
  refused([](detection_t& d) { d.centre_camera[0] = std::numeric_limits<float>::infinity(); });
  refused([](detection_t& d) { d.vote_quat[0] = {0, 0, 0, 0}; });
  refused([](detection_t& d) { d.vote_quat_weight[0] = -1.0F; });
  refused([](detection_t& d) { d.box_x = -1e30F; });
  refused([](detection_t& d) { d.box_height = 1e30F; });
  refused([](detection_t& d) { d.centre_camera[1] = 1e30F; });
  refused([](detection_t& d) {
    d.vote_quat.assign(detection_t::MAX_VOTES + 1, d.vote_quat[0]);
    d.vote_quat_weight.assign(detection_t::MAX_VOTES + 1, 1.0F);
  });
}

TEST(ResultMessages, PosesComeBack) {
  const ObjectPoses sent = make_poses();
  const object_poses_t message = over_the_wire(to_message(sent));
  EXPECT_TRUE(std::isnan(message.poses[1].quat[0])) << "a pose that is not there must not look like one";
  const ObjectPoses back = poses_from_message(message);
  ASSERT_EQ(back.poses.size(), 2U);
  ASSERT_TRUE(back.poses[0].T_camera_object.has_value());
  EXPECT_LT((back.poses[0].T_camera_object->matrix() - sent.poses[0].T_camera_object->matrix()).norm(), 1e-12);
  EXPECT_EQ(back.poses[0].inliers, 400);
  EXPECT_EQ(back.poses[0].iterations, 12);
  EXPECT_TRUE(back.poses[0].converged);
  EXPECT_EQ(back.poses[0].residual, 0.002F);
  EXPECT_EQ(back.poses[1].status, PoseStatus::kTooFewPoints);
  EXPECT_FALSE(back.poses[1].T_camera_object.has_value());
  EXPECT_EQ(back.stages.size(), 1U);
}

TEST(ResultMessages, APoseThatIsValidUpToSymmetryComesBackWithItsPose) {
  ObjectPoses sent = make_poses();
  sent.poses[0].status = PoseStatus::kValidUpToSymmetry;
  const ObjectPoses back = poses_from_message(over_the_wire(to_message(sent)));
  EXPECT_EQ(back.poses[0].status, PoseStatus::kValidUpToSymmetry);
  EXPECT_TRUE(back.poses[0].T_camera_object.has_value());
}

TEST(ResultMessages, ProbabilitiesComeBackToTheirPoses) {
  const ObjectPoses sent = make_poses();
  ObjectPoses back = poses_from_message(over_the_wire(to_message(sent)));
  EXPECT_EQ(back.poses[0].shape_quality, back.poses[0].quality) << "without them the lower bound";
  const pose_probabilities_t message = over_the_wire(probabilities_to_message(sent));
  EXPECT_TRUE(apply_probabilities(message, back));
  EXPECT_EQ(back.poses[0].shape_quality, 0.97F);
  EXPECT_EQ(back.poses[0].quality, 0.93F);
}

TEST(ResultMessages, ProbabilitiesOfOtherPosesAreNotTheirs) {
  const pose_probabilities_t message = probabilities_to_message(make_poses());
  const auto applied = [&](const auto& change) {
    ObjectPoses other = make_poses();
    change(other);
    const float before = other.poses[0].shape_quality = 0.94F;
    const bool is = apply_probabilities(message, other);
    EXPECT_EQ(other.poses[0].shape_quality, before);
    return is;
  };
  EXPECT_FALSE(applied([](ObjectPoses& poses) { poses.frame.utime += 1; }));
  EXPECT_FALSE(applied([](ObjectPoses& poses) { poses.frame.channel = "LEFT"; }));
  EXPECT_FALSE(applied([](ObjectPoses& poses) { poses.poses.pop_back(); }));
  EXPECT_FALSE(applied([](ObjectPoses& poses) { poses.poses[0].quality = 0.5F; }));
}

TEST(ResultMessages, AbsurdProbabilitiesAreRefused) {
  for (const float bad : {kNan, 1.5F, 0.2F}) {  // 0.2: below that of the pose itself
    pose_probabilities_t message = probabilities_to_message(make_poses());
    message.right_up_to_symmetry[0] = bad;
    ObjectPoses poses = make_poses();
    EXPECT_THROW(apply_probabilities(message, poses), InputError) << bad;
  }
}

CameraChroma make_camera_colours() {
  CameraChroma colours;
  colours.frame = {"LEFT", 77};
  for (const char* name : {"bowl", "soup", "tin"}) {
    ChromaPair& pair = colours.objects.emplace_back();
    pair.class_name = name;
    pair.model = {20.0 + 10.0 * static_cast<double>(colours.objects.size()), -12.5};
    pair.measured = {15.0, -2.25};
    pair.lightness = 61.5;
    pair.probability = 0.75;
  }
  return colours;
}

TEST(ResultMessages, ACamerasColoursComeBackWithTheMapThatIsLearntOfThem) {
  const CameraChroma sent = make_camera_colours();
  const camera_colours_t message = over_the_wire(to_message(sent));
  const CameraChroma back = camera_colours_from_message(message);
  EXPECT_EQ(back.frame, sent.frame);
  ASSERT_EQ(back.objects.size(), 3U);
  EXPECT_EQ(back.objects[2].class_name, "tin");
  EXPECT_EQ(back.objects[1].model, sent.objects[1].model);
  EXPECT_EQ(back.objects[1].measured, sent.objects[1].measured);
  EXPECT_EQ(back.objects[1].lightness, 61.5);
  EXPECT_EQ(back.objects[1].probability, 0.75);
  const ChromaMap map = fit_chroma_map(sent.objects);
  EXPECT_FLOAT_EQ(message.gain[1][0], static_cast<float>(map.parameters()(2)));
  EXPECT_FLOAT_EQ(message.cast[1], static_cast<float>(map.parameters()(5)));
  EXPECT_FLOAT_EQ(message.sigma, static_cast<float>(map.sigma()));
}

TEST(ResultMessages, AbsurdColoursOfACameraAreRefused) {
  const camera_colours_t good = to_message(make_camera_colours());
  const auto refused = [&](const auto& change) {
    camera_colours_t bad = good;
    change(bad);
    EXPECT_THROW(camera_colours_from_message(bad), InputError);
  };
  refused([](camera_colours_t& m) { m.model_a[0] = 131.0F; });
  refused([](camera_colours_t& m) { m.measured_b[1] = kNan; });
  refused([](camera_colours_t& m) { m.lightness[2] = -1.0F; });
  refused([](camera_colours_t& m) { m.probability[0] = 1.5F; });
  refused([](camera_colours_t& m) { m.probability[0] = kNan; });
}

TEST(ResultMessages, ACamerasTimingComesBack) {
  const CameraTiming sent{{"LEFT", 77}, -0.0125, 0.0015};
  const CameraTiming back = camera_timing_from_message(over_the_wire(to_message(sent)));
  EXPECT_EQ(back.frame, sent.frame);
  EXPECT_FLOAT_EQ(back.depth_lag_s, -0.0125F);
  EXPECT_FLOAT_EQ(back.sigma_s, 0.0015F);
}

TEST(ResultMessages, AnAbsurdTimingOfACameraIsRefused) {
  const camera_timing_t good = to_message(CameraTiming{{"LEFT", 77}, 0.01, 0.001});
  const auto refused = [&](const auto& change) {
    camera_timing_t bad = good;
    change(bad);
    EXPECT_THROW(camera_timing_from_message(bad), InputError);
  };
  refused([](camera_timing_t& m) { m.depth_lag_s = kNan; });
  refused([](camera_timing_t& m) { m.depth_lag_s = -11.0F; });
  refused([](camera_timing_t& m) { m.depth_lag_sigma_s = -0.001F; });
  refused([](camera_timing_t& m) { m.depth_lag_sigma_s = kNan; });
}

TEST(ResultMessages, AbsurdPosesAreRefused) {
  const object_poses_t good = to_message(make_poses());
  const auto refused = [&](const auto& change) {
    object_poses_t bad = good;
    change(bad.poses[0]);
    EXPECT_THROW(poses_from_message(bad), InputError);
  };
  refused([](object_pose_t& p) { p.status = 0; });
  refused([](object_pose_t& p) { p.status = object_pose_t::VALID_UP_TO_SYMMETRY + 1; });
  refused([](object_pose_t& p) { p.trans[0] = kNan; });
  refused([](object_pose_t& p) { p.quat[0] = 2.0; });
  refused([](object_pose_t& p) { p.visible_fraction = 1.5F; });
  refused([](object_pose_t& p) { p.quality = -0.1F; });
  refused([](object_pose_t& p) { p.inlier_fraction = kNan; });
}

TEST(ResultMessages, TransformsAreWrittenWxyz) {
  const Eigen::Isometry3d T_camera_object =
      Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitX());
  const rigid_transform_t message = to_message(11, T_camera_object);
  EXPECT_EQ(message.utime, 11);
  EXPECT_EQ(message.trans[2], 3.0);
  EXPECT_NEAR(message.quat[0], std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(message.quat[1], std::sqrt(0.5), 1e-12);
}

}  // namespace
}  // namespace houghstream
