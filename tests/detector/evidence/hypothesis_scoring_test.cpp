#include "detector/evidence/hypothesis_scoring.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "detector/stages.hpp"
#include "tests/detector/evidence/template_view.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream {
namespace {

std::vector<ScoredHypothesis> candidates(const RgbdFrame& frame, const DetectionSettings& settings = {},
                                         const std::vector<std::uint32_t>& excluded_views = {}) {
  SearchContext search{toy::forest_index(), settings};
  search.excluded_views = excluded_views;
  DetectorWorkspace workspace;
  make_working_images(search, frame, workspace);
  compute_features(search, workspace);
  find_posteriors(search, workspace);
  const std::vector<Hypothesis> hypotheses = find_hypotheses(search, workspace);
  return score_hypotheses(search, frame, hypotheses, workspace);
}

TEST(Candidates, TheStrongestOfAClassComesWithEvidenceForIt) {
  RgbdFrame frame = toy::background(77);
  const cv::Mat mask = toy::put_tile(0, 159.5, 119.5, 0.7, frame);
  const std::vector<ScoredHypothesis> found = candidates(frame);
  ASSERT_FALSE(found.empty());
  const ScoredHypothesis& best = found.front();
  EXPECT_EQ(best.detection.class_id, 1);
  EXPECT_GT(best.evidence.relative_vote_mass, 0.3F);
  EXPECT_GT(best.evidence.fit.visible_fraction, 0.8F);
  EXPECT_GT(best.evidence.fit.colour_correlation, 0.5F);
  EXPECT_GT(box_iou(best.detection.box_px, cv::Rect2f(cv::boundingRect(mask))), 0.7F);
  EXPECT_EQ(best.detection.score, score(toy::forest().classes[0].score_model, best.evidence));
}

TEST(Candidates, ExcludedViewsAreNotCompared) {
  RgbdFrame frame = toy::background(77);
  toy::put_tile(0, 159.5, 119.5, 0.7, frame);
  std::vector<std::uint32_t> all;
  all.reserve(toy::forest().views.size());
  for (std::uint32_t v = 0; v < toy::forest().views.size(); ++v) all.push_back(v);
  const std::vector<ScoredHypothesis> found = candidates(frame, {}, all);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front().evidence.fit.visible_fraction, 0.0F);
}

TEST(Candidates, NoClassOffersMoreThanItMay) {
  RgbdFrame frame = toy::background(77);
  toy::put_tile(0, 80, 119.5, 0.7, frame);
  toy::put_tile(0, 240, 119.5, 0.7, frame);
  const auto stripes = [&](int candidates_per_class) {
    DetectionSettings settings;
    settings.voting.candidates_per_class = candidates_per_class;
    const std::vector<ScoredHypothesis> found = candidates(frame, settings);
    return std::count_if(found.begin(), found.end(),
                         [](const ScoredHypothesis& c) { return c.detection.class_id == 1; });
  };
  EXPECT_GE(stripes(20), 2);
  EXPECT_EQ(stripes(1), 1);
}

TEST(Candidates, OnlyTheMostPromisingAreCompared) {
  RgbdFrame frame = toy::background(77);
  toy::put_tile(0, 80, 119.5, 0.7, frame);
  toy::put_tile(0, 240, 119.5, 0.7, frame);
  const std::vector<ScoredHypothesis> all = candidates(frame);
  ASSERT_GT(all.size(), 2U);
  std::vector<double> promises;
  for (const ScoredHypothesis& found : all) promises.push_back(vote_logit(found.evidence));
  std::sort(promises.begin(), promises.end(), std::greater<>());
  DetectionSettings settings;
  settings.evidence.max_compared = 2;
  const std::vector<ScoredHypothesis> two = candidates(frame, settings);
  ASSERT_EQ(two.size(), 2U);
  for (const ScoredHypothesis& found : two) EXPECT_GE(vote_logit(found.evidence), promises[1]);
}

TEST(Candidates, OnlyTheLikeliestAreRefined) {
  RgbdFrame frame = toy::background(77);
  toy::put_tile(0, 159.5, 119.5, 0.7, frame);
  const auto count_refined = [&](int max_refined) {
    DetectionSettings settings;
    settings.evidence.max_refined = max_refined;
    const std::vector<ScoredHypothesis> found = candidates(frame, settings);
    return std::count_if(found.begin(), found.end(), [](const ScoredHypothesis& c) {
      return c.evidence.alternative_scale_gain != Evidence{}.alternative_scale_gain;
    });
  };
  EXPECT_GE(count_refined(1000), 1);
  EXPECT_EQ(count_refined(1), 1);
  EXPECT_EQ(count_refined(0), 0);
}

/// Returns the middle of the toy view alone, as if another side of the object looked like it.
ViewTemplate middle_part() {
  const TrainingView whole = toy::training_views().front();
  const cv::Rect box = cv::boundingRect(whole.mask);
  const cv::Rect part(box.x + box.width / 4, box.y + box.height / 4, box.width / 2, box.height / 2);
  cv::Mat mask = cv::Mat::zeros(whole.mask.size(), CV_8U);
  whole.mask(part).copyTo(mask(part));
  ViewTemplate view = toy::template_view();
  for (float& side : view.box) side *= 0.5F;
  view.R_ray_object = Eigen::AngleAxisf(1.0F, Eigen::Vector3f::UnitX());
  view.appearance = make_template_grid(whole.frame, mask, part, {0.0F, 0.0F, toy::kDistance});
  return view;
}

/// Holds what the votes at the toy view's position say.
struct ToyVotes {
  std::vector<std::pair<std::uint32_t, float>> views;
  float mass = 1.0F;      ///< over the nominal one
  float beside_m = 0.0F;  ///< how far to the right of the object's middle they meet
};

/// Returns the evidence at the toy view's position from its template, view 0, and that of its middle part, view 1, for
/// a class of so many views. The others, which show nothing, are the neighbours of both.
Evidence evidence_among(std::size_t views, const RgbdFrame& frame, const ToyVotes& votes = {{{0, 0.5F}, {1, 0.5F}}}) {
  Forest forest;
  forest.classes.emplace_back().radius = 0.08F;
  forest.views = {toy::template_view(), middle_part()};
  for (std::size_t i = 2; i < views; ++i)
    forest.views.emplace_back().R_ray_object = ViewTemplate(forest.views[i % 2]).R_ray_object;
  std::vector<std::uint32_t> without_appearance(views - 2);
  std::iota(without_appearance.begin(), without_appearance.end(), 2U);
  const ForestIndex index(forest);
  Hypothesis hypothesis;
  hypothesis.centre_camera = {votes.beside_m, 0.0F, toy::kDistance};
  hypothesis.vote_mass = votes.mass * forest.classes.front().nominal_vote_mass;
  hypothesis.weight = 1.0F;
  hypothesis.views = votes.views;
  ScoringWorkspace workspace;
  const ScoringInput input{index, toy::lab_frame(frame, frame.colour, 1.0F), {}, {}, without_appearance};
  const std::vector<Hypothesis> hypotheses = {hypothesis};
  return score_by_group({{input, hypotheses}}, 1, workspace).front().front().evidence;
}

TEST(Candidates, APartThatAgreesBetterIsNotTakenForTheWholeInAnotherAttitude) {
  TrainingView seen = toy::training_views().front();
  const cv::Rect box = cv::boundingRect(seen.mask);
  const cv::Size quarter(box.width, box.height / 4);
  for (const int above : {0, box.height * 3 / 4}) {  // something stands in front of all but the part
    seen.frame.depth(cv::Rect(cv::Point(box.x, box.y + above), quarter)).setTo(0.4F);
  }
  EXPECT_LT(evidence_among(2, seen.frame).fit.visible_box_px.width, 0.6F * static_cast<float>(box.width))
      << "of one attitude's views the best is climbed from";
  EXPECT_GT(evidence_among(400, seen.frame).fit.visible_box_px.width, 0.9F * static_cast<float>(box.width));
}

TEST(Candidates, AnAttitudeThatNoVoteRemembersIsFoundWhereTheVotesAreMany) {
  const TrainingView seen = toy::training_views().front();
  EXPECT_EQ(evidence_among(400, seen.frame, {{{1, 1.0F}}, 0.5F}).view, 0U);
  EXPECT_EQ(evidence_among(400, seen.frame, {{{1, 1.0F}}, 0.2F}).view, 1U) << "most maxima have few votes";
}

TEST(Candidates, VotesThatMeetBesideTheMiddleFindTheObject) {
  const TrainingView seen = toy::training_views().front();
  for (const float beside_m : {-0.025F, 0.025F}) {
    const Evidence found = evidence_among(400, seen.frame, {{{1, 1.0F}}, 2.0F, beside_m});
    EXPECT_EQ(found.view, 0U) << beside_m;
    EXPECT_NEAR(found.view_centre.x(), 0.0F, 0.005F);
    EXPECT_GT(found.fit.visible_fraction, 0.95F);
  }
}

TEST(Candidates, WhatLiesOnTheSurfaceOfASureOneIsDropped) {
  Forest forest;
  forest.classes = {ObjectClass(), ObjectClass()};
  for (ObjectClass& object : forest.classes) object.radius = 0.08F;
  forest.views = {toy::template_view(), middle_part()};
  forest.views[1].class_index = 1;
  const ForestIndex index(forest);
  std::vector<Hypothesis> hypotheses(2);  // an object, and another one with few votes that looks like its middle
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    hypotheses[i].class_index = i;
    hypotheses[i].centre_camera = {0.0F, 0.0F, toy::kDistance};
    hypotheses[i].vote_mass = (i == 0 ? 2.0F : 0.01F) * forest.classes[i].nominal_vote_mass;
    hypotheses[i].weight = 1.0F;
    hypotheses[i].views = {{static_cast<std::uint32_t>(i), 1.0F}};
  }
  const RgbdFrame frame = toy::training_views().front().frame;
  const auto scores = [&](float explains_from) {
    EvidenceSettings settings;
    settings.explains_from = explains_from;
    ScoringWorkspace workspace;
    const ScoringInput input{index, toy::lab_frame(frame, frame.colour, 1.0F), {}, settings, {}};
    std::vector<float> found;
    const GroupCandidates by_group = score_by_group({{input, hypotheses}}, 1, workspace);
    for (const ScoredHypothesis& one : by_group.front()) found.push_back(one.detection.score);
    return found;
  };
  const std::vector<float> both = scores(2.0F);
  ASSERT_EQ(both.size(), 2U);
  ASSERT_GT(both[0], 0.5F);
  ASSERT_LT(both[1], 0.5F);
  EXPECT_EQ(scores(both[0]), std::vector<float>{both[0]});
  EXPECT_EQ(scores(both[0] + 0.01F), both) << "it is not sure enough";
}

}  // namespace
}  // namespace houghstream
