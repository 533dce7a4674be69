#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/base/checks.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "tests/pipeline/messages/over_the_wire.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

WorldObjects one_mug() {
  TrackedObject mug;
  mug.track_id = 3;
  mug.class_id = 2;
  mug.class_name = "mug";
  mug.state = TrackState::kHidden;
  mug.probability = 0.75F;
  mug.moving = true;
  mug.T_world_object = Eigen::Translation3d(0.1, -0.2, 0.7) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY());
  mug.covariance(0, 5) = 0.25;
  mug.velocity << 1, 2, 3, 4, 5, 6;
  mug.seen = 12;
  mug.first_utime = 70;
  mug.last_seen = {"LEFT", 76};
  mug.reason = "occluded by a nearer surface in LEFT";
  WorldObjects world;
  world.frame = {"RIGHT", 77};
  world.world = "WORLD";
  world.world_number = 2;
  world.T_world_camera = Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3));
  world.objects = {mug};
  world.stages = {{"track.update", 15}};
  return world;
}

TEST(ObjectMessages, AWorldComesBackAsItWas) {
  const WorldObjects world = one_mug();
  const WorldObjects back = world_from_message(over_the_wire(to_message(world)));
  EXPECT_EQ(back.frame, world.frame);
  EXPECT_EQ(back.world, "WORLD");
  EXPECT_EQ(back.world_number, 2);
  EXPECT_TRUE(back.T_world_camera.isApprox(world.T_world_camera));
  ASSERT_EQ(back.stages.size(), 1U);
  EXPECT_EQ(back.stages[0].stage, "track.update");
  ASSERT_EQ(back.objects.size(), 1U);
  const TrackedObject& mug = back.objects[0];
  EXPECT_EQ(mug.track_id, 3);
  EXPECT_EQ(mug.class_name, "mug");
  EXPECT_EQ(mug.state, TrackState::kHidden);
  EXPECT_EQ(mug.probability, 0.75F);
  EXPECT_TRUE(mug.moving);
  EXPECT_TRUE(mug.T_world_object.isApprox(world.objects[0].T_world_object, 1e-12));
  EXPECT_EQ(mug.covariance, world.objects[0].covariance);
  EXPECT_EQ(mug.velocity, world.objects[0].velocity);
  EXPECT_EQ(mug.seen, 12);
  EXPECT_EQ(mug.first_utime, 70);
  EXPECT_EQ(mug.last_seen, (FrameId{"LEFT", 76}));
  EXPECT_EQ(mug.reason, "occluded by a nearer surface in LEFT");
}

TEST(ObjectMessages, TheFrameIsReadWithoutDecoding) {
  const std::vector<std::uint8_t> bytes = encode_message(to_message(one_mug()));
  EXPECT_EQ(read_result_frame({bytes.data(), bytes.size()}, "test"), (FrameId{"RIGHT", 77}));
}

TEST(ObjectMessages, WhatCannotBeSoIsRefusedInOneLine) {
  const auto refusal = [](const std::function<void(objects_t&)>& spoil) -> std::string {
    objects_t message = to_message(one_mug());
    spoil(message);
    return error_of([&] { world_from_message(message); });
  };
  EXPECT_EQ(refusal([](objects_t& m) { m.objects[0].state = 6; }),
            "objects after frame RIGHT 77: object 3 'mug': state 6, expected 1 to 5");
  EXPECT_NE(refusal([](objects_t& m) { m.objects[0].track_id = 0; }).find("expected a number above 0"),
            std::string::npos);
  EXPECT_NE(refusal([](objects_t& m) { m.objects[0].quat[0] = 2.0; }).find("expected 1"), std::string::npos);
  EXPECT_NE(refusal([](objects_t& m) { m.objects[0].probability = 1.5F; }).find("probability 1.5"), std::string::npos);
  EXPECT_NE(refusal([](objects_t& m) { m.objects[0].covariance[2][2] = std::nan(""); }).find("not finite"),
            std::string::npos);
  EXPECT_NE(refusal([](objects_t& m) { m.objects[0].trans[0] = -2e9; }).find("expected metres within 1000000000"),
            std::string::npos);
  EXPECT_NE(refusal([](objects_t& m) { m.camera_trans[1] = std::nan(""); }).find("camera at"), std::string::npos);
}

TEST(ObjectMessages, ACutMessageIsRefused) {
  const std::vector<std::uint8_t> bytes = encode_message(to_message(one_mug()));
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    EXPECT_THROW(decode_message<objects_t>({bytes.data(), size}), InputError) << size;
  }
}

TEST(ObjectMessages, ATransformThatIsNotRigidIsRefused) {
  rigid_transform_t message = to_message(1, Eigen::Isometry3d::Identity());
  EXPECT_TRUE(transform_from_message(message).isApprox(Eigen::Isometry3d::Identity()));
  message.quat[0] = 0.5;
  EXPECT_THROW(transform_from_message(message), InputError);
  message.quat[0] = 1.0;
  message.trans[2] = std::nan("");
  EXPECT_THROW(transform_from_message(message), InputError);
}

}  // namespace
}  // namespace houghstream
