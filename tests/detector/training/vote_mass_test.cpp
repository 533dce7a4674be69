#include "detector/training/vote_mass.hpp"

#include <gtest/gtest.h>

#include "detector/forest/forest.hpp"
#include "detector/training/tree_trainer.hpp"

namespace houghstream::training {
namespace {

constexpr float kArea = 0.02F;
constexpr float kSigma = 0.016F;

/// Returns two classes; the samples of class 0 see their centre at (0.05, 0, 0). Class 1 has no sample.
TrainingSet set_of(int images) {
  TrainingSet set;
  set.classes.resize(2);
  set.visible_areas = {kArea, 0.5F};
  for (int i = 0; i < images; ++i) {
    const FeatureImage image(2, 2, set.layout.pixel_stride());
    set.cutouts.emplace_back(image, spans_of(image.held()));
    TrainingSample sample;
    sample.image = i;
    sample.cutout = i;
    sample.label = 1;
    sample.offset = {0.05F, 0, 0};
    set.samples.push_back(sample);
    sample.label = 0;
    set.samples.push_back(sample);
  }
  return set;
}

/// Trees of one leaf each that believe in class 0 by 0.6 and cast half their votes `miss` beside its centre.
Forest forest_of(int trees, float miss) {
  Forest forest;
  forest.classes.resize(2);
  forest.roots.assign(static_cast<std::size_t>(trees), -1);
  forest.leaves = {0, 1};
  LeafClass entry;
  entry.probability = 0.6F;
  entry.vote_count = 2;
  forest.leaf_classes.push_back(entry);
  forest.votes = {{{0.05F, 0, 0}, 0.5F}, {{0.05F + miss, 0, 0}, 0.5F}};
  return forest;
}

std::vector<float> masses(const TrainingSet& set, const TrainingSettings& settings, Forest forest) {
  estimate_nominal_vote_mass(set, settings, kSigma, forest);
  return {forest.classes[0].nominal_vote_mass, forest.classes[1].nominal_vote_mass};
}

TEST(Calibration, VotesThatHitTheCentreGiveTheVisibleAreaTimesTheProbability) {
  TrainingSettings settings;
  settings.in_bag = 0.0;
  EXPECT_NEAR(masses(set_of(5), settings, forest_of(3, 0.0F))[0], kArea * 0.6F, 1e-6F);
}

TEST(Calibration, VotesThatMissAddNothing) {
  TrainingSettings settings;
  settings.in_bag = 0.0;
  EXPECT_NEAR(masses(set_of(5), settings, forest_of(3, 1.0F))[0], kArea * 0.3F, 1e-6F);
}

TEST(Calibration, WithoutHeldOutSamplesTheVisibleAreaIsTheMeasure) {
  TrainingSettings settings;
  settings.in_bag = 1.0;
  EXPECT_FLOAT_EQ(masses(set_of(5), settings, forest_of(3, 0.0F))[0], kArea);
  EXPECT_FLOAT_EQ(masses(set_of(5), settings, forest_of(3, 0.0F))[1], 0.5F);
}

TEST(Calibration, OnlyImagesThatTheTreeDidNotLearnFromCount) {
  TrainingSettings settings;
  settings.in_bag = 0.5;
  TrainingSet set = set_of(40);
  for (TrainingSample& sample : set.samples) {  // a tree would know nothing of its own images' centres
    if (in_bag(settings, 0, sample.image)) sample.offset = {3, 3, 3};
  }
  EXPECT_NEAR(masses(set, settings, forest_of(1, 0.0F))[0], kArea * 0.6F, 1e-6F);
}

TEST(Calibration, AnyNumberOfThreadsGivesTheSame) {
  TrainingSettings settings;
  settings.in_bag = 0.5;
  settings.threads = 1;
  const std::vector<float> serial = masses(set_of(7), settings, forest_of(5, 0.01F));
  settings.threads = 3;
  EXPECT_EQ(serial, masses(set_of(7), settings, forest_of(5, 0.01F)));
}

/// Makes a set in which half of the object's patches reach leaves with one probability, half leaves with another.
Forest giving(float one, float other) {
  Forest forest;
  forest.classes.resize(2);
  forest.classes[0].class_id = 3;
  forest.classes[1].class_id = 8;
  for (ObjectClass& object : forest.classes) object.nominal_vote_mass = 12.0F;
  forest.leaves = {0, 1, 2};
  forest.leaf_weights = {1.0F / one, 1.0F / other};
  forest.leaf_classes.resize(2);
  for (LeafClass& entry : forest.leaf_classes) entry.class_index = 1;
  forest.leaf_classes[0].probability = one;
  forest.leaf_classes[1].probability = other;
  return forest;
}

TEST(Calibration, MassesFollowTheProbabilitiesWhereOthersWereAdded) {
  Forest after = giving(0.4F, 0.2F);
  rescale_nominal_vote_mass(giving(0.6F, 0.4F), after);
  EXPECT_NEAR(after.classes[1].nominal_vote_mass, 12.0F * 0.3F / 0.5F, 1e-5F);
  EXPECT_EQ(after.classes[0].nominal_vote_mass, 12.0F) << "of which no leaf knows anything";
}

}  // namespace
}  // namespace houghstream::training
