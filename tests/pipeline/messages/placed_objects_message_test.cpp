#include "pipeline/messages/placed_objects_message.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "tests/pipeline/messages/over_the_wire.hpp"

namespace houghstream {
namespace {

ObjectPlacements mug_with_a_handle() {
  ObjectPlacement mug;
  mug.track_id = 3;
  mug.class_name = "mug";
  mug.T_world_box = Eigen::Translation3d(0.1, -0.2, 0.7) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY());
  mug.box_size = {0.12, 0.08, 0.1};
  mug.frames.push_back({"handle", mug.T_world_box * Eigen::Translation3d(0.06, 0.0, 0.0)});
  mug.frames.push_back({"rim", mug.T_world_box * Eigen::Translation3d(0.0, 0.0, 0.05)});
  ObjectPlacements placed;
  placed.frame = {"RIGHT", 77};
  placed.world = "WORLD";
  placed.world_number = 2;
  placed.objects = {mug};
  return placed;
}

TEST(PlacedObjectsMessage, ComesBackAsItWas) {
  const ObjectPlacements placed = mug_with_a_handle();
  const ObjectPlacements back = placed_objects_from_message(over_the_wire(to_message(placed)));
  EXPECT_EQ(back.frame, placed.frame);
  EXPECT_EQ(back.world, "WORLD");
  EXPECT_EQ(back.world_number, 2);
  ASSERT_EQ(back.objects.size(), 1U);
  const ObjectPlacement& mug = back.objects[0];
  EXPECT_EQ(mug.track_id, 3);
  EXPECT_EQ(mug.class_name, "mug");
  EXPECT_TRUE(mug.T_world_box.isApprox(placed.objects[0].T_world_box, 1e-12));
  EXPECT_EQ(mug.box_size, placed.objects[0].box_size);
  ASSERT_EQ(mug.frames.size(), 2U);
  EXPECT_EQ(mug.frames[1].name, "rim");
  EXPECT_TRUE(mug.frames[1].T_world_frame.isApprox(placed.objects[0].frames[1].T_world_frame, 1e-12));
  EXPECT_TRUE(placed_objects_from_message(over_the_wire(to_message(ObjectPlacements{}))).objects.empty());
}

TEST(PlacedObjectsMessage, WhatIsNoPlaceIsRefused) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const placed_objects_t good = to_message(mug_with_a_handle());
  const auto expect_refused = [&](const std::function<void(placed_object_t&)>& spoil) {
    placed_objects_t bad = good;
    spoil(bad.objects[0]);
    EXPECT_THROW(placed_objects_from_message(bad), InputError);
  };
  expect_refused([](placed_object_t& mug) { mug.track_id = 0; });
  expect_refused([](placed_object_t& mug) { mug.box_trans[1] = kNaN; });
  expect_refused([](placed_object_t& mug) { mug.box_quat[0] = 2.0; });
  expect_refused([](placed_object_t& mug) { mug.box_size[2] = -0.1; });
  expect_refused([](placed_object_t& mug) { mug.box_size[0] = kNaN; });
  expect_refused([](placed_object_t& mug) { mug.frames[1].quat[3] = kNaN; });
}

TEST(PlacedObjectsMessage, DamagedCountsAreRefusedBeforeMemoryIsAskedFor) {
  std::vector<std::uint8_t> bytes = encode_message(to_message(mug_with_a_handle()));
  const auto decode = [&] { decode_message<placed_objects_t>({bytes.data(), bytes.size()}); };
  EXPECT_NO_THROW(decode());
  for (std::size_t i = 8; i < bytes.size(); ++i) {
    const std::uint8_t before = bytes[i];
    bytes[i] = 0x7F;
    try {
      decode();
    } catch (const InputError&) {
    }
    bytes[i] = before;
  }
  bytes.pop_back();
  EXPECT_THROW(decode(), InputError);
}

}  // namespace
}  // namespace houghstream
