#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "tests/pipeline/messages/over_the_wire.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

Teaching mug_half_seen() {
  Teaching mug;
  mug.frame = {"OPENNI_FRAME", 77};
  mug.name = "mug";
  mug.state = TeachingState::kTracking;
  mug.message = "from behind and from low nothing yet";
  mug.progress = 0.5F;
  mug.frames = 120;
  mug.keyframes = 14;
  mug.box_px = cv::Rect2f(10, 20, 30, 40);
  mug.T_camera_object = Eigen::Translation3d(0.1, 0.2, 0.7) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY());
  mug.directions = {{Eigen::Vector3f::UnitX(), true}, {-Eigen::Vector3f::UnitX(), false}};
  return mug;
}

std::string refusal(const teaching_t& message) {
  return error_of([&] { teaching_from_message(message); });
}

TEST(TeachingMessages, ATeachingComesBackAsItWas) {
  const Teaching mug = mug_half_seen();
  const Teaching back = teaching_from_message(over_the_wire(to_message(mug)));
  EXPECT_EQ(back.frame, mug.frame);
  EXPECT_EQ(back.name, "mug");
  EXPECT_EQ(back.state, TeachingState::kTracking);
  EXPECT_EQ(back.message, mug.message);
  EXPECT_EQ(back.progress, 0.5F);
  EXPECT_EQ(back.frames, 120);
  EXPECT_EQ(back.keyframes, 14);
  EXPECT_EQ(back.box_px, mug.box_px);
  ASSERT_TRUE(back.T_camera_object.has_value());
  EXPECT_TRUE(back.T_camera_object->isApprox(*mug.T_camera_object, 1e-12));
  ASSERT_EQ(back.directions.size(), 2U);
  EXPECT_EQ(back.directions[1].direction, -Eigen::Vector3f::UnitX());
  EXPECT_EQ(count_covered(back), 1);
}

TEST(TeachingMessages, WhatIsNotKnownIsNoNumber) {
  Teaching lost;
  lost.state = TeachingState::kLost;
  const teaching_t message = over_the_wire(to_message(lost));
  EXPECT_TRUE(std::isnan(message.progress) && std::isnan(message.box_width) && std::isnan(message.quat[3]));
  const Teaching back = teaching_from_message(message);
  EXPECT_FALSE(back.progress.has_value() || back.box_px.has_value() || back.T_camera_object.has_value());
  EXPECT_TRUE(back.directions.empty());
}

TEST(TeachingMessages, NonsenseIsRefused) {
  const teaching_t good = to_message(mug_half_seen());
  EXPECT_EQ(refusal(good), "");
  teaching_t bad = good;
  bad.state = 8;
  EXPECT_EQ(refusal(bad), "teaching of 'mug': state 8, expected 1 to 7");
  bad = good;
  bad.progress = 1.5F;
  EXPECT_NE(refusal(bad).find("progress 1.5"), std::string::npos);
  bad = good;
  bad.box_height = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(refusal(bad).find("box at (10, 20)"), std::string::npos);
  bad = good;
  bad.quat[0] = 3.0;
  EXPECT_NE(refusal(bad).find("a quaternion of length"), std::string::npos);
  bad = good;
  bad.trans[1] = std::numeric_limits<double>::infinity();
  EXPECT_NE(refusal(bad).find("expected metres within"), std::string::npos);
  bad = good;
  bad.directions[1][0] = 0.5F;
  EXPECT_NE(refusal(bad).find("a direction of length 0.5"), std::string::npos);
}

template <typename Message>
void expect_refused_where_damaged(const Message& message) {
  const std::vector<std::uint8_t> whole = encode_message(message);
  EXPECT_NO_THROW(decode_message<Message>({whole.data(), whole.size()}));
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(decode_message<Message>({whole.data(), size}), InputError) << size;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::vector<std::uint8_t> bytes = whole;
    bytes[i] ^= 0xFFU;
    try {
      decode_message<Message>({bytes.data(), bytes.size()});
    } catch (const InputError&) {
      continue;  // refusing is right; anything else thrown, or a crash, is not
    }
  }
}

TEST(TeachingMessages, DamagedOnesNeverCrash) {
  expect_refused_where_damaged(to_message(mug_half_seen()));
  KnownObjects known;
  known.store = "my.store";
  known.objects = {{"mug", 5}, {"bowl", 6}};
  known.problem = "store.json: cut short";
  known_objects_t message = to_message(known);
  message.process = "hs-pose";
  expect_refused_where_damaged(message);
  EXPECT_EQ(over_the_wire(message).object_names[1], "bowl");
  EXPECT_EQ(over_the_wire(message).object_since_utimes[1], 6);
}

}  // namespace
}  // namespace houghstream
