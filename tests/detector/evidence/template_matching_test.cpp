#include "detector/evidence/template_matching.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/random.hpp"
#include "pipeline/types/detection.hpp"
#include "tests/detector/evidence/template_view.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream {
namespace {

using toy::kDistance;
const Eigen::Vector3f kCentre(0.0F, 0.0F, kDistance);

TemplateMatch fit(const RgbdFrame& frame, const Eigen::Vector3f& centre = kCentre) {
  return match_template(toy::template_view(), centre, toy::lab_frame(frame, frame.colour, 1.0F));
}

RgbdFrame tile_frame() {
  return toy::training_views().front().frame;
}

TEST(TemplateMatch, TheViewItselfFitsWholly) {
  const TrainingView view = toy::training_views().front();
  const TemplateMatch result = fit(view.frame);
  EXPECT_GT(result.visible_fraction, 0.99F);
  EXPECT_GT(result.colour_correlation, 0.8F);
  EXPECT_EQ(result.rim_continuation, 0.0F);
  EXPECT_GT(box_iou(result.visible_box_px, cv::Rect2f(cv::boundingRect(view.mask))), 0.9F);
}

TEST(TemplateMatch, OfSomeRowsIsAboutThatOfAll) {
  const RgbdFrame frame = tile_frame();
  for (const float beside : {0.0F, 0.02F, 0.04F}) {
    const Eigen::Vector3f centre = kCentre + Eigen::Vector3f(beside, 0.0F, 0.0F);
    const LabFrame lab = toy::lab_frame(frame, frame.colour, 1.0F);
    const TemplateMatch all = match_template(toy::template_view(), centre, lab);
    const TemplateMatch some = match_template(toy::template_view(), centre, lab, {1.0F, 3});
    EXPECT_NEAR(some.visible_fraction, all.visible_fraction, 0.05F) << beside;
    EXPECT_NEAR(some.free_space_violation, all.free_space_violation, 0.05F) << beside;
    EXPECT_NEAR(some.colour_correlation, all.colour_correlation, 0.15F) << beside;
  }
}

TEST(TemplateMatch, FitsWhereverInTheImageTheObjectFacesTheCamera) {
  for (const cv::Point2d at : {cv::Point2d(30, 119.5), cv::Point2d(290, 119.5), cv::Point2d(280, 200)}) {
    RgbdFrame frame = toy::background(5);
    toy::put_tile(0, at.x, at.y, kDistance, frame);
    const TemplateMatch result = fit(frame, frame.camera.backproject(at.x, at.y, kDistance).cast<float>());
    EXPECT_GT(result.visible_fraction, 0.97F) << at;
    EXPECT_LT(result.depth_residual, 0.2F) << at;
  }
}

TEST(TemplateMatch, ADepthErrorOfAVoteIsForgivenAndLargerOnesAreNot) {
  EXPECT_GT(fit(tile_frame(), {0, 0, kDistance + 0.02F}).visible_fraction, 0.9F);
  EXPECT_LT(fit(tile_frame(), {0, 0, kDistance - 0.2F}).visible_fraction, 0.1F);
  EXPECT_GT(fit(tile_frame(), {0, 0, kDistance - 0.2F}).free_space_violation, 0.9F);
  EXPECT_GT(fit(tile_frame(), {0, 0, kDistance + 0.2F}).occluded_fraction, 0.9F);
}

TEST(TemplateMatch, AnOccluderHidesItsPartOfTheBox) {
  RgbdFrame frame = tile_frame();
  const cv::Rect whole = cv::boundingRect(toy::training_views().front().mask);
  frame.depth(cv::Rect(whole.x + whole.width / 2, 0, 320 - whole.x - whole.width / 2, 240)).setTo(0.5F);
  const TemplateMatch result = fit(frame);
  EXPECT_NEAR(result.occluded_fraction, 0.5F, 0.06F);
  EXPECT_NEAR(result.visible_fraction, 0.5F, 0.06F);
  EXPECT_EQ(result.free_space_violation, 0.0F);
  EXPECT_NEAR(result.visible_box_px.x, static_cast<float>(whole.x), 3.0F);
  EXPECT_NEAR(result.visible_box_px.width, 0.5F * static_cast<float>(whole.width), 4.0F);
  EXPECT_NEAR(result.visible_box_px.height, static_cast<float>(whole.height), 3.0F);
}

/// All but a strip at the left and one at the top is hidden, each narrower than a fifth of the object.
TEST(UnoccludedCells, LieInThoseOfAnotherTemplateOnTheSameSurface) {
  const RgbdFrame frame = tile_frame();
  const ViewTemplate whole = toy::template_view();
  ViewTemplate part = whole;  // what is half as large
  for (float& side : part.box) side *= 0.5F;
  const UnoccludedCells all(whole, kCentre, frame);
  EXPECT_EQ(all.fraction_in(all), 1.0F);
  EXPECT_GT(UnoccludedCells(part, kCentre, frame).fraction_in(all), 0.95F);
  EXPECT_NEAR(all.fraction_in(UnoccludedCells(part, kCentre, frame)), 0.25F, 0.08F);
  RgbdFrame hidden = frame;  // in its left half
  hidden.depth = frame.depth.clone();
  const cv::Rect seen = cv::boundingRect(toy::training_views().front().mask);
  hidden.depth(cv::Rect(0, 0, seen.x + seen.width / 2, 240)).setTo(0.5F);
  EXPECT_NEAR(UnoccludedCells(whole, kCentre, frame).fraction_in(UnoccludedCells(whole, kCentre, hidden)), 0.5F, 0.06F);
}

TEST(TemplateMatch, TheVisibleBoxEnclosesWhatLittleIsSeen) {
  RgbdFrame frame = tile_frame();
  const cv::Rect whole = cv::boundingRect(toy::training_views().front().mask);
  const cv::Point corner(whole.x + whole.width / 8, whole.y + whole.height / 8);
  frame.depth(cv::Rect(corner, whole.br())).setTo(0.5F);
  const TemplateMatch result = fit(frame);
  EXPECT_GT(result.occluded_fraction, 0.6F);
  EXPECT_GT(box_iou(result.visible_box_px, cv::Rect2f(whole)), 0.9F);
}

TEST(TemplateMatch, MissingDepthIsUnknownAndNeitherForNorAgainst) {
  RgbdFrame frame = tile_frame();
  frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  const TemplateMatch result = fit(frame);
  EXPECT_EQ(result.no_depth_fraction, 1.0F);
  EXPECT_EQ(result.visible_fraction + result.occluded_fraction + result.free_space_violation + result.rim_continuation,
            0.0F);
}

TEST(TemplateMatch, ColoursCountWhereDepthIsMissing) {
  RgbdFrame frame = tile_frame();
  frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_GT(fit(frame).colour_correlation, 0.8F);
  frame.colour = toy::background(5).colour;
  EXPECT_LT(fit(frame).colour_correlation, 0.3F);
}

TEST(TemplateMatch, WhatHidesTheObjectDoesNotLendItItsColours) {
  RgbdFrame frame = tile_frame();
  const float alone = fit(frame).colour_correlation;
  const cv::Rect left(0, 0, frame.colour.cols / 2, frame.colour.rows);
  frame.depth(left).setTo(0.5F);
  frame.colour(left).setTo(cv::Scalar(0, 255, 0));
  EXPECT_NEAR(fit(frame).colour_correlation, alone, 0.1F);
}

TEST(TemplateMatch, AWallGoesOnBesideTheOutline) {
  RgbdFrame frame = tile_frame();
  frame.depth.setTo(kDistance);
  EXPECT_GT(fit(frame).rim_continuation, 0.5F);
}

TEST(TemplateMatch, ALargerThingGoesOnBesideTheOutlineAndComesNearerThere) {
  const auto beside = [](float nearer) {
    RgbdFrame frame = tile_frame();
    cv::Mat around = frame.depth.clone();
    around.setTo(kDistance - nearer);
    frame.depth.copyTo(around, toy::training_views().front().mask);
    frame.depth = around;
    return fit(frame).rim_continuation;
  };
  EXPECT_GT(beside(0.02F), 0.5F);
  EXPECT_EQ(beside(0.06F), 0.0F) << "something in front";
  EXPECT_EQ(beside(-0.06F), 0.0F) << "what is behind";
}

BoundaryContinuation outline_of(const RgbdFrame& frame, const Eigen::Vector3f& centre = kCentre) {
  return measure_boundary_continuation(toy::template_view(), centre, toy::lab_frame(frame, frame.colour, 1.0F));
}

/// Surroundings of the tile, `behind` metres behind its edges and of this `colour`.
BoundaryContinuation outline_fit(double behind, const cv::Scalar& colour) {
  RgbdFrame frame = tile_frame();
  cv::Mat outside;
  cv::bitwise_not(toy::training_views().front().mask, outside);
  frame.depth.setTo(kDistance + behind, outside);
  frame.colour.setTo(colour, outside);
  return outline_of(frame);
}

TEST(TemplateMatch, AnObjectEndsAtItsOutlineWhereDepthOrColourDoes) {
  const BoundaryContinuation alone = outline_fit(0.3, {0, 200, 0});
  EXPECT_LT(alone.surface(), 0.05F);
  EXPECT_LT(alone.colour(), 0.05F);
  EXPECT_LT(alone.joint(), 0.05F);
  const BoundaryContinuation lying_on_another = outline_fit(0.0, {0, 200, 0});
  EXPECT_GT(lying_on_another.surface(), 0.3F);
  EXPECT_LT(lying_on_another.colour(), 0.05F);
  EXPECT_LT(lying_on_another.joint(), 0.05F);
}

/// The view template is a window of a plain wall.
TEST(TemplateMatch, APartOfALargerThingDoesNotEndAtTheOutline) {
  RgbdFrame wall = tile_frame();
  wall.depth.setTo(kDistance);
  wall.colour.setTo(cv::Scalar(90, 120, 150));
  const cv::Mat mask = toy::training_views().front().mask;
  ViewTemplate window = toy::template_view();
  window.appearance = make_template_grid(wall, mask, cv::boundingRect(mask), kCentre);
  const auto outline = [&] {
    return measure_boundary_continuation(window, kCentre, toy::lab_frame(wall, wall.colour, 1.0F));
  };
  EXPECT_GT(outline().surface(), 0.9F);
  EXPECT_GT(outline().colour(), 0.9F);
  EXPECT_GT(outline().joint(), 0.9F);
  cv::Mat outside;
  cv::bitwise_not(mask, outside);
  wall.depth.setTo(kDistance + 0.3, outside);
  EXPECT_LT(outline().surface(), 0.1F);
  EXPECT_LT(outline().colour(), 0.1F) << "another thing of its colour, behind it";
}

TEST(TemplateMatch, WhatHidesTheOutlineHasNoSayInWhereTheObjectEnds) {
  RgbdFrame frame = tile_frame();
  const BoundaryContinuation whole = outline_of(frame);
  const cv::Rect left(0, 0, frame.colour.cols / 2, frame.colour.rows);
  frame.depth(left).setTo(0.5F);
  frame.colour(left).setTo(cv::Scalar(0, 255, 0));
  EXPECT_NEAR(outline_of(frame).joint(), whole.joint(), 0.1F);
  frame.depth.setTo(0.5F);
  EXPECT_EQ(outline_of(frame).joint(), 0.0F);
  EXPECT_EQ(outline_of(frame).colour(), 0.0F);
}

TEST(TemplateMatch, AViewMayBeTakenForOneOfALargerObject) {
  const RgbdFrame frame = tile_frame();
  const LabFrame lab = toy::lab_frame(frame, frame.colour, 1.0F);
  const TemplateMatch own = match_template(toy::template_view(), kCentre, lab);
  const TemplateMatch resized = match_template(toy::resized(toy::template_view(), 0.5F), kCentre, lab, {2.0F});
  EXPECT_NEAR(resized.visible_fraction, own.visible_fraction, 0.01F);
  EXPECT_NEAR(resized.colour_correlation, own.colour_correlation, 0.01F);
  EXPECT_GT(box_iou(resized.visible_box_px, own.visible_box_px), 0.99F);
  EXPECT_LT(match_template(toy::resized(toy::template_view(), 0.5F), kCentre, lab).colour_correlation,
            own.colour_correlation - 0.1F);
}

TEST(TemplateMatch, LikenessIgnoresLightButNotPattern) {
  RgbdFrame dim = tile_frame();
  dim.colour.convertTo(dim.colour, -1, 0.5, 20.0);
  EXPECT_GT(fit(dim).colour_correlation, 0.75F);
  RgbdFrame noise = tile_frame();
  Random random(3);
  for (int y = 0; y < noise.colour.rows; ++y) {
    for (int x = 0; x < noise.colour.cols; ++x) {
      const auto value = static_cast<std::uint8_t>(random.below(256));
      noise.colour.at<cv::Vec3b>(y, x) = {value, value, value};
    }
  }
  EXPECT_LT(fit(noise).colour_correlation, 0.3F);
}

TEST(TemplateMatch, AnotherReliefIsUnevenWhereItIsStillNear) {
  const float of_itself = fit(tile_frame()).depth_residual;
  RgbdFrame flat = tile_frame();
  const cv::Mat mask = toy::training_views().front().mask;
  flat.depth.setTo(static_cast<float>(cv::mean(flat.depth, mask)[0]), mask);
  EXPECT_LT(of_itself, 0.1F);
  EXPECT_GT(fit(flat).depth_residual, of_itself + 0.1F);
  EXPECT_LE(fit(flat).depth_residual, 1.0F);
}

TEST(TemplateMatch, ColoursAreAveragedOverNeighbours) {
  const RgbdFrame frame = tile_frame();
  cv::Mat speck = cv::Mat(9, 9, CV_8UC3, cv::Scalar(90, 90, 90));
  speck.at<cv::Vec3b>(4, 4) = {180, 180, 180};
  const LabFrame in_lab = toy::lab_frame(frame, speck, 0.5F);
  cv::Mat lab;
  cv::cvtColor(cv::Mat(1, 1, CV_8UC3, cv::Scalar(100, 100, 100)), lab, cv::COLOR_BGR2Lab);
  EXPECT_EQ(in_lab.lab[0].at<cv::Vec3b>(4, 4), lab.at<cv::Vec3b>(0, 0));
  EXPECT_EQ(in_lab.lab[0].at<cv::Vec3b>(3, 5), lab.at<cv::Vec3b>(0, 0));
  EXPECT_EQ(in_lab.scale, 0.5F);
}

TEST(TemplateMatch, PrintThatIsFinerThanWhatIsRememberedIsAveraged) {
  constexpr int kLarger = 4;
  RgbdFrame frame = tile_frame();
  const float of_itself = fit(frame).colour_correlation;
  cv::resize(frame.colour.clone(), frame.colour, {}, kLarger, kLarger, cv::INTER_NEAREST);
  cv::resize(frame.depth.clone(), frame.depth, {}, kLarger, kLarger, cv::INTER_NEAREST);
  Camera& camera = frame.camera;
  camera = {kLarger * camera.width, kLarger * camera.height,           kLarger * camera.fx,
            kLarger * camera.fy,    kLarger * (camera.cx + 0.5) - 0.5, kLarger * (camera.cy + 0.5) - 0.5};
  for (int y = 0; y < frame.colour.rows; ++y) {
    for (int x = 0; x < frame.colour.cols; ++x) {
      cv::Vec3b& pixel = frame.colour.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c) pixel[c] = cv::saturate_cast<std::uint8_t>(pixel[c] + (x / 3 % 2 == 0 ? 60 : -60));
    }
  }
  EXPECT_GT(fit(frame).colour_correlation, of_itself - 0.15F);
}

TEST(TemplateMatch, OutsideTheFrameNothingIsCompared) {
  const TemplateMatch result = fit(tile_frame(), {2.0F, 0.0F, kDistance});
  EXPECT_EQ(result.visible_fraction + result.occluded_fraction + result.free_space_violation + result.no_depth_fraction,
            0.0F);
  const BoundaryContinuation outline = outline_of(tile_frame(), {2.0F, 0.0F, kDistance});
  EXPECT_EQ(outline.surface() + outline.colour(), 0.0F);
  EXPECT_TRUE(result.visible_box_px.empty());
}

TEST(TemplateMatch, WhatLiesOutsideTheFrameHasNoSayInTheDepth) {
  const TrainingView view = toy::training_views().front();
  const cv::Rect box = cv::boundingRect(view.mask);
  RgbdFrame frame = view.frame;  // shows only a third of the object
  const int columns = box.x + box.width / 3;
  frame.colour = frame.colour.colRange(0, columns).clone();
  frame.depth = frame.depth.colRange(0, columns).clone();
  frame.camera.width = columns;
  EXPECT_GT(fit(frame, {0, 0, kDistance + 0.025F}).visible_fraction, 0.9F);
}

}  // namespace
}  // namespace houghstream
