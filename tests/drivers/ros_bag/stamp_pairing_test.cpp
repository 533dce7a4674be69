#include "drivers/ros_bag/stamp_pairing.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <utility>
#include <vector>

namespace houghstream::ros_bag {
namespace {

constexpr std::int64_t kFirstStamp = 1'000'000'000;
constexpr std::int64_t kFramePeriod = 33'000;
constexpr std::int64_t kTolerance = kFramePeriod / 2;

using Stamps = std::vector<std::pair<std::int64_t, std::int64_t>>;  // depth, colour, after kFirstStamp

StampedImage image_at(std::int64_t stamp_us) {
  StampedImage image;
  image.stamp_us = kFirstStamp + stamp_us;
  image.message.bytes.resize(8);
  return image;
}

void pop_all(StampPairing& pairing, Stamps& pairs) {
  while (const std::optional<StampedPair> pair = pairing.pop())
    pairs.emplace_back(pair->depth.stamp_us - kFirstStamp, pair->colour.stamp_us - kFirstStamp);
}

/// Adds all depth, then all colour.
Stamps pairs_of(StampPairing& pairing, const std::vector<std::int64_t>& depth,
                const std::vector<std::int64_t>& colour) {
  Stamps pairs;
  for (const std::int64_t stamp : depth) {
    pairing.add_depth(image_at(stamp));
    pop_all(pairing, pairs);
  }
  for (const std::int64_t stamp : colour) {
    pairing.add_colour(image_at(stamp));
    pop_all(pairing, pairs);
  }
  pairing.end();
  pop_all(pairing, pairs);
  return pairs;
}

TEST(StampPairing, EachDepthGoesWithTheNearestColour) {
  StampPairing pairing(kTolerance);
  EXPECT_EQ(pairs_of(pairing, {0, 33000, 66000}, {-14000, 2000, 34000, 47000, 65000}),
            (Stamps{{0, 2000}, {33000, 34000}, {66000, 65000}}));
  EXPECT_EQ(pairing.unpaired().depth, 0);
  EXPECT_EQ(pairing.unpaired().colour, 2);
}

TEST(StampPairing, AColourGoesToTheDepthThatIsNearer) {
  StampPairing pairing(kTolerance);
  EXPECT_EQ(pairs_of(pairing, {0, 30000}, {15500}), (Stamps{{30000, 15500}}));
  EXPECT_EQ(pairing.unpaired().depth, 1);
}

TEST(StampPairing, WhatIsTooFarStaysAloneAndIsCounted) {
  StampPairing pairing(kTolerance);
  EXPECT_EQ(pairs_of(pairing, {0, 33000}, {kTolerance + 1 + 33000}), Stamps{});
  EXPECT_EQ(pairing.unpaired().depth, 2);
  EXPECT_EQ(pairing.unpaired().colour, 1);
}

TEST(StampPairing, ImagesOutOfOrderComeOutInOrder) {
  StampPairing pairing(kTolerance);
  EXPECT_EQ(pairs_of(pairing, {33000, 0, 66000}, {66000, 33000, 0}), (Stamps{{0, 0}, {33000, 33000}, {66000, 66000}}));
}

TEST(StampPairing, AStampIsUsedOnce) {
  StampPairing pairing(kTolerance);
  EXPECT_EQ(pairs_of(pairing, {0, 0, 33000}, {0, 0, 33000}), (Stamps{{0, 0}, {33000, 33000}}));
  EXPECT_EQ(pairing.unpaired().repeated, 1);
  EXPECT_EQ(pairing.unpaired().colour, 1);
}

TEST(StampPairing, OneWrongStampHarmsItsOwnImageOnly) {
  for (const bool is_depth : {true, false}) {
    StampPairing pairing(kTolerance);
    Stamps pairs;
    for (std::int64_t i = 0; i < 40; ++i) {
      const std::int64_t wrong = i == 5 ? 1'000'000'000 : 0;
      pairing.add_depth(image_at(i * kFramePeriod + (is_depth ? wrong : 0)));
      pop_all(pairing, pairs);
      pairing.add_colour(image_at(i * kFramePeriod + 1000 + (is_depth ? 0 : wrong)));
      pop_all(pairing, pairs);
    }
    EXPECT_GE(pairs.size(), 30U) << "pairs come while images come";
    pairing.end();
    pop_all(pairing, pairs);
    EXPECT_EQ(pairs.size(), 39U);
    EXPECT_EQ(pairing.unpaired().depth, 1);
    EXPECT_EQ(pairing.unpaired().colour, 1);
  }
}

TEST(StampPairing, WhereOneKindStaysAwayFewWait) {
  StampPairing pairing(kTolerance);
  Stamps pairs;
  for (std::int64_t i = 0; i < 3000; ++i) {
    pairing.add_depth(image_at(i * kFramePeriod));
    pop_all(pairing, pairs);
  }
  EXPECT_GE(pairing.unpaired().depth, 2400);
  for (std::int64_t i = 0; i < 3000; ++i) {
    pairing.add_colour(image_at(3000 * kFramePeriod + i * kFramePeriod));
    pop_all(pairing, pairs);
  }
  EXPECT_EQ(pairing.unpaired().depth, 3000);
  EXPECT_GE(pairing.unpaired().colour, 2400);
  EXPECT_TRUE(pairs.empty());
}

}  // namespace
}  // namespace houghstream::ros_bag
