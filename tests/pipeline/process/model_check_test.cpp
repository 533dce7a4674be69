#include "pipeline/process/model_check.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

Detections detected(const std::string& object) {
  Detection detection;
  detection.class_name = object;
  return {{}, {detection}, {}};
}

TEST(ModelCheck, NamesBothSidesOnceWhereTheyShareNothing) {
  ModelCheck check({"mug", "can"});
  for (int i = 0; i < 9; ++i) EXPECT_FALSE(check.note(detected(i % 2 == 0 ? "bowl" : "box")).has_value());
  EXPECT_FALSE(check.note({}).has_value()) << "nothing found says nothing";
  EXPECT_EQ(check.note(detected("bowl")),
            "none of what was detected has a model: detected are bowl, box; there are models of can, mug");
  EXPECT_FALSE(check.note(detected("bowl")).has_value());
  EXPECT_FALSE(check.finish().has_value());
}

TEST(ModelCheck, AShortRunIsToldAtItsEnd) {
  ModelCheck check({"mug"});
  EXPECT_FALSE(check.finish().has_value());
  EXPECT_FALSE(check.note(detected("bowl")).has_value());
  EXPECT_TRUE(check.finish().has_value());
}

TEST(ModelCheck, OneCommonClassIsEnough) {
  ModelCheck check({"mug"});
  check.note(detected("mug"));
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(check.note(detected("bowl")).has_value());
  EXPECT_FALSE(check.finish().has_value());
  ModelCheck without({});
  without.note(detected("bowl"));
  EXPECT_FALSE(without.finish().has_value()) << "that there are no models is said elsewhere";
}

}  // namespace
}  // namespace houghstream
