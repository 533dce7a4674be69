#include "detector/training/score_training.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <set>

#include "detector/evidence/score.hpp"
#include "detector/training/forest_trainer.hpp"
#include "tests/detector/listed_terms.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream::training {
namespace {

struct Toys {
  std::vector<TrainingView> views = toy::training_views();
  std::vector<const TrainingView*> objects;
  std::vector<const TrainingView*> backgrounds;
  Toys() {
    for (const TrainingView& view : views) (view.class_id == 0 ? backgrounds : objects).push_back(&view);
  }
};

const std::set<int> kClasses = {1, 2};

Forest with_score_trained(const Toys& toys, Forest forest, int threads) {
  Profile profile = toy::quick_profile();
  profile.training.validation_frames = 16;
  profile.training.threads = threads;
  const ValidationSource source = composed_frames(toys.objects, toys.backgrounds, profile.training);
  fit_scores(find_score_examples(source, 0, profile, forest), kClasses, forest);
  return forest;
}

TEST(ScoreTraining, GivesAFullySeenObjectMuchAndNothingLittle) {
  const Toys toys;
  const Forest forest = with_score_trained(toys, train_forest(toys.views, toy::quick_profile(), [](auto&) {}), 2);
  Evidence whole;
  whole.relative_vote_mass = 1.0F;
  whole.fit.visible_fraction = 1.0F;
  whole.fit.colour_correlation = 0.8F;
  Evidence wall;
  wall.relative_vote_mass = 0.03F;
  wall.fit.visible_fraction = 1.0F;
  wall.fit.rim_continuation = 1.0F;
  wall.alternative_scale_gain = 0.0F;  // it looks the same in any size
  BoundarySample continued;            // and goes on beyond the outline
  continued.expected_depth_change = continued.depth_change;
  wall.outline.add(continued, 0.01F);
  for (const ObjectClass& object : forest.classes) {
    EXPECT_GT(score(object.score_model, whole), 0.8F) << object.name;
    EXPECT_LT(score(object.score_model, wall), 0.1F) << object.name;
  }
}

/// Rooms in which depth is missing here and there, as it is of what shines or is dark.
void leave_depth_in_discs(std::vector<TrainingView>& views) {
  constexpr int kApart = 30;
  for (TrainingView& view : views) {
    if (view.class_id != 0) continue;
    cv::Mat kept = cv::Mat::zeros(view.frame.depth.size(), CV_8UC1);
    for (int y = 0; y < kept.rows; y += kApart) {
      for (int x = 0; x < kept.cols; x += kApart) cv::circle(kept, {x, y}, 9, 255, cv::FILLED);
    }
    view.frame.depth.setTo(std::numeric_limits<float>::quiet_NaN(), kept == 0);
  }
}

TEST(ScoreTraining, MissingDepthIsNoMarkOfTheBackground) {
  Toys toys;
  leave_depth_in_discs(toys.views);
  const Forest forest = with_score_trained(toys, train_forest(toys.views, toy::quick_profile(), [](auto&) {}), 2);
  Evidence dazzled;
  dazzled.relative_vote_mass = 0.3F;
  dazzled.fit.visible_fraction = 0.15F;
  dazzled.fit.no_depth_fraction = 0.85F;
  dazzled.fit.colour_correlation = 0.6F;
  for (const ObjectClass& object : forest.classes) {
    EXPECT_GT(score(object.score_model, dazzled), 0.6F) << object.name;
  }
}

TEST(ScoreTraining, AnyNumberOfThreadsGivesTheSameModel) {
  const Toys toys;
  const Forest forest = train_forest(toys.views, toy::quick_profile(), [](auto&) {});
  const Forest serial = with_score_trained(toys, forest, 1);
  const Forest parallel = with_score_trained(toys, forest, 3);
  for (std::size_t c = 0; c < serial.classes.size(); ++c) {
    EXPECT_EQ(listed(serial.classes[c].score_model.weights), listed(parallel.classes[c].score_model.weights));
  }
}

/// Returns an image that is not composed of views: a tile of each kind in a room; `is_there` says whether the ground
/// truth names them.
ValidationFrame tiles_on_a_background(int index, bool is_there) {
  ValidationFrame frame;
  frame.frame = toy::background(50 + static_cast<std::uint64_t>(index));
  for (const int kind : {0, 1}) {
    const cv::Mat mask = toy::put_tile(kind, 90.0 + 130.0 * kind, 110.0 + 20.0 * index, 0.7, frame.frame);
    if (is_there) frame.objects.push_back({kind + 1, {}, cv::boundingRect(mask), 1.0});
  }
  return frame;
}

Evidence of_a_tile() {
  Evidence evidence;
  evidence.relative_vote_mass = 1.0F;
  evidence.fit.visible_fraction = 1.0F;
  evidence.fit.colour_correlation = 0.8F;
  return evidence;
}

TEST(ScoreTraining, LearnsFromAnySourceOfFrames) {
  const Toys toys;
  Profile profile = toy::quick_profile();
  profile.training.validation_frames = 3;
  const Forest taught = train_forest(toys.views, profile, [](auto&) {});
  std::array<Forest, 2> forests = {taught, taught};
  for (const bool is_there : {false, true}) {
    std::array<std::atomic<int>, 2> asked{};
    const ValidationSource source{2, [&](int index) {
                                    ++asked.at(static_cast<std::size_t>(index));
                                    return tiles_on_a_background(index, is_there);
                                  }};
    Forest& forest = forests[is_there ? 1 : 0];
    fit_scores(find_score_examples(source, 0, profile, forest), {1}, forest);
    EXPECT_EQ(asked[0], 1);
    EXPECT_EQ(asked[1], 1);
  }
  for (std::size_t c = 0; c < taught.classes.size(); ++c) {
    const ScoreModel& without = forests[0].classes[c].score_model;
    const ScoreModel& with = forests[1].classes[c].score_model;
    if (taught.classes[c].class_id == 1) {
      EXPECT_GT(score(with, of_a_tile()), score(without, of_a_tile()) + 0.05F);
    } else {  // not asked for
      EXPECT_EQ(listed(with.weights), listed(taught.classes[c].score_model.weights));
    }
  }
}

/// The examples are labelled by the object's mass alone, whose log odds the model gives: many are false, whatever it
/// says.
std::vector<ScoreExamples> judged_by_mass(int class_id, double log_odds, double offset) {
  std::vector<ScoreExamples> frames;
  Random random(7);
  for (int i = 0; i < 4000; ++i) {
    const double odds = random.uniform(-3.0, 3.0);
    ScoreExample example;
    example.terms.log_vote_mass = static_cast<float>(odds / log_odds);
    example.is_object = random.uniform() < 1.0 / (1.0 + std::exp(-(odds + offset)));
    frames.push_back({{class_id, {example}}});
  }
  return frames;
}

TEST(ScoreTraining, CalibratedScoresAreRightAsOftenAsTheySayAndKeepTheirOrder) {
  constexpr double kOfMass = 2.0;
  constexpr double kFewer = -1.5;
  Forest forest;
  forest.classes = {{1, "mug", 0.1F, 1.0F, {}}, {2, "older", 0.1F, 1.0F, {}}};
  for (ObjectClass& object : forest.classes) {
    object.score_model.weights = {};
    object.score_model.weights.log_vote_mass = kOfMass;
  }
  scale_log_odds(judged_by_mass(1, kOfMass, kFewer), {1}, forest);
  const ScoreTerms& weights = forest.classes[0].score_model.weights;
  EXPECT_NEAR(weights.constant, kFewer, 0.15);
  EXPECT_NEAR(weights.log_vote_mass, kOfMass, 0.2);
  EXPECT_EQ(forest.classes[1].score_model.weights.log_vote_mass, static_cast<float>(kOfMass));  // was not asked for
  EXPECT_EQ(forest.classes[1].score_model.weights.constant, 0.0F);
}

TEST(ScoreTraining, WithoutExamplesScoresStayAsTheyAre) {
  Forest forest;
  ObjectClass& mug = forest.classes.emplace_back();
  mug.class_id = 1;
  mug.name = "mug";
  mug.radius = 0.1F;
  const ScoreTerms before = forest.classes[0].score_model.weights;
  scale_log_odds({}, {1}, forest);
  EXPECT_EQ(listed(forest.classes[0].score_model.weights), listed(before));
}

}  // namespace
}  // namespace houghstream::training
