#include "drivers/store/precision_thresholds.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/log_line.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream::store {
namespace {

ObjectStore practised_store() {
  ObjectStore store;
  store.folder = "/some/store";
  for (const char* name : {"mug", "bowl", "wardrobe"}) {
    StoredObject& object = store.objects.emplace_back();
    object.name = name;
    object.practice = PracticeRecord();
  }
  store.objects[0].practice->shown = 200;
  store.objects[0].practice->scores = {{0.7, 150, 0}, {0.2, 160, 90}};
  store.objects[0].practice->qualities = {{0.55, 140, 0}};
  store.objects[1].practice->shown = 20;
  store.objects[1].practice->scores = {{0.8, 9, 0}, {0.3, 12, 8}};
  store.objects[1].practice->qualities = {{0.5, 8, 1}};
  return store;
}

TEST(PrecisionThresholds, EachObjectHasThoseOfItsOwnPractice) {
  const std::map<std::string, float> scores = thresholds_for_precision(practised_store(), PracticeMeasure::kScore, 0.9);
  ASSERT_EQ(scores.size(), 2U) << "nothing is known of the wardrobe";
  EXPECT_EQ(scores.at("mug"), 0.7F);
  EXPECT_EQ(scores.at("bowl"), 0.8F);
  EXPECT_EQ(thresholds_for_precision(practised_store(), PracticeMeasure::kQuality, 0.9).at("mug"), 0.55F);
  EXPECT_EQ(thresholds_for_precision(practised_store(), PracticeMeasure::kScore, 0.6).at("mug"), 0.2F);
}

TEST(PrecisionThresholds, WhoDoesNotReachItIsNamedWithTheBest) {
  start_log("drivers_tests", LogLevel::kInfo);
  testing::internal::CaptureStderr();
  const std::map<std::string, float> scores =
      thresholds_for_precision(practised_store(), PracticeMeasure::kScore, 0.98);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(scores.at("bowl"), 0.8F) << "the best that there is";
  EXPECT_NE(said.find("bowl: precision 0.950 from score 0.80 on is the best in practice, expected 0.98"),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("wardrobe: not found in practice"), std::string::npos) << said;
  EXPECT_EQ(said.find("mug"), std::string::npos) << said;
}

TEST(PrecisionThresholds, AStoreWithoutPracticeNamesTheCommandThatLearnsIt) {
  ObjectStore old = practised_store();
  old.objects[0].practice.reset();
  old.objects[2].practice.reset();
  expect_says(error_of([&] { thresholds_for_precision(old, PracticeMeasure::kScore, 0.98); }),
              {"/some/store/store.json", "mug, wardrobe", "'hs-teach practise /some/store' learns it"});
  expect_says(error_of([&] { thresholds_for_precision(practised_store(), PracticeMeasure::kScore, 1.5); }),
              {"precision 1.5, expected 0 to 0.9999"});
}

}  // namespace
}  // namespace houghstream::store
