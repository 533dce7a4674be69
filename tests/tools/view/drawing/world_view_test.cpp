#include "tools/view/drawing/world_view.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tools/view/drawing/overlay.hpp"

namespace houghstream::view {
namespace {

WorldObjects one_can(double x, std::int64_t utime = 1000000) {
  TrackedObject can;
  can.track_id = 4;
  can.class_id = 2;
  can.class_name = "can";
  can.state = TrackState::kVisible;
  can.probability = 0.9F;
  can.T_world_object = Eigen::Isometry3d(Eigen::Translation3d(x, 0, 1));
  can.covariance = 1e-6 * Covariance6::Identity();
  WorldObjects world;
  world.frame = {"CAMERA", utime};
  world.world = "WORLD";
  world.objects = {can};
  return world;
}

RgbdFrame black_frame(std::int64_t utime) {
  RgbdFrame frame;
  frame.id = {"CAMERA", utime};
  frame.camera = {320, 240, 250, 250, 159.5, 119.5};
  frame.colour = cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(0));
  return frame;
}

int pixels_of(const cv::Mat& image, const cv::Scalar& colour) {
  cv::Mat found;
  cv::inRange(image, colour, colour, found);
  return cv::countNonZero(found);
}

TEST(WorldView, AnObjectIsDrawnWhereItIsWithItsWayAndNotIntoAFrameOfAnotherTime) {
  WorldState state;
  for (int i = 0; i < 20; ++i) state.add(one_can(0.01 * i));
  EXPECT_EQ(state.trails.at(4).size(), 20U);
  cv::Mat image = black_frame(1000000).colour;
  draw_tracks(image, state, black_frame(1000000));
  EXPECT_GT(pixels_of(image, class_colour(2)), 20);
  EXPECT_GT(cv::norm(image.at<cv::Vec3b>(119, 180)), 0.0);  // on the way
  cv::Mat later = black_frame(9000000).colour;
  draw_tracks(later, state, black_frame(9000000));
  EXPECT_EQ(cv::norm(later), 0.0);
}

TEST(WorldView, ARingHasALegendAndAWideOneIsNamedInsteadOfDrawn) {
  WorldState state;
  state.add(one_can(0.0));
  cv::Mat image = black_frame(1000000).colour;
  const TrackLabels sure = draw_tracks(image, state, black_frame(1000000));
  ASSERT_EQ(sure.labels.size(), 1U);
  EXPECT_EQ(sure.labels[0].text, "#4 can 0.90");
  ASSERT_EQ(sure.occupied.size(), 1U);
  EXPECT_GT(cv::norm(image(sure.occupied[0])), 0.0) << "the legend of the ring";
  WorldObjects unsure = one_can(0.0);
  unsure.objects[0].covariance = 0.04 * Covariance6::Identity();  // a ring of 100 pixels, in an image of 240 rows
  WorldState wide;
  wide.add(unsure);
  cv::Mat empty = black_frame(1000000).colour;
  const TrackLabels named = draw_tracks(empty, wide, black_frame(1000000));
  EXPECT_EQ(named.labels.at(0).text, "#4 can 0.90, +-0.4 m");
  EXPECT_EQ(pixels_of(empty, class_colour(2)), 0) << "no ring fills the picture";
}

TEST(WorldView, AnotherWorldHasNoPast) {
  WorldState state;
  state.add(one_can(0.0));
  WorldObjects next = one_can(0.5);
  next.world_number = 2;
  state.add(next);
  EXPECT_EQ(state.trails.at(4).size(), 1U);
}

TEST(WorldView, BoxesAreThoseOfTheSameFrameAndWorld) {
  WorldState state;
  const WorldObjects world = one_can(0.0);
  state.add(world);
  ObjectPlacement box;
  box.track_id = 4;
  box.box_size = {0.07, 0.07, 0.12};
  ObjectPlacements placed{world.frame, world.world, world.world_number, {box}};
  ObjectPlacements late = placed;
  late.frame.utime += 1;
  state.add(late);
  EXPECT_TRUE(state.boxes.empty()) << "of another frame";
  state.add(placed);
  ASSERT_EQ(state.boxes.count(4), 1U);
  EXPECT_EQ(state.boxes.at(4).box_size.z(), 0.12);
  WorldObjects next = one_can(0.5);
  next.world_number = 2;
  state.add(next);
  EXPECT_TRUE(state.boxes.empty()) << "another world";
}

TEST(WorldView, CamerasWithoutEndAreNotRemembered) {
  WorldState state;
  for (int i = 0; i < 200; ++i) {
    WorldObjects world = one_can(0.0);
    world.frame.channel = std::to_string(i);
    state.add(world);
  }
  EXPECT_EQ(state.T_world_camera.size(), 64U);
  WorldObjects known = one_can(0.0);
  known.frame.channel = "0";
  known.T_world_camera = Eigen::Translation3d(1, 0, 0);
  state.add(known);
  EXPECT_EQ(state.T_world_camera.at("0").translation().x(), 1.0);
}

TEST(WorldView, AWorldOfAnyTimeIsSurvived) {
  WorldState state;
  state.add(one_can(0.0, std::numeric_limits<std::int64_t>::min()));
  const RgbdFrame frame = black_frame(std::numeric_limits<std::int64_t>::max());
  cv::Mat image = frame.colour.clone();
  draw_tracks(image, state, frame);
  EXPECT_EQ(cv::norm(image), 0.0);
}

TEST(WorldView, FromAboveObjectsAndCamerasAreDrawn) {
  WorldState state;
  state.add(one_can(0.2));
  const cv::Mat with = draw_world_from_above(state, {320, 240});
  EXPECT_EQ(with.size(), cv::Size(320, 240));
  EXPECT_GT(pixels_of(with, class_colour(2)), 50);
  EXPECT_EQ(pixels_of(draw_world_from_above({}, {320, 240}), class_colour(2)), 0);
}

/// Returns the caption of the world.
cv::Mat caption_of(const WorldObjects& world) {
  WorldState state;
  state.add(world);
  return draw_world_from_above(state, {640, 240}).rowRange(0, 22).clone();
}

TEST(WorldView, WhatIsGoneIsNotCounted) {
  const WorldObjects there = one_can(0.0);
  WorldObjects gone = there;
  gone.objects[0].state = TrackState::kGone;
  WorldObjects empty = there;
  empty.objects.clear();
  EXPECT_EQ(cv::norm(caption_of(gone), caption_of(empty)), 0.0);
  EXPECT_GT(cv::norm(caption_of(there), caption_of(empty)), 0.0);
}

TEST(WorldView, PlacesFarAwayAreSurvived) {
  for (const double far : {1e8, -1e9}) {
    WorldState state;
    state.add(one_can(far));
    EXPECT_EQ(draw_world_from_above(state, {320, 240}).cols, 320);
    WorldObjects back = one_can(0.2);
    back.objects[0].covariance = 1e300 * Covariance6::Identity();
    state.add(back);
    EXPECT_EQ(draw_world_from_above(state, {320, 240}).cols, 320) << "its way comes from far away";
    cv::Mat image = black_frame(1000000).colour;
    draw_tracks(image, state, black_frame(1000000));
    EXPECT_GT(cv::norm(image), 0.0);
  }
}

}  // namespace
}  // namespace houghstream::view
