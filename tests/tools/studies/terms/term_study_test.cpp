#include "tools/studies/terms/term_study.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace houghstream::terms {
namespace {

const cv::Rect kBox(100, 100, 80, 80);

NamedObject object(const std::string& name, double visible, const cv::Rect& box = kBox) {
  NamedObject out;
  out.class_name = name;
  out.truth.box_visible_px = box;
  out.truth.visible_fraction = visible;
  return out;
}

ScoredHypothesis candidate(const std::string& name, const cv::Rect& box, float score, float likeness) {
  ScoredHypothesis out;
  out.detection.class_name = name;
  out.detection.box_px = box;
  out.detection.score = score;
  out.evidence.fit.colour_correlation = likeness;
  return out;
}

/// Returns a model of mugs that weighs colour_correlation by 2.
ModelsByClass mugs() {
  ScoreModel model;
  model.weights = {};
  model.weights.colour_correlation = 2.0F;
  return {{"mug", model}};
}

EvaluatedFrame frame(std::vector<NamedObject> objects) {
  EvaluatedFrame out;
  out.objects = std::move(objects);
  return out;
}

TermFigures figures_of(const std::vector<Sample>& samples, const std::string& term) {
  for (const TermFigures& figures : term_figures(samples)) {
    if (figures.term == term) return figures;
  }
  return {};
}

TEST(TermStudy, AnObjectsStrongestCandidateStandsForIt) {
  Group group;
  add_frame(
      frame({object("mug", 0.6), object("mug", 0.4, {300, 100, 80, 80}), object("plate", 1.0)}),
      {candidate("mug", kBox, 0.2F, 0.1F), candidate("mug", kBox, 0.4F, 0.5F), candidate("can", kBox, 0.9F, 0.9F)},
      mugs(), {}, group);
  EXPECT_EQ(group.frames, 1);
  EXPECT_EQ(group.objects, 1) << "not the hidden one, and no class that the forest does not know";
  EXPECT_EQ(group.with_candidate, 1);
  ASSERT_EQ(group.true_positives.size(), 1U);
  EXPECT_EQ(group.true_positives[0].score, 0.4F);
  EXPECT_EQ(group.true_positives[0].terms.colour_correlation, 0.5F);
  EXPECT_EQ(group.true_positives[0].contributions.colour_correlation, 1.0F);
  EXPECT_EQ(group.true_positives[0].contributions.log_vote_mass, 0.0F);
}

TEST(TermStudy, AMissedObjectHasNoCandidate) {
  Group group;
  add_frame(frame({object("mug", 1.0)}), {candidate("mug", {300, 100, 80, 80}, 0.2F, 0.1F)}, mugs(), {}, group);
  EXPECT_EQ(group.objects, 1);
  EXPECT_EQ(group.with_candidate, 0);
  EXPECT_TRUE(group.true_positives.empty());
}

TEST(TermStudy, FalseIsWhatSuppressionLeavesAndTheTruthLacks) {
  Group group;
  StudyRules rules;
  rules.false_score = 0.3F;
  add_frame(frame({object("mug", 1.0), object("mug", 0.05, {500, 100, 80, 80})}),
            {candidate("mug", {300, 100, 80, 80}, 0.6F, 0.3F), candidate("mug", {301, 100, 80, 80}, 0.5F, 0.2F),
             candidate("mug", {300, 300, 80, 80}, 0.2F, 0.1F), candidate("mug", {500, 100, 80, 80}, 0.9F, 0.7F),
             candidate("mug", kBox, 0.7F, 0.8F)},
            mugs(), rules, group);
  ASSERT_EQ(group.false_positives.size(), 1U) << "not the suppressed, the weak, the hardly visible and the true one";
  EXPECT_EQ(group.false_positives[0].terms.colour_correlation, 0.3F);
}

TEST(TermStudy, FiguresAreMediansAndMeans) {
  std::vector<Sample> samples(3);
  samples[0].terms.colour_correlation = 0.1F;
  samples[1].terms.colour_correlation = 0.2F;
  samples[2].terms.colour_correlation = 0.9F;
  samples[2].contributions.colour_correlation = 3.0F;
  const TermFigures figures = figures_of(samples, "colour_correlation");
  EXPECT_NEAR(figures.median, 0.2, 1e-6);
  EXPECT_NEAR(figures.mean, 0.4, 1e-6);
  EXPECT_NEAR(figures.contribution, 1.0, 1e-6);
  EXPECT_EQ(figures.contribution_median, 0.0);
  EXPECT_TRUE(std::isnan(figures_of({}, "colour_correlation").mean));
}

TEST(TermStudy, EachTermHasItsOwnName) {
  Sample sample;
  for (std::size_t i = 0; i < kScoreTerms; ++i) sample.terms.*kScoreTermList[i] = static_cast<float>(i);
  EXPECT_EQ(figures_of({sample}, "log_vote_mass").median, static_cast<double>(sample.terms.log_vote_mass));
  EXPECT_EQ(figures_of({sample}, "log_certainty").median, static_cast<double>(sample.terms.log_certainty));
  EXPECT_EQ(figures_of({sample}, "depth_residual_sq").median, static_cast<double>(sample.terms.depth_residual_sq));
}

TEST(TermStudy, WhatPushesDownMostComesFirst) {
  Sample rendered;
  rendered.contributions.colour_correlation = 3.0F;
  rendered.contributions.log_certainty = -1.0F;
  Sample recorded;
  recorded.contributions.constant = -9.0F;
  recorded.contributions.colour_correlation = 2.0F;
  recorded.contributions.log_certainty = -5.0F;
  const std::vector<TermShift> shifts = shifts_between({rendered}, {recorded});
  ASSERT_EQ(shifts.size(), kScoreTerms - 1);
  EXPECT_EQ(shifts[0].term, "log_certainty");
  EXPECT_NEAR(shifts[0].shift, -4.0, 1e-6);
  EXPECT_EQ(shifts[1].term, "colour_correlation");
  EXPECT_TRUE(shifts_between({rendered}, {}).empty());
}

TEST(TermStudy, TableAndJsonHaveTheGroupsSideBySide) {
  std::vector<Group> groups(2);
  groups[0].name = "rendered";
  groups[1].name = "cat";
  for (Group& group : groups) {
    add_frame(frame({object("mug", 1.0)}), {candidate("mug", kBox, 0.8F, group.name == "cat" ? 0.25F : 0.75F)}, mugs(),
              {}, group);
  }
  const std::string text = table(groups, {});
  EXPECT_NE(text.find("colour_correlation             0.75   1.50      -      -   0.25   0.50"), std::string::npos)
      << text;
  EXPECT_NE(text.find("true ones of cat against rendered: colour_correlation -1.00"), std::string::npos) << text;
  const OrderedJson json = to_json(groups, {});
  EXPECT_EQ(json["cat"]["true"]["colour_correlation"]["contribution"], 0.5);
  EXPECT_EQ(json["rendered"]["reported"], 1);
  EXPECT_TRUE(json["rendered"]["false"]["colour_correlation"]["median"].is_null());
}

}  // namespace
}  // namespace houghstream::terms
