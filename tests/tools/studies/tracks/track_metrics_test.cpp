#include "tools/studies/tracks/track_metrics.hpp"

#include <gtest/gtest.h>

namespace houghstream::studies {
namespace {

Eigen::Isometry3d at(double x) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0));
}

/// Returns two cans that stand a metre apart.
SequenceFile two_cans(int frames) {
  SequenceFile out;
  out.fps = 10.0;
  out.cameras = {{"", "CAMERA_1", std::vector<Eigen::Isometry3d>(static_cast<std::size_t>(frames), at(0))}};
  for (int i = 0; i < frames; ++i) {
    out.utimes.push_back(100000 * i);
    out.frames.push_back({{1, "can", at(0.0), 1.0}, {2, "can", at(1.0), 1.0}});
  }
  return out;
}

OrderedJson measured(const SequenceFile& sequence, const std::vector<PublishedFrame>& published) {
  return track_metrics(sequence, published, {}, {});
}

TEST(TrackMetrics, WhatIsPublishedAsItIsIsPerfect) {
  const SequenceFile sequence = two_cans(100);
  std::vector<PublishedFrame> published;
  published.reserve(100);
  for (std::size_t i = 0; i < 100; ++i) published.push_back({i, {{7, "can", at(0.0)}, {8, "can", at(1.0)}}});
  const OrderedJson json = measured(sequence, published);
  EXPECT_EQ(json["recall"], 1.0);
  EXPECT_EQ(json["precision"], 1.0);
  EXPECT_EQ(json["id_switches"], 0);
  EXPECT_NEAR(json["hota"].get<double>(), 1.0, 1e-12);
  EXPECT_EQ(json["seconds_to_find"], (OrderedJson{0.0, 0.0}));
  EXPECT_EQ(json["jitter"]["windows"], 2);
  EXPECT_EQ(json["jitter"]["mm"], 0.0);
}

TEST(TrackMetrics, NumbersThatChangePlacesAreSwitchesAndHalveTheAssociation) {
  const SequenceFile sequence = two_cans(100);
  std::vector<PublishedFrame> published;
  for (std::size_t i = 0; i < 100; ++i) {
    const std::int64_t left = i < 50 ? 7 : 8;
    published.push_back({i, {{left, "can", at(0.0)}, {15 - left, "can", at(1.0)}}});
  }
  const OrderedJson json = measured(sequence, published);
  EXPECT_EQ(json["id_switches"], 2);
  EXPECT_EQ(json["recall"], 1.0);
  // Half the frames of each number are of either can: 50 / (100 + 100 - 50).
  EXPECT_NEAR(json["hota"].get<double>(), std::sqrt(1.0 / 3.0), 1e-9);
}

TEST(TrackMetrics, HotaGivesWhatItsTracksAreAlignedWithNotWhatIsNearest) {
  SequenceFile sequence = two_cans(100);
  for (auto& frame : sequence.frames) frame.pop_back();
  std::vector<PublishedFrame> published;
  for (std::size_t i = 0; i < 100; ++i) {
    published.push_back({i, {{7, "can", at(0.018)}}});
    if (i >= 40 && i < 60) published.back().objects.push_back({9, "can", at(0.0)});
  }
  const OrderedJson json = measured(sequence, published);
  // Number 7 is as near as 16 of 19 thresholds ask for, in all frames; number 9 is wrong 20 times.
  EXPECT_NEAR(json["hota"].get<double>(), 16.0 / 19.0 * std::sqrt(100.0 / 120.0), 1e-9);
  EXPECT_EQ(json["hota_counts"].size(), 19U);
  EXPECT_EQ(json["hota_counts"][0], (OrderedJson{100.0, 0.0, 20.0, 100.0}));
  EXPECT_EQ(json["hota_counts"][18], (OrderedJson{0.0, 100.0, 120.0, 0.0}));
}

TEST(TrackMetrics, OfAFrameOfWhichNothingIsPublishedAllIsMissed) {
  const SequenceFile sequence = two_cans(100);
  std::vector<PublishedFrame> published;
  for (std::size_t i = 0; i < 80; ++i) published.push_back({i, {{7, "can", at(0.0)}, {8, "can", at(1.0)}}});
  const OrderedJson json = measured(sequence, published);
  EXPECT_EQ(json["frames"], 100);
  EXPECT_EQ(json["silent_frames"], 20);
  EXPECT_NEAR(json["recall"].get<double>(), 0.8, 1e-12);
  EXPECT_NEAR(json["hota"].get<double>(), 0.8, 1e-9);  // 160 of 200 found, in 80 of 100 frames
}

TEST(TrackMetrics, PublishedDeviationsAreComparedWithTheErrors) {
  const SequenceFile sequence = two_cans(100);
  std::vector<PublishedFrame> published;
  for (std::size_t i = 0; i < 100; ++i)
    published.push_back({i, {{7, "can", at(0.003), 0.002}, {8, "can", at(i < 50 ? 1.0 : 1.005), 0.001}}});
  const OrderedJson standing = measured(sequence, published)["error"]["standing"];
  EXPECT_NEAR(standing["deviation_mm_median"].get<double>(), 1.5, 0.6);
  EXPECT_NEAR(standing["within_two_deviations"].get<double>(), 0.75, 0.01);
}

TEST(TrackMetrics, APoseThatLooksTheSameIsThatOfTheObjectWhereverItsOriginIs) {
  const SequenceFile sequence = two_cans(10);
  Eigen::Isometry3d half_turn = Eigen::Isometry3d::Identity();  // about a point 6 cm above the origin
  half_turn.translate(Eigen::Vector3d(0, 0, 0.06));
  half_turn.rotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  half_turn.translate(Eigen::Vector3d(0, 0, -0.06));
  std::vector<PublishedFrame> published;
  for (std::size_t i = 0; i < 10; ++i) published.push_back({i, {{7, "can", at(0.0) * half_turn}, {8, "can", at(1.0)}}});
  EXPECT_EQ(track_metrics(sequence, published, {{"can", {{half_turn}, {}}}}, {})["recall"], 1.0);
  EXPECT_EQ(measured(sequence, published)["recall"], 0.5);
}

TEST(TrackMetrics, WhatIsMissedWrongLateOrNotGoneIsCounted) {
  SequenceFile sequence = two_cans(40);
  for (std::size_t i = 20; i < 40; ++i) sequence.frames[i][1].T_world_object.reset();
  std::vector<PublishedFrame> published;
  for (std::size_t i = 0; i < 40; ++i) {
    PublishedFrame frame{i, {}};
    if (i >= 5) frame.objects.push_back({7, "can", at(0.0)});
    if (i < 27) frame.objects.push_back({8, "can", at(1.0)});  // 0.7 s too long
    if (i == 3) frame.objects.push_back({9, "mug", at(0.0)});
    published.push_back(frame);
  }
  const OrderedJson json = measured(sequence, published);
  EXPECT_NEAR(json["recall"].get<double>(), 55.0 / 60.0, 1e-12);
  EXPECT_NEAR(json["precision"].get<double>(), 55.0 / 63.0, 1e-12);
  EXPECT_EQ(json["wrong"], (OrderedJson{{"can", 7}, {"mug", 1}}));
  EXPECT_EQ(json["seconds_to_gone"].size(), 1U);
  EXPECT_NEAR(json["seconds_to_gone"][0].get<double>(), 0.7, 1e-9);
  EXPECT_NEAR(json["seconds_to_find"][1].get<double>(), 0.5, 1e-9);
}

TEST(TrackMetrics, WhatIsHiddenIsNeitherMissedNorWrongButKept) {
  SequenceFile sequence = two_cans(40);
  for (std::size_t i = 10; i < 30; ++i) sequence.frames[i][1].visible = 0.0;
  std::vector<PublishedFrame> published;
  for (std::size_t i = 0; i < 40; ++i) {
    PublishedFrame frame{i, {{7, "can", at(0.0)}}};
    if (i < 25 || i >= 30) frame.objects.push_back({8, "can", at(1.0)});
    published.push_back(frame);
  }
  const OrderedJson json = measured(sequence, published);
  EXPECT_EQ(json["recall"], 1.0);
  EXPECT_EQ(json["precision"], 1.0);
  EXPECT_EQ(json["hidden_frames"], 20);
  EXPECT_NEAR(json["hidden_kept"].get<double>(), 0.75, 1e-12);
}

TEST(MatchedPoses, APublishedObjectTenCentimetresAwayBelongsToNone) {
  const SequenceFile sequence = two_cans(2);
  std::vector<PublishedFrame> published = {{0, {{0, "can", at(0.099)}, {0, "can", at(1.101)}}, {0.8, 0.9}}, {1, {}}};
  const std::vector<MatchedPose> poses = match_published(sequence, published, {});
  ASSERT_EQ(poses.size(), 4U) << "each can of each frame";
  ASSERT_TRUE(poses[0].T_world_object.has_value());
  EXPECT_EQ(poses[0].T_world_object->translation().x(), 0.099);
  EXPECT_EQ(poses[0].quality, 0.8);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    EXPECT_FALSE(poses[i].T_world_object.has_value()) << i;
    EXPECT_TRUE(std::isnan(poses[i].quality)) << i;
  }
}

}  // namespace
}  // namespace houghstream::studies
