#include "drivers/store/practice_record.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream::store {
namespace {

std::vector<JudgedValue> judged(std::initializer_list<std::pair<double, bool>> values) {
  std::vector<JudgedValue> all;
  for (const auto& [value, is_right] : values) all.push_back({value, is_right});
  return all;
}

void expect_step(const PracticeStep& step, double from, int right, int wrong) {
  EXPECT_NEAR(step.from, from, 1e-9);
  EXPECT_EQ(step.right, right) << "from " << from;
  EXPECT_EQ(step.wrong, wrong) << "from " << from;
}

TEST(PracticeCurve, ThresholdsBetweenWhichTheFractionOfRightOnesFallsRemain) {
  std::vector<JudgedValue> values =
      judged({{0.91234, true}, {0.8, false}, {0.7, true}, {0.6, true}, {0.5, false}, {0.5, true}, {0.3, false}});
  const PracticeCurve curve = make_practice_curve(values);
  ASSERT_EQ(curve.size(), 4U) << "of 0.8 and 0.7 the lower one is more often right";
  expect_step(curve[0], 0.9123, 1, 0);
  expect_step(curve[1], 0.6, 3, 1);
  expect_step(curve[2], 0.5, 4, 2);
  expect_step(curve[3], 0.3, 4, 3);
  std::reverse(values.begin(), values.end());
  const PracticeCurve again = make_practice_curve(values);
  ASSERT_EQ(again.size(), curve.size());
  for (std::size_t i = 0; i < curve.size(); ++i) expect_step(again[i], curve[i].from, curve[i].right, curve[i].wrong);
  EXPECT_TRUE(make_practice_curve({}).empty());
}

TEST(PracticeCurve, APrecisionFromFewCountsIsNeverCertain) {
  EXPECT_EQ(estimate_precision(0, 0), 0.5);
  EXPECT_NEAR(estimate_precision(5, 0), 5.5 / 6.0, 1e-12);
  EXPECT_LT(estimate_precision(24, 0), estimate_precision(25, 0));
  EXPECT_LT(estimate_precision(100000, 0), 1.0);
  EXPECT_GT(estimate_precision(0, 9), 0.0);
}

TEST(PracticeCurve, TheLowestThresholdOfAPrecisionIsChosenOrTheBestThatThereIs) {
  const PracticeCurve curve = {{0.9, 10, 0}, {0.7, 98, 1}, {0.5, 120, 5}, {0.3, 130, 40}};
  const OperatingThreshold at_98 = choose_threshold(curve, 200, 0.98);
  EXPECT_EQ(at_98.from, 0.7) << "ten right ones alone prove less than 98 of 99";
  EXPECT_TRUE(at_98.is_reached);
  EXPECT_NEAR(at_98.recall, 0.49, 1e-12);
  EXPECT_NEAR(at_98.precision, 98.5 / 100.0, 1e-12);
  EXPECT_EQ(choose_threshold(curve, 200, 0.9).from, 0.5);
  EXPECT_EQ(choose_threshold(curve, 200, 0.0).from, 0.3);
  const OperatingThreshold best = choose_threshold(curve, 200, 0.995);
  EXPECT_FALSE(best.is_reached);
  EXPECT_EQ(best.from, 0.7);
  EXPECT_FALSE(error_of([] { choose_threshold({}, 3, 0.5); }).empty());
}

TEST(PracticeCurve, PrecisionsThatNobodyCanHaveAreRefused) {
  for (const double none : {-0.1, 1.0, 98.0, std::numeric_limits<double>::quiet_NaN()})
    expect_says(error_of([&] { check_precision(none, "--precision"); }), {"--precision", "expected 0 to 0.9999"});
  for (const double some : {0.0, 0.98, kMaxPrecision})
    EXPECT_EQ(error_of([&] { check_precision(some, "--precision"); }), "");
}

PracticeRecord some_record() {
  PracticeRecord record;
  record.shown = 40;
  record.right = 30;
  record.wrong = 2;
  record.scores = {{0.8123, 20, 0}, {0.4, 33, 5}};
  record.qualities = {{0.9, 28, 1}};
  record.taken_for = {{"bowl", 3}, {"mug", 3}, {"can", 1}};
  record.by_distance = {{1.0, 30, 28}, {10.0, 10, 2}};
  record.by_visible = {{0.5, 12, 4}, {1.0, 28, 26}};
  return record;
}

TEST(PracticeRecord, ComesBackFromJsonAsItWas) {
  const std::string text = to_json(some_record()).dump();
  const PracticeRecord read = practice_from_json(nlohmann::json::parse(text), "a file");
  EXPECT_EQ(to_json(read).dump(), text);
  EXPECT_EQ(read.wrong, 2);
  EXPECT_EQ(read.scores[0].from, 0.8123);
  EXPECT_EQ(read.taken_for.at("can"), 1);
  EXPECT_EQ(read.by_distance[1].found, 2);
}

TEST(PracticeRecord, TheMostFrequentConfusionIsTheFirstOfEquals) {
  EXPECT_EQ(most_frequent_confusion(some_record()).name, "bowl");
  EXPECT_NEAR(most_frequent_confusion(some_record()).fraction, 3.0 / 40.0, 1e-12);
  EXPECT_EQ(most_frequent_confusion({}).name, "");
}

TEST(PracticeRecord, WhatIsNoCountIsRefusedNamingItsPlace) {
  const nlohmann::json whole = nlohmann::json::parse(to_json(some_record()).dump());
  const auto error_with = [&](const std::string& pointer, const nlohmann::json& value) {
    nlohmann::json json = whole;
    json[nlohmann::json::json_pointer(pointer)] = value;
    return error_of([&] { practice_from_json(json, "store.json object 2 'practice'"); });
  };
  EXPECT_EQ(error_with("/shown", 40), "");
  const std::vector<std::pair<std::string, nlohmann::json>> faults = {{"/shown", -1},
                                                                      {"/shown", "many"},
                                                                      {"/guess", 1},
                                                                      {"/score", 3},
                                                                      {"/score/right", {20}},
                                                                      {"/score/right/1", 19},
                                                                      {"/score/right/1", 33.5},
                                                                      {"/score/from/0", 1.5},
                                                                      {"/score/from/1", 0.9},
                                                                      {"/quality/wrong/0", -1},
                                                                      {"/taken_for", {1, 2}},
                                                                      {"/taken_for/bowl", "often"},
                                                                      {"/by_distance_m/found/1", 11},
                                                                      {"/by_visible/to/1", 0.4}};
  for (const auto& [pointer, value] : faults)
    expect_says(error_with(pointer, value), {"store.json object 2 'practice'", "expected"});
  for (const char* key : {"wrong", "quality", "by_visible"}) {
    nlohmann::json json = whole;
    json.erase(key);
    expect_says(error_of([&] { practice_from_json(json, "a file"); }), {"a file", key});
  }
}

}  // namespace
}  // namespace houghstream::store
