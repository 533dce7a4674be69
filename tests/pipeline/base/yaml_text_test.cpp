#include "pipeline/base/yaml_text.hpp"

#include <gtest/gtest.h>

#include "tests/test_files.hpp"

namespace houghstream {
namespace {

TEST(YamlText, IsReadWithAHeaderOrWithoutAndWithWhatEndsAMessage) {
  for (const char* text : {"a: 1\n", "%YAML:1.0\n---\na: 1", "%YAML 1.2\n---\na: 1\n---\n"})
    EXPECT_EQ(yaml_number(yaml_member(parse_yaml(text, "a.yaml"), "a")), 1.0) << text;
}

TEST(YamlText, ListsNeedNoIndent) {
  const YAML::Node map = parse_yaml("k:\n- 1\n- x: 2\n  y: [3, .5]\nb: !!opencv-matrix\n  rows: 3\n", "a.yaml");
  const YAML::Node list = yaml_member(map, "k");
  ASSERT_TRUE(list.IsSequence());
  EXPECT_EQ(yaml_number(list[0]), 1.0);
  EXPECT_EQ(yaml_number(yaml_member(list[1], "x")), 2.0);
  EXPECT_EQ(yaml_number(yaml_member(list[1], "y")[1]), 0.5);
  EXPECT_EQ(yaml_number(yaml_member(yaml_member(map, "b"), "rows")), 3.0);
}

TEST(YamlText, WhatIsNotThereIsNoNumber) {
  const YAML::Node map = parse_yaml("a: text\nb: [1]\nc:\n", "a.yaml");
  for (const char* name : {"a", "b", "c", "d"}) EXPECT_FALSE(yaml_number(yaml_member(map, name)).has_value()) << name;
  EXPECT_FALSE(yaml_member(yaml_member(map, "a"), "deeper").IsDefined());
  EXPECT_FALSE(yaml_member(yaml_member(map, "d"), "deeper").IsDefined());
}

TEST(YamlText, WhatIsNoMapOfNamesIsRefusedNamingTheFile) {
  std::string brackets;
  for (int i = 0; i < 5000; ++i) brackets += "[\n ";
  std::string dashes;
  for (int i = 0; i < 5000; ++i) dashes += "- ";
  for (const std::string& text :
       {std::string(), std::string("640"), std::string("- 1\n- 2\n"), std::string("a: [1, 2"),
        std::string("a: 1\na: 2\n"), std::string("[a]: 1\n"), std::string("a: [0,\0\0\n", 9), "a:\n  " + brackets,
        "a:\n  " + dashes, std::string("-t\n0}\n--)\n"), std::string(1100000, '#')}) {
    const std::string error = error_of([&] { parse_yaml(text, "a.yaml"); });
    EXPECT_EQ(error.rfind("a.yaml: ", 0), 0U) << text.substr(0, 40) << ": " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace houghstream
