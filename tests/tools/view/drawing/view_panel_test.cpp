#include <gtest/gtest.h>

#include "tools/view/drawing/frame_view.hpp"

namespace houghstream::view {
namespace {

ViewedFrame with_objects(int count) {
  ViewedFrame viewed;
  viewed.detections.detections.resize(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    Detection& detection = viewed.detections.detections[static_cast<std::size_t>(i)];
    detection.class_id = i + 1;
    detection.class_name = "object";
  }
  return viewed;
}

bool differs(const cv::Mat& a, const cv::Mat& b, const cv::Rect& where) {
  return cv::norm(a(where), b(where), cv::NORM_L1) > 0.0;
}

const cv::Rect kStream(0, 0, 320, 130);
const cv::Rect kObjects(320, 0, 320, 130);
const cv::Rect kLatency(960, 0, 320, 130);

TEST(ViewPanel, BlocksStandBesideEachOtherAsFarAsTheyFit) {
  const int row = draw_panel({}, {}, {}, 1280).rows;
  EXPECT_EQ(draw_panel({}, {}, {}, 640).rows, 2 * row);
  EXPECT_EQ(draw_panel({}, {}, {}, 200).rows, 4 * row);
  EXPECT_EQ(draw_panel({}, {}, {}, 200).cols, 200);
}

TEST(ViewPanel, ObjectsAreListedInTheirColours) {
  const cv::Mat panel = draw_panel(with_objects(3), {}, {}, 1280);
  for (int id = 1; id <= 3; ++id) {
    cv::Mat same;
    cv::inRange(panel(kObjects), class_colour(id), class_colour(id), same);
    EXPECT_GE(cv::countNonZero(same), 100) << id;
  }
  EXPECT_FALSE(draw_panel(with_objects(50), {}, {}, 1280).empty());
}

TEST(ViewPanel, TheCameraIsNamedAndThatThereAreOthers) {
  const FrameId frame{"LEFT", 1'500'000};
  EXPECT_EQ(camera_heading(frame, {"LEFT"}), "LEFT, frame 1.500 s");
  EXPECT_EQ(camera_heading(frame, {"LEFT", "RIGHT"}), "LEFT (1 of 2), frame 1.500 s");
  EXPECT_EQ(camera_heading({"", 1'500'000}, {}), "frame 1.500 s");
}

TEST(ViewPanel, LatencyIsThatOfWhatCame) {
  EXPECT_EQ(latency_heading(50.0, 80.4), "detections after 50 ms, poses 80");
  EXPECT_EQ(latency_heading(50.0, std::nullopt), "detections after 50 ms, no poses");
  EXPECT_EQ(latency_heading(std::nullopt, 12.0), "poses after 12 ms") << "of followed objects";
  EXPECT_EQ(latency_heading(std::nullopt, std::nullopt), "no detections");
}

TEST(ViewPanel, WhatTheDetectorSendsIsAllShownUnlessAskedOtherwise) {
  ViewedFrame viewed = with_objects(3);
  for (Detection& detection : viewed.detections.detections) detection.score = 0.1F;
  const FrameViewSettings settings;
  EXPECT_EQ(objects_heading(without_weak(viewed, settings.min_score), settings.min_score),
            "3 objects: score, metres, quality of pose");
  viewed.detections.detections[1].score = 0.6F;
  EXPECT_EQ(objects_heading(without_weak(viewed, 0.5F), 0.5F), "1 of 3 objects, from score 0.50");
}

TEST(ViewPanel, LossesThatNobodyKnowsAreNoNumber) {
  EXPECT_EQ(rates_line(30.0, 2), "frames 30.0 Hz, 2 lost");
  EXPECT_EQ(rates_line(30.0, -1), "frames 30.0 Hz, losses unknown");
}

TEST(ViewPanel, RatesLossesAndLatencyAreShown) {
  StreamView stream;
  const cv::Mat plain = draw_panel({}, stream, {}, 1280);
  stream.frames_lost = 3;
  EXPECT_TRUE(differs(draw_panel({}, stream, {}, 1280), plain, kStream));
  stream.frames_lost = 0;
  stream.state.processes = std::vector<ProcessState>(20, {"hs-detect", 7, 9.8F, 3, 1, 1, 0});
  EXPECT_TRUE(differs(draw_panel({}, stream, {}, 1280), plain, kStream));
  stream.history = {{{{"a", 1000}}, 2.0}};
  EXPECT_TRUE(differs(draw_panel({}, stream, {}, 1280), plain, kLatency));
}

TEST(ViewPanel, KeysAndPauseAreSaidWhereThereIsAWindow) {
  FrameViewSettings settings;
  const cv::Mat without = draw_panel({}, {}, settings, 1280);
  settings.show_keys = true;
  const cv::Mat with_keys = draw_panel({}, {}, settings, 1280);
  ASSERT_GT(with_keys.rows, without.rows);
  settings.paused = true;
  const cv::Rect keys(0, without.rows, 1280, with_keys.rows - without.rows);
  EXPECT_TRUE(differs(draw_panel({}, {}, settings, 1280), with_keys, keys));
}

}  // namespace
}  // namespace houghstream::view
