#include "tools/log/message_types.hpp"

#include <gtest/gtest.h>

#include <houghstream/camera_colours_t.hpp>
#include <houghstream/camera_timing_t.hpp>
#include <houghstream/drake_viewer_draw_t.hpp>
#include <houghstream/drake_viewer_load_robot_t.hpp>
#include <houghstream/placed_objects_t.hpp>
#include <houghstream/pose_probabilities_t.hpp>
#include <houghstream/pose_t.hpp>
#include <houghstream/status_t.hpp>

#include "tests/tools/log/recordings.hpp"

namespace houghstream::log_tools {
namespace {

TEST(MessageTypes, AreKnownByFingerprint) {
  EXPECT_EQ(type_name(status_t::getHash()), "status_t");
  EXPECT_EQ(type_name(images_t::getHash()), "images_t (bot_core)");
  EXPECT_EQ(type_name(placed_objects_t::getHash()), "placed_objects_t");
  EXPECT_EQ(type_name(pose_probabilities_t::getHash()), "pose_probabilities_t");
  EXPECT_EQ(type_name(camera_colours_t::getHash()), "camera_colours_t");
  EXPECT_EQ(type_name(camera_timing_t::getHash()), "camera_timing_t");
  EXPECT_EQ(type_name(0), "no message");
  EXPECT_EQ(type_name(0x1234), "?? 0000000000001234");
  EXPECT_EQ(type_name(-1), "?? ffffffffffffffff");
}

TEST(MessageTypes, FramesAreThreeOfThem) {
  EXPECT_TRUE(is_frame_type(images_t::getHash()));
  EXPECT_TRUE(is_frame_type(kinect_frame_msg_t::getHash()));
  EXPECT_TRUE(is_frame_type(drake_image_array_t::getHash()));
  EXPECT_FALSE(is_frame_type(status_t::getHash()));
  EXPECT_FALSE(is_frame_type(0));
}

TEST(MessageTypes, AFingerprintIsTheFirstEightBytes) {
  std::vector<std::uint8_t> bytes = encode_message(foreign_images(numbered_frame(0)));
  EXPECT_EQ(fingerprint_of({bytes.data(), bytes.size()}), images_t::getHash());
  EXPECT_EQ(fingerprint_of({bytes.data(), 8}), images_t::getHash());
  EXPECT_EQ(fingerprint_of({bytes.data(), 7}), 0);
  EXPECT_EQ(fingerprint_of({nullptr, 0}), 0);
}

// Package, struct name and constants do not enter a fingerprint; these are the ones of bot_core.
TEST(MessageTypes, BotCoreHasOurFingerprints) {
  EXPECT_EQ(static_cast<std::uint64_t>(images_t::getHash()), 0x20ba4f05e8f5e33aU);
  EXPECT_EQ(static_cast<std::uint64_t>(image_t::getHash()), 0x14739ffe13d5f5f0U);
  EXPECT_EQ(static_cast<std::uint64_t>(pose_t::getHash()), 0x2e16efb052b0105eU);
  EXPECT_EQ(type_name(pose_t::getHash()), "pose_t (bot_core)");
}

// Fingerprints that lcm-gen makes for Drake's lcmt_viewer_*.lcm.
TEST(MessageTypes, DrakeHasOurFingerprints) {
  EXPECT_EQ(static_cast<std::uint64_t>(drake_viewer_load_robot_t::getHash()), 0x8987209b10aa2d39U);
  EXPECT_EQ(static_cast<std::uint64_t>(drake_viewer_draw_t::getHash()), 0x414f0bfe5b2f4244U);
  EXPECT_EQ(type_name(drake_viewer_load_robot_t::getHash()), "lcmt_viewer_load_robot (drake)");
  EXPECT_EQ(type_name(drake_viewer_draw_t::getHash()), "lcmt_viewer_draw (drake)");
}

}  // namespace
}  // namespace houghstream::log_tools
