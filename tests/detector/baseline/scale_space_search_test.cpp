#include "detector/baseline/scale_space_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "detector/baseline/baseline_scales.hpp"
#include "detector/baseline/gall_profile.hpp"
#include "detector/baseline/study_detector.hpp"
#include "detector/training/forest_trainer.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream::baseline {
namespace {

/// Three of the five sizes are enough for the distances below.
const Forest& toy_forest() {
  static const Forest forest = [] {
    Profile profile = make_profile("gall");
    const training::TrainingSettings quick = toy::quick_profile().training;
    profile.training.trees = quick.trees;
    profile.training.max_depth = quick.max_depth;
    profile.training.tests_per_node = quick.tests_per_node;
    profile.training.patches_per_view = quick.patches_per_view;
    profile.features.scales = {0.66F, 1.0F, 1.66F};
    return training::train_forest(
        toy::training_views(), profile, [](const auto&) {}, scales_of(profile.features));
  }();
  return forest;
}

DetectionSettings quick_settings() {
  DetectionSettings settings = detection_settings_of(toy_forest());
  settings.spacing.stride = 2;
  return settings;
}

struct Scene {
  RgbdFrame frame = toy::background(77);
  cv::Rect2f box_px;
};

Scene tile_at(int kind, double u_px, double v_px, double distance) {
  Scene scene;
  scene.box_px = cv::Rect2f(cv::boundingRect(toy::put_tile(kind, u_px, v_px, distance, scene.frame)));
  return scene;
}

std::vector<ScoredHypothesis> search(const RgbdFrame& frame, const DetectionSettings& settings, Way way = Way::kFast) {
  StageClock clock;
  static const ForestIndex index(toy_forest());
  return search_scale_space({index, settings}, way, frame, clock);
}

const ScoredHypothesis& strongest(const std::vector<ScoredHypothesis>& candidates) {
  return *std::max_element(
      candidates.begin(), candidates.end(),
      [](const ScoredHypothesis& a, const ScoredHypothesis& b) { return a.detection.score < b.detection.score; });
}

void expect_same(const std::vector<ScoredHypothesis>& a, const std::vector<ScoredHypothesis>& b) {
  ASSERT_EQ(a.size(), b.size());
  ASSERT_FALSE(a.empty());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].detection.class_id, b[i].detection.class_id);
    EXPECT_EQ(a[i].detection.score, b[i].detection.score);
    EXPECT_EQ(a[i].detection.box_px, b[i].detection.box_px);
    EXPECT_EQ(a[i].detection.vote_weight, b[i].detection.vote_weight);
    EXPECT_EQ(a[i].detection.vote_count, b[i].detection.vote_count);
    EXPECT_EQ(a[i].evidence.relative_vote_mass, b[i].evidence.relative_vote_mass);
  }
}

TEST(ScaleSpaceSearch, FindsTheTaughtObjectsInEverySize) {
  for (const double distance : {0.46, 0.7, 1.1}) {
    for (const int kind : {0, 1}) {
      const Scene scene = tile_at(kind, 120, 110, distance);
      const std::vector<ScoredHypothesis> found = search(scene.frame, quick_settings());
      ASSERT_FALSE(found.empty()) << distance;
      const ScoredHypothesis& best = strongest(found);
      EXPECT_EQ(best.detection.class_id, kind + 1) << distance;
      EXPECT_EQ(best.detection.class_name, kind == 0 ? "stripes" : "rings");
      EXPECT_GT(best.detection.score, quick_settings().evidence.threshold) << distance;
      EXPECT_GT(box_iou(best.detection.box_px, scene.box_px), 0.75F) << distance << " m, kind " << kind;
      EXPECT_GT(best.detection.vote_count, 0);
      EXPECT_EQ(best.detection.score, vote_score(best.evidence.relative_vote_mass));
    }
  }
}

TEST(ScaleSpaceSearch, KnowsNoDepth) {
  Scene scene = tile_at(0, 120, 110, 0.7);
  const std::vector<ScoredHypothesis> with_depth = search(scene.frame, quick_settings());
  scene.frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  expect_same(with_depth, search(scene.frame, quick_settings()));
  for (const ScoredHypothesis& candidate : with_depth) {
    EXPECT_TRUE(candidate.detection.centre_camera.array().isNaN().all());
    EXPECT_TRUE(candidate.detection.rotations.empty());
  }
}

TEST(ScaleSpaceSearch, AnyNumberOfThreadsGivesTheSameCandidates) {
  Scene scene = tile_at(0, 90, 100, 0.7);
  toy::put_tile(1, 230, 120, 1.1, scene.frame);
  DetectionSettings settings = quick_settings();
  settings.threads = 1;
  const std::vector<ScoredHypothesis> serial = search(scene.frame, settings);
  for (const int threads : {2, 3}) {
    settings.threads = threads;
    expect_same(serial, search(scene.frame, settings));
  }
}

TEST(ScaleSpaceSearch, TheReferenceWayFindsTheSameCandidates) {
  const Scene scene = tile_at(1, 150, 120, 0.7);
  const DetectionSettings settings = quick_settings();
  const std::vector<ScoredHypothesis> fast = search(scene.frame, settings);
  expect_same(fast, search(scene.frame, settings, Way::kReference));
}

TEST(ScaleSpaceSearch, EachSizeHasAHoughImageThatPeaksWhereTheObjectFits) {
  const Scene scene = tile_at(0, 120, 110, 0.7 * 1.66);
  const DetectionSettings settings = quick_settings();
  const ForestIndex index(toy_forest());
  const std::vector<cv::Mat> images = scale_space_hough_images({index, settings}, 0, scene.frame);
  constexpr std::array<float, 3> kSizes = {0.66F, 1.0F, 1.66F};
  ASSERT_EQ(images.size(), kSizes.size());
  std::array<double, 3> peaks{};
  cv::Point at;
  for (std::size_t i = 0; i < images.size(); ++i) {
    ASSERT_EQ(images[i].type(), CV_32FC1);
    EXPECT_NEAR(images[i].cols, 320 * kSizes[i], 1);
    cv::minMaxLoc(images[i], nullptr, &peaks[i], nullptr, &at);
  }
  EXPECT_GT(peaks[2], peaks[1]);
  EXPECT_GT(peaks[2], peaks[0]);
  EXPECT_NEAR(at.x, (120 + 0.5) * 1.66, 4);
  EXPECT_NEAR(at.y, (110 + 0.5) * 1.66, 4);
  EXPECT_FLOAT_EQ(static_cast<float>(peaks[2]),
                  strongest(search(scene.frame, quick_settings())).evidence.relative_vote_mass);
}

TEST(ScaleSpaceSearch, AnObjectBetweenTwoSizesIsOneCandidate) {
  const Scene scene = tile_at(1, 120, 110, 0.7 * std::sqrt(1.66));
  const std::vector<ScoredHypothesis> found = search(scene.frame, quick_settings());
  const float best = strongest(found).detection.score;
  const auto is_the_object = [&](const ScoredHypothesis& candidate) {
    return candidate.detection.box_px.contains(cv::Point2f(120, 110)) && candidate.detection.score > 0.5F * best;
  };
  EXPECT_EQ(std::count_if(found.begin(), found.end(), is_the_object), 1);
}

TEST(ScaleSpaceSearch, TheDetectorReportsTheStrongestOfAllSizes) {
  const Scene scene = tile_at(0, 120, 110, 0.7);
  const Detections found = StudyDetector(toy_forest(), quick_settings()).detect(scene.frame);
  ASSERT_FALSE(found.detections.empty());
  EXPECT_EQ(found.detections[0].score, strongest(search(scene.frame, quick_settings())).detection.score);
  for (std::size_t i = 1; i < found.detections.size(); ++i) {
    if (found.detections[i].class_id != found.detections[0].class_id) continue;
    EXPECT_LE(box_iou(found.detections[i].box_px, found.detections[0].box_px), 0.5F);
  }
  std::vector<std::string> names;
  for (const StageTime& time : found.stages) names.push_back(time.stage);
  EXPECT_EQ(names, (std::vector<std::string>{"detect.resize", "detect.features", "detect.leaves", "detect.votes",
                                             "detect.suppression"}));
}

TEST(ScaleSpaceFrame, HolesBorrowOverPixelsAlone) {
  RgbdFrame frame = toy::background(79);
  frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  frame.depth.colRange(0, 5).setTo(0.4F);
  FeatureSettings settings;
  settings.fill_distance_px = 10.0F;
  settings.fill_distance = 0.05F;  // 32 pixels at 0.4 m
  const FeatureLevel level{1.0F, 1.66F, 0.0F, 0.0F};
  const WorkingFrame working = scale_space_frame(frame, level, settings);
  EXPECT_FLOAT_EQ(working.filled_depth.at<float>(5, 4 + 10), 0.4F);
  EXPECT_TRUE(std::isnan(working.filled_depth.at<float>(5, 4 + 11)));
  EXPECT_EQ(working.size_ratio, 1.66F);
}

TEST(ScaleSpaceSearch, AnEmptyRoomOffersLittle) {
  const float found = strongest(search(tile_at(0, 120, 110, 0.7).frame, quick_settings())).detection.score;
  for (const ScoredHypothesis& candidate : search(toy::background(78), quick_settings())) {
    EXPECT_LT(candidate.detection.score, 0.5F * found);
  }
}

ScalePeak peak(int size, float x_px, float mass, std::int32_t class_id = 1) {
  ScalePeak out;
  out.candidate.detection.class_id = class_id;
  out.candidate.evidence.relative_vote_mass = mass;
  out.at_px = {x_px, 50.0F};
  out.reach_px = 8.0F;
  out.size = size;
  return out;
}

std::vector<float> kept_masses(const std::vector<ScalePeak>& peaks) {
  std::vector<float> masses;
  for (const ScoredHypothesis& candidate : maxima_over_sizes(peaks))
    masses.push_back(candidate.evidence.relative_vote_mass);
  return masses;
}

using Masses = std::vector<float>;

TEST(ScalePeaks, OfTwoInNeighbouringSizesTheHigherIsTheMaximum) {
  EXPECT_EQ(kept_masses({peak(1, 100, 0.4F), peak(2, 104, 0.6F)}), Masses({0.6F}));
  EXPECT_EQ(kept_masses({peak(1, 100, 0.6F), peak(2, 104, 0.4F)}), Masses({0.6F}));
}

TEST(ScalePeaks, OfEqualNeighboursTheFirstCounts) {
  EXPECT_EQ(kept_masses({peak(1, 100, 0.5F), peak(2, 104, 0.5F)}), Masses({0.5F}));
}

TEST(ScalePeaks, WhatIsNoNeighbourStays) {
  const ScalePeak low = peak(1, 100, 0.4F);
  EXPECT_EQ(kept_masses({low, peak(2, 109, 0.6F)}), Masses({0.4F, 0.6F}));     // out of reach
  EXPECT_EQ(kept_masses({low, peak(3, 100, 0.6F)}), Masses({0.4F, 0.6F}));     // two sizes away
  EXPECT_EQ(kept_masses({low, peak(1, 100, 0.6F)}), Masses({0.4F, 0.6F}));     // the same size decides by itself
  EXPECT_EQ(kept_masses({low, peak(2, 100, 0.6F, 2)}), Masses({0.4F, 0.6F}));  // another object
}

TEST(ScalePeaks, TheLargerReachCounts) {
  ScalePeak coarse = peak(0, 100, 0.6F);
  coarse.reach_px = 20.0F;
  EXPECT_EQ(kept_masses({coarse, peak(1, 115, 0.4F)}), Masses({0.6F}));
}

TEST(ScalePeaks, ASlopeHidesWhatIsLowerThanItself) {
  EXPECT_EQ(kept_masses({peak(0, 100, 0.3F), peak(1, 106, 0.4F), peak(2, 112, 0.6F)}), Masses({0.6F}));
}

TEST(ScalePeaks, NothingGivesNothing) {
  EXPECT_TRUE(maxima_over_sizes({}).empty());
}

}  // namespace
}  // namespace houghstream::baseline
