#include "detector/training/score_training.hpp"

#include <gtest/gtest.h>

#include "detector/evidence/score.hpp"
#include "detector/training/forest_trainer.hpp"
#include "toy_data.hpp"

namespace houghstream {
namespace {

struct Toys {
  std::vector<TrainingView> views = toy::training_views();
  std::vector<const TrainingView*> objects;
  std::vector<const TrainingView*> rooms;
  Toys() {
    for (const TrainingView& view : views) (view.class_id == 0 ? rooms : objects).push_back(&view);
  }
};

Forest with_score_trained(const Toys& toys, Forest forest, int threads) {
  Profile profile = toy::quick_profile();
  profile.training.validation_frames = 16;
  profile.training.threads = threads;
  train_score_model(toys.objects, toys.rooms, profile, forest);
  return forest;
}

TEST(ScoreTraining, GivesAFullySeenObjectMuchAndNothingLittle) {
  const Toys toys;
  const Forest forest = with_score_trained(toys, train_forest(toys.views, toy::quick_profile(), [](auto&) {}), 2);
  Evidence whole;
  whole.mass_share = 1.0F;
  whole.fit.visible = 1.0F;
  whole.fit.likeness = 0.8F;
  Evidence wall;
  wall.mass_share = 0.03F;
  wall.fit.visible = 1.0F;
  wall.fit.continued = 1.0F;
  for (const ObjectClass& object : forest.classes) {
    EXPECT_GT(score(object.score_model, whole), 0.8F) << object.name;
    EXPECT_LT(score(object.score_model, wall), 0.1F) << object.name;
  }
}

TEST(ScoreTraining, AnyNumberOfThreadsGivesTheSameModel) {
  const Toys toys;
  const Forest forest = train_forest(toys.views, toy::quick_profile(), [](auto&) {});
  const Forest serial = with_score_trained(toys, forest, 1);
  const Forest parallel = with_score_trained(toys, forest, 3);
  for (std::size_t c = 0; c < serial.classes.size(); ++c) {
    EXPECT_EQ(serial.classes[c].score_model.weights, parallel.classes[c].score_model.weights);
  }
}

}  // namespace
}  // namespace houghstream
