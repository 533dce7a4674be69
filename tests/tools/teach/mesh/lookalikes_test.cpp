#include "tools/teach/mesh/lookalikes.hpp"

#include <gtest/gtest.h>

#include "tests/tools/teach/shapes.hpp"

namespace houghstream::teach {
namespace {

std::vector<Lookalike> compare(const Mesh& one, const Mesh& other) {
  return find_lookalikes({{"one", &one}, {"other", &other}});
}

TEST(Lookalikes, TheSamePartElsewhereIsFound) {
  const std::vector<Lookalike> pairs = compare(crooked_part(), moved(crooked_part()));
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_FALSE(pairs[0].mirrored);
  EXPECT_NEAR(pairs[0].scale, 1.0, 0.02);
}

TEST(Lookalikes, AMirroredPartAndTwoSizesAreNamed) {
  const std::vector<Lookalike> mirror = compare(crooked_part(), moved(mirrored(crooked_part())));
  ASSERT_EQ(mirror.size(), 1U);
  EXPECT_TRUE(mirror[0].mirrored);
  EXPECT_EQ(describe(mirror[0]),
            "'one' and 'other' can hardly be told apart: the one is the other's mirror image, with colours alike or "
            "unknown");
  const std::vector<Lookalike> sizes = compare(crooked_part(0.1F), moved(crooked_part(0.115F)));
  ASSERT_EQ(sizes.size(), 1U);
  EXPECT_NE(describe(sizes[0]).find("'other' 1.15 times as large"), std::string::npos) << describe(sizes[0]);
  EXPECT_TRUE(compare(crooked_part(0.1F), crooked_part(0.15F)).empty()) << "depth tells these apart";
}

TEST(Lookalikes, OtherShapesAndOtherColoursAreNone) {
  Mesh brick;
  append_box({-0.05F, -0.03F, 0.0F}, {0.05F, 0.03F, 0.06F}, {40, 40, 200}, brick);
  compute_normals(brick);
  EXPECT_TRUE(compare(crooked_part(), brick).empty());
  Mesh green = moved(crooked_part());
  green.colours.assign(green.vertices.size(), cv::Vec3b(40, 220, 40));
  EXPECT_TRUE(compare(crooked_part(), green).empty());
  green.colours.clear();
  EXPECT_EQ(compare(crooked_part(), green).size(), 1U) << "an unknown colour tells nothing apart";
}

TEST(Lookalikes, WhatPracticeConfusesIsNamedOnce) {
  store::ObjectStore list;
  for (const char* name : {"mug", "cup", "can"}) {
    store::StoredObject& object = list.objects.emplace_back();
    object.name = name;
    object.practice.emplace().shown = 100;
  }
  EXPECT_TRUE(confusion_lines(list).empty());
  list.objects[0].practice->taken_for = {{"can", 4}, {"cup", 30}};
  list.objects[1].practice->taken_for = {{"mug", 12}};
  EXPECT_EQ(confusion_lines(list),
            std::vector<std::string>{"'mug' and 'cup' can hardly be told apart: in practice 'cup' is detected in the "
                                     "place of 'mug' in 30 % of 100 views, and 'mug' is detected in the place of 'cup' "
                                     "in 12 % of 100 views"});
  list.objects[2].practice->shown = 10;
  list.objects[2].practice->taken_for = {{"cup", 2}};
  EXPECT_EQ(confusion_lines(list).size(), 1U) << "twice may be chance";
  list.objects[2].practice->taken_for = {{"cup", 3}};
  EXPECT_EQ(confusion_lines(list).size(), 2U);
  for (store::StoredObject& object : list.objects) object.practice.reset();
  EXPECT_TRUE(confusion_lines(list).empty());
}

}  // namespace
}  // namespace houghstream::teach
