#include "pipeline/process/decoded_frames.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "pipeline/messages/messages.hpp"
#include "tests/pipeline/test_frame.hpp"

namespace houghstream {
namespace {

SharedBytes encoded(const RgbdFrame& frame) {
  const std::vector<std::uint8_t> bytes = encode_message(to_message(frame, WireFormat{}, 0));
  return shared_copy({bytes.data(), bytes.size()});
}

TEST(DecodedFrames, EachIsDecodedOnceAndSaysHowLongItTook) {
  DecodedFrames frames(std::nullopt, "test.decode");
  const SharedBytes bytes = encoded(make_test_frame(5));
  const DecodedFrames::Decoded first = frames.decode(bytes, "LEFT");
  EXPECT_EQ(first->id, (FrameId{"LEFT", 5}));
  EXPECT_EQ(first->stages.back().stage, "test.decode");
  EXPECT_EQ(frames.decode(bytes, "LEFT"), first);
}

TEST(DecodedFrames, AnotherFrameOfTheSameNameIsAnotherOne) {
  DecodedFrames frames(std::nullopt, "test.decode");
  RgbdFrame flat = make_test_frame(5);
  flat.depth.setTo(2.0F);
  const SharedBytes first = encoded(make_test_frame(5));
  const SharedBytes second = encoded(flat);
  frames.decode(first, "LEFT");
  EXPECT_EQ(frames.decode(second, "LEFT")->depth.at<float>(0, 0), 2.0F);
  EXPECT_NE(frames.decode(first, "LEFT")->depth.at<float>(0, 1), 2.0F);
}

TEST(DecodedFrames, WhatIsNoFrameIsRefused) {
  DecodedFrames frames(std::nullopt, "test.decode");
  EXPECT_THROW(frames.decode(std::make_shared<const std::vector<std::uint8_t>>(50, 0x5A), "LEFT"), InputError);
}

TEST(DecodedFrames, AreFewHoweverManyCamerasThereAre) {
  DecodedFrames frames(std::nullopt, "test.decode");
  const std::weak_ptr<const RgbdFrame> first = frames.decode(encoded(make_test_frame(0)), "0");
  for (std::size_t i = 1; i < DecodedFrames::kFrames; ++i)
    frames.decode(encoded(make_test_frame(0)), std::to_string(i));
  EXPECT_FALSE(first.expired());
  frames.decode(encoded(make_test_frame(0)), "one more");
  EXPECT_TRUE(first.expired());
}

TEST(DecodedFrames, LargeOnesAreFewer) {
  DecodedFrames frames(std::nullopt, "test.decode");
  const SharedBytes bytes = encoded(make_test_frame(0, 3840, 2160));  // decoded 7 bytes a pixel, 58 MB
  std::vector<std::weak_ptr<const RgbdFrame>> decoded;
  for (int i = 0; i < 4; ++i) decoded.push_back(frames.decode(shared_copy({bytes->data(), bytes->size()}), "LEFT"));
  EXPECT_TRUE(decoded[0].expired());
  for (int i = 1; i < 4; ++i) EXPECT_FALSE(decoded[static_cast<std::size_t>(i)].expired());
}

}  // namespace
}  // namespace houghstream
