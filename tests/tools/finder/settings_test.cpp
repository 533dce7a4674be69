#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "detector/detection_settings.hpp"
#include "detector/features/feature_settings.hpp"
#include "detector/training/training_settings.hpp"
#include "pipeline/base/check_settings.hpp"
#include "pose/following/object_follower.hpp"
#include "pose/pose_settings.hpp"
#include "pose/tracks/tracker.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

template <typename Value>
std::vector<Value> values_outside(double min, double max) {
  std::vector<Value> values;
  if constexpr (std::is_floating_point_v<Value>) {
    constexpr Value kInfinity = std::numeric_limits<Value>::infinity();
    values = {std::numeric_limits<Value>::quiet_NaN(), std::nextafter(static_cast<Value>(min), -kInfinity)};
    if (std::isfinite(max)) values.push_back(std::nextafter(static_cast<Value>(max), kInfinity));
  } else {
    if (std::is_signed_v<Value> || min > 0.0) values.push_back(static_cast<Value>(min) - 1);
    values.push_back(static_cast<Value>(max) + 1);
  }
  return values;
}

/// Calls `check` with the default settings of each stage; those of all others are within them.
template <typename Check>
void with_all_settings(const Check& check) {
  check(FeatureSettings());
  check(PatchSettings());
  check(DetectionSettings());
  check(training::TrainingSettings());
  check(PoseSettings());
  check(FollowerSettings());
  check(tracks::ObjectTrackerSettings());
}

TEST(SettingsLists, TheDefaultsAreWithinTheirRanges) {
  with_all_settings([](const auto& settings) { EXPECT_NO_THROW(check_settings(settings, "defaults")); });
}

TEST(SettingsLists, EveryNumberOutOfItsRangeIsRefusedInOneLine) {
  int numbers = 0;
  with_all_settings([&](auto settings) {
    for_each_number(settings, [&](const auto& field, auto& value) {
      using Value = std::decay_t<decltype(value)>;
      const Value usual = value;
      for (const Value outside : values_outside<Value>(field.min, field.max)) {
        value = outside;
        const std::string error = error_of([&] { check_settings(settings, "somebody's file"); });
        expect_says(error, {"somebody's file: ", fmt::format("{} {}, expected {}", field.name, outside, field.min)});
      }
      value = usual;
      ++numbers;
    });
  });
  EXPECT_GT(numbers, 150);
}

TEST(SettingsLists, TheEndsOfARangeAreInIt) {
  with_all_settings([](auto settings) {
    for_each_number(settings, [](const auto& field, auto& value) {
      using Value = std::decay_t<decltype(value)>;
      EXPECT_NO_THROW(check_number(field, static_cast<Value>(field.min), "a file"));
      if (std::isfinite(field.max)) value = static_cast<Value>(field.max);
      EXPECT_NO_THROW(check_number(field, value, "a file"));
    });
  });
}

TEST(SettingsRanges, AnOptionHasTheRangeOfItsMember) {
  EXPECT_EQ(range_of(&EvidenceSettings::threshold).max, 1.0);
  EXPECT_EQ(range_of(&training::TrainingSettings::max_depth).max, 60.0);
  EXPECT_EQ(range_of(&training::TrainingSettings::min_distance).min, 0.05) << "of the pictures, whose list it is in";
  EXPECT_THROW(range_of(&training::TrainingSettings::seed), std::logic_error) << "any number is a seed";
}

TEST(SettingsRanges, TheQualityOfASingleClassIsCheckedToo) {
  PoseSettings settings;
  settings.class_quality["mug"].weights.visible = std::numeric_limits<double>::quiet_NaN();
  expect_says(error_of([&] { check_settings(settings, "pose settings"); }),
              {"pose settings: quality of 'mug': weights: visible nan, expected -1000000 to 1000000"});
}

}  // namespace
}  // namespace houghstream
