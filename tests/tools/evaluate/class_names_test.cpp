#include "tools/evaluate/class_names.hpp"

#include <gtest/gtest.h>

#include "tests/test_files.hpp"

namespace houghstream {
namespace {

TEST(ClassNames, WhatSharesNoNameIsToldApartInOneLine) {
  const NamedSide forest{"the forest a", {"bowl", "mug"}};
  EXPECT_EQ(error_of([&] { require_shared_name(forest, {"the scene b", {"can", "mug"}}); }), "");
  EXPECT_EQ(error_of([&] {
              require_shared_name(forest, {"the scene b", {"object_1", "object_2"}});
            }),
            "no name in common: the forest a has bowl, mug; the scene b has object_1, object_2");
  EXPECT_EQ(error_of([&] {
              require_shared_name(forest, {"the models c", {}});
            }),
            "no name in common: the forest a has bowl, mug; the models c has nothing");
}

TEST(ClassNames, ManyNamesAreCutShort) {
  NamedSide many{"the scene b", {}};
  for (int i = 100; i < 150; ++i) many.names.insert("object_" + std::to_string(i));
  const std::string words = error_of([&] { require_shared_name({"the forest a", {"mug"}}, many); });
  EXPECT_NE(words.find("object_119 and 30 more"), std::string::npos) << words;
  EXPECT_EQ(words.find("object_120"), std::string::npos) << words;
}

TEST(ClassNames, AreThoseOfTruthAndDetections) {
  std::vector<EvaluatedFrame> frames(2);
  frames[0].objects = {{"mug", {}}, {"can", {}}};
  frames[1].objects = {{"mug", {}}};
  EXPECT_EQ(ground_truth_names(frames), (std::set<std::string>{"can", "mug"}));
  EXPECT_TRUE(ground_truth_names({}).empty());
  Detections result;
  result.detections.resize(1);
  result.detections[0].class_name = "bowl";
  EXPECT_EQ(detected_names({result, Detections{}}), std::set<std::string>{"bowl"});
}

}  // namespace
}  // namespace houghstream
