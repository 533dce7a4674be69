#include "detector/training/augmentation/composites.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "tests/detector/toy_data.hpp"

namespace houghstream::training {
namespace {

AugmentationSettings plain() {
  AugmentationSettings settings;
  settings.lighting_variation = 0.0;
  settings.occluded_fraction = 0.0;
  settings.dehazed_fraction = 0.0;
  settings.sharpened_fraction = 0.0;
  return settings;
}

/// Stripes, 0.7 m away in the middle of the image; a relief of 15 mm behind the tile's middle.
TrainingView tile_view() {
  return toy::training_views().front();
}

std::optional<Composite> compose(const TrainingView& view, double distance, std::uint64_t seed,
                                 const AugmentationSettings& settings) {
  Random random(seed);
  return make_composite(view, toy::background(5), distance, settings, random);
}

bool same_values(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

TEST(Composites, SizeAndDepthChangeButReliefStaysInMetres) {
  const TrainingView view = tile_view();
  for (const double distance : {0.5, 1.4}) {
    const auto composite = compose(view, distance, 3, plain());
    ASSERT_TRUE(composite);
    EXPECT_DOUBLE_EQ(composite->scale, 0.7 / distance);
    EXPECT_NEAR(composite->depth_change.shift, distance - 0.7, 1e-6);
    const cv::Rect box = cv::boundingRect(composite->mask);
    EXPECT_NEAR(box.width, cv::boundingRect(view.mask).width * 0.7 / distance, 1.0) << distance;
    const cv::Mat tile = composite->frame.depth(box);
    const double middle = cv::mean(tile.col(box.width / 2))[0];
    const double side = 0.5 * (cv::mean(tile.col(0))[0] + cv::mean(tile.col(tile.cols - 1))[0]);  // it faces the camera
    EXPECT_NEAR(middle, distance + 0.015, 0.002) << distance;
    EXPECT_NEAR(middle - side, 0.0145, 0.002) << distance;
  }
}

TEST(Composites, TheOriginLeadsBackToTheView) {
  const auto composite = compose(tile_view(), 1.0, 3, plain());
  ASSERT_TRUE(composite);
  const cv::Rect box = cv::boundingRect(composite->mask);
  const cv::Point2d middle(box.x + 0.5 * (box.width - 1), box.y + 0.5 * (box.height - 1));
  const cv::Point2d in_view = (middle - composite->origin_px) / composite->scale;
  const cv::Rect seen = cv::boundingRect(tile_view().mask);
  EXPECT_NEAR(in_view.x, seen.x + 0.5 * (seen.width - 1), 0.25);
  EXPECT_NEAR(in_view.y, seen.y + 0.5 * (seen.height - 1), 0.25);
}

TEST(Composites, AreAsTheRoomsCameraWouldSeeThem) {
  TrainingView view = tile_view();
  view.frame.camera.fx *= 2.0;  // a tele lens: the tile is half as large
  view.frame.camera.fy *= 2.0;
  const auto composite = compose(view, 0.7, 3, plain());
  ASSERT_TRUE(composite);
  EXPECT_NEAR(cv::boundingRect(composite->mask).width, 0.5 * cv::boundingRect(view.mask).width, 1.0);
}

TEST(Composites, AtTheViewsDistanceTheObjectIsPastedAsItIs) {
  TrainingView view = tile_view();
  view.frame.depth.at<float>(120, 160) = std::numeric_limits<float>::quiet_NaN();
  const auto composite = compose(view, 0.7, 3, plain());
  ASSERT_TRUE(composite);
  const cv::Rect from = cv::boundingRect(view.mask);
  const cv::Rect to = cv::boundingRect(composite->mask);
  EXPECT_TRUE(same_values(view.frame.colour(from), composite->frame.colour(to)));
  EXPECT_TRUE(std::isnan(composite->frame.depth(to).at<float>(120 - from.y, 160 - from.x)));
}

TEST(Composites, TheObjectFacesTheRoomsCameraWhereItIsPut) {
  TrainingView view = tile_view();
  view.frame.depth.setTo(0.7F, view.mask);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const auto composite = compose(view, 0.7, seed, plain());
    ASSERT_TRUE(composite);
    const cv::Rect box = cv::boundingRect(composite->mask);
    const Camera& camera = composite->frame.camera;
    const auto at = [&](int x, int y) { return static_cast<double>(composite->frame.depth.at<float>(y, x)); };
    const Eigen::Vector3d left = camera.backproject(box.x, box.y, at(box.x, box.y));
    const Eigen::Vector3d right = camera.backproject(box.br().x - 1, box.y, at(box.br().x - 1, box.y));
    const Eigen::Vector3d low = camera.backproject(box.x, box.br().y - 1, at(box.x, box.br().y - 1));
    const Eigen::Vector3d middle = 0.5 * (right + low);
    EXPECT_NEAR((right - left).normalized().dot(middle.normalized()), 0.0, 0.03) << seed;
    EXPECT_NEAR((low - left).normalized().dot(middle.normalized()), 0.0, 0.03) << seed;
  }
}

TEST(Composites, AroundTheObjectTheRoomIsUntouched) {
  const auto composite = compose(tile_view(), 1.0, 3, plain());
  ASSERT_TRUE(composite);
  const RgbdFrame room = toy::background(5);
  const cv::Rect place(static_cast<int>(std::lround(room.camera.cx - composite->frame.camera.cx)),
                       static_cast<int>(std::lround(room.camera.cy - composite->frame.camera.cy)), composite->mask.cols,
                       composite->mask.rows);
  cv::Mat depth = room.depth(place).clone();
  composite->frame.depth.copyTo(depth, composite->mask);
  EXPECT_TRUE(same_values(depth, composite->frame.depth));
  cv::Mat colour = room.colour(place).clone();
  composite->frame.colour.copyTo(colour, composite->mask);
  EXPECT_TRUE(same_values(colour, composite->frame.colour));
}

/// The toy object, 0.7 m away, stands on a plane 8 cm below its middle, which rises by 30 degrees towards the horizon.
TrainingView standing_tile() {
  TrainingView view = tile_view();
  const Eigen::Vector3d up = -Eigen::Vector3d(0.0, std::cos(0.5), std::sin(0.5));
  view.support = {up, view.T_camera_object.translation() - 0.08 * up};
  return view;
}

TEST(Composites, AnObjectStandsOnItsPlaneAtAnyDistance) {
  const TrainingView view = standing_tile();
  AugmentationSettings settings = plain();
  settings.supported_fraction = 1.0;
  for (const double distance : {0.5, 0.7, 1.2}) {
    const auto composite = compose(view, distance, 3, settings);
    ASSERT_TRUE(composite);
    const Camera& camera = composite->frame.camera;
    // The view's plane, moved along the ray to the object's middle.
    const cv::Point2d& centre_px = composite->depth_change.centre_px;
    const Eigen::Vector3d centre = camera.backproject(centre_px.x, centre_px.y, distance);
    const cv::Rect box = cv::boundingRect(composite->mask);
    int on_plane = 0;
    for (int x = box.x; x < box.br().x; ++x) {
      const cv::Point at(x, box.br().y + 4);
      const Eigen::Vector3d point = camera.backproject(at.x, at.y, composite->frame.depth.at<float>(at));
      on_plane += std::abs(view.support->normal().dot(point - centre) + 0.08) < 0.02 ? 1 : 0;
    }
    EXPECT_GT(on_plane, box.width * 9 / 10) << distance;
  }
}

TEST(Composites, WithoutASupportNothingIsDrawnForIt) {
  AugmentationSettings settings = plain();
  settings.supported_fraction = 1.0;
  const auto before = compose(tile_view(), 1.0, 3, plain());
  const auto after = compose(tile_view(), 1.0, 3, settings);
  ASSERT_TRUE(before && after);
  EXPECT_TRUE(same_values(before->frame.depth, after->frame.depth));
  settings.supported_fraction = 0.0;
  const auto without = compose(standing_tile(), 1.0, 3, settings);
  ASSERT_TRUE(without);
  EXPECT_TRUE(same_values(before->frame.depth, without->frame.depth));
}

TEST(Composites, TheRoomBehindTheObjectIsNotInFrontOfIt) {
  const TrainingView view = tile_view();
  RgbdFrame room = toy::background(5);
  room.depth.colRange(0, room.depth.cols / 4).setTo(0.4F);  // too near to stand behind
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    const auto composite = make_composite(view, room, 1.2, plain(), random);
    ASSERT_TRUE(composite);
    EXPECT_LE(cv::countNonZero(composite->frame.depth < 0.5F), composite->mask.total() / 15) << "seed " << seed;
  }
}

TEST(Composites, WhatDoesNotFitGivesNothing) {
  EXPECT_FALSE(compose(tile_view(), 0.15, 3, plain()));
}

TEST(Composites, TheSameSeedGivesTheSameImage) {
  const TrainingView view = tile_view();
  const auto first = compose(view, 1.2, 8, {});
  const auto again = compose(view, 1.2, 8, {});
  const auto other = compose(view, 1.2, 9, {});
  ASSERT_TRUE(first && again && other);
  EXPECT_TRUE(same_values(first->frame.colour, again->frame.colour));
  EXPECT_TRUE(same_values(first->frame.depth, again->frame.depth));
  EXPECT_FALSE(same_values(first->frame.colour, other->frame.colour));
}

TEST(Composites, SharpenedAreOnlyObjectsAndOnlyIfAsked) {
  AugmentationSettings settings = plain();
  settings.sharpened_fraction = 1.0;
  const TrainingView view = tile_view();
  const auto as_taught = compose(view, 0.7, 3, plain());
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const auto sharp = compose(view, 0.7, seed, settings);
    ASSERT_TRUE(sharp && as_taught);
    const cv::Rect box = cv::boundingRect(sharp->mask);
    EXPECT_GT(cv::norm(sharp->frame.colour(box), as_taught->frame.colour(box), cv::NORM_INF), 5.0);
    EXPECT_TRUE(same_values(sharp->mask, as_taught->mask));
  }
}

TEST(VaryLight, StrengthZeroChangesNothing) {
  cv::Mat ramp(1, 256, CV_8UC3);
  for (int v = 0; v < 256; ++v) ramp.at<cv::Vec3b>(0, v) = cv::Vec3b::all(static_cast<std::uint8_t>(v));
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    cv::Mat lit = ramp.clone();
    jitter_lighting(lit, 0.0, -3.0, 3.0, random);
    ASSERT_TRUE(same_values(lit, ramp));
  }
}

TEST(VaryLight, StopsAreDoublings) {
  const cv::Mat grey(40, 40, CV_8UC3, cv::Scalar(100, 100, 100));
  const auto mean_at = [&](double stops) {
    double sum = 0.0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      Random random(seed);
      cv::Mat lit = grey.clone();
      jitter_lighting(lit, 1.0, stops, stops, random);
      sum += cv::mean(lit)[1] / 40.0;
    }
    return sum;
  };
  EXPECT_NEAR(mean_at(-2.0), 25.0, 8.0);  // haze adds some
  EXPECT_NEAR(mean_at(0.0), 100.0, 8.0);
  EXPECT_NEAR(mean_at(1.0), 200.0, 12.0);
}

}  // namespace
}  // namespace houghstream::training
