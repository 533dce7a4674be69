#include "drivers/openni/timestamp_pairing.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace houghstream::openni {
namespace {

using Sensor = SensorImage::Sensor;

constexpr std::int64_t kTolerance = 18'000;  // images come every 33 ms

SensorImage taken_by(Sensor sensor, std::uint64_t time_ms) {
  SensorImage image;
  image.sensor = sensor;
  image.device_us = 1000 * time_ms;
  return image;
}
SensorImage depth(std::uint64_t time_ms) {
  return taken_by(Sensor::kDepth, time_ms);
}
SensorImage colour(std::uint64_t time_ms) {
  return taken_by(Sensor::kColour, time_ms);
}

/// Times of the pairs in milliseconds that these images make, in this order of arrival.
std::vector<std::pair<int, int>> pairs_of(TimestampPairing& pairing, const std::vector<SensorImage>& images) {
  std::vector<std::pair<int, int>> pairs;
  for (const SensorImage& image : images) {
    if (const auto pair = pairing.put(image)) {
      pairs.emplace_back(static_cast<int>(pair->depth.device_us / 1000),
                         static_cast<int>(pair->colour.device_us / 1000));
    }
  }
  return pairs;
}

using Pairs = std::vector<std::pair<int, int>>;

TEST(TimestampPairing, TheOrderOfArrivalDoesNotMatter) {
  TimestampPairing pairing(kTolerance);
  EXPECT_EQ(pairs_of(pairing, {depth(0), colour(1), colour(34), depth(33)}), (Pairs{{0, 1}, {33, 34}}));
}

TEST(TimestampPairing, LateColourMeetsItsOwnDepth) {
  TimestampPairing pairing(kTolerance);
  const Pairs pairs =
      pairs_of(pairing, {depth(0), depth(33), depth(66), colour(8), depth(100), colour(41), colour(74)});
  EXPECT_EQ(pairs, (Pairs{{0, 8}, {33, 41}, {66, 74}})) << "the last colour would be two images old";
  EXPECT_EQ(pairing.unpaired(), 0);
}

TEST(TimestampPairing, WhatHasNoPartnerIsGivenUpAndCounted) {
  TimestampPairing pairing(kTolerance);
  EXPECT_EQ(pairs_of(pairing, {depth(0), depth(33), colour(34), depth(66), colour(100), depth(100)}),
            (Pairs{{33, 34}, {100, 100}}));
  EXPECT_EQ(pairing.unpaired(), 2) << "colour was lost at 0 and at 66";
}

TEST(TimestampPairing, ImagesFarApartNeverMeet) {
  TimestampPairing pairing(kTolerance);
  EXPECT_TRUE(pairs_of(pairing, {colour(0), depth(19), colour(200), depth(230)}).empty());
}

TEST(TimestampPairing, OfTwoTheNearerOneIsTaken) {
  TimestampPairing pairing(kTolerance);
  EXPECT_EQ(pairs_of(pairing, {colour(0), colour(30), depth(17)}), (Pairs{{17, 30}}));
}

TEST(TimestampPairing, AClockThatJumpsStartsAfresh) {
  for (const std::uint64_t after : {100U, 9000U}) {
    TimestampPairing pairing(kTolerance);
    std::vector<SensorImage> images = {depth(5000), depth(5033)};
    for (std::uint64_t t = after; t < after + 400; t += 33) {
      images.push_back(depth(t));
      if (t >= after + 66) images.push_back(colour(t - 66 + 8));  // late: colour of before the jump never comes
    }
    const Pairs pairs = pairs_of(pairing, images);
    ASSERT_GT(pairs.size(), 8U);
    for (const auto& [depth_ms, colour_ms] : pairs) EXPECT_EQ(colour_ms, depth_ms + 8);
  }
}

TEST(TimestampPairing, WithoutColourNothingPilesUp) {
  TimestampPairing pairing(kTolerance);
  for (std::uint64_t t = 0; t < 3300; t += 33) EXPECT_FALSE(pairing.put(depth(t)).has_value());
  EXPECT_EQ(pairing.unpaired(), 100 - static_cast<std::int64_t>(TimestampPairing::kMaxUnpaired));
  pairing.clear();
  EXPECT_EQ(pairing.unpaired(), 100);
}

}  // namespace
}  // namespace houghstream::openni
