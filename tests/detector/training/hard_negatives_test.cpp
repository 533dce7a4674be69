#include "detector/training/hard_negatives.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/detector/planted_set.hpp"

namespace houghstream::training {
namespace {

TrainingSettings quick(int threads = 2) {
  TrainingSettings settings;
  settings.tests_per_node = 100;
  settings.threads = threads;
  return settings;
}

/// Returns a set with spare background: every background sample again, and `mistaken` patches that look like the
/// object.
TrainingSet spare_set(std::size_t mistaken) {
  TrainingSet set = toy::planted_set();
  std::vector<TrainingSample> like_object;
  for (const TrainingSample& sample : set.samples) {
    TrainingSample spare = sample;
    spare.label = 0;
    (sample.label == 0 ? set.negative_pool : like_object).push_back(spare);
  }
  for (std::size_t i = 0; i < mistaken; ++i) set.negative_pool.push_back(like_object[i % like_object.size()]);
  return set;
}

bool looks_like_object(const TrainingSample& sample) {
  return sample.image % 2 == 1;
}

TEST(HardNegatives, OnlyWhatIsMistakenForAnObjectIsAdded) {
  TrainingSet set = spare_set(100);
  const std::size_t before = set.samples.size();
  add_hard_negatives({}, quick(), set);
  ASSERT_EQ(set.samples.size(), before + 100);
  for (std::size_t i = before; i < set.samples.size(); ++i) {
    EXPECT_EQ(set.samples[i].label, 0);
    EXPECT_TRUE(looks_like_object(set.samples[i]));
  }
  EXPECT_TRUE(set.negative_pool.empty());
}

TEST(HardNegatives, AtMostAsManyAsThereIsBackground) {
  TrainingSet set = spare_set(1000);
  const auto background = std::count_if(set.samples.begin(), set.samples.end(),
                                        [](const TrainingSample& sample) { return sample.label == 0; });
  const std::size_t before = set.samples.size();
  add_hard_negatives({}, quick(), set);
  EXPECT_EQ(set.samples.size(), before + static_cast<std::size_t>(background));
}

TEST(HardNegatives, WithoutMistakesNothingIsAdded) {
  TrainingSet set = spare_set(0);
  const std::size_t before = set.samples.size();
  add_hard_negatives({}, quick(), set);
  EXPECT_EQ(set.samples.size(), before);
}

TEST(HardNegatives, AnyNumberOfThreadsChoosesTheSame) {
  TrainingSet serial = spare_set(9000);  // several blocks
  TrainingSet parallel = spare_set(9000);
  add_hard_negatives({}, quick(1), serial);
  add_hard_negatives({}, quick(3), parallel);
  ASSERT_EQ(serial.samples.size(), parallel.samples.size());
  for (std::size_t i = 0; i < serial.samples.size(); ++i) {
    ASSERT_EQ(serial.samples[i].image, parallel.samples[i].image);
    ASSERT_EQ(serial.samples[i].x, parallel.samples[i].x);
    ASSERT_EQ(serial.samples[i].y, parallel.samples[i].y);
  }
}

}  // namespace
}  // namespace houghstream::training
