#include "pipeline/text/yaml_text.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

const std::string kHeader = "%YAML:1.0\n---\n";

TEST(YamlText, HasOneHeaderWhetherItHadOneOrNot) {
  EXPECT_EQ(yaml_for_opencv("a: 1\n", "a.yaml"), kHeader + "a: 1\n");
  EXPECT_EQ(yaml_for_opencv("%YAML:1.0\n---\na: 1", "a.yaml"), kHeader + "a: 1\n");
  EXPECT_EQ(yaml_for_opencv("", "a.yaml"), kHeader);
}

TEST(YamlText, ListsAreIndentedAndWhatEndsAMessageGoes) {
  EXPECT_EQ(yaml_for_opencv("k:\n- 1\n- x: 2\n  y: 3\nb: 4\n---\n", "a.yaml"),
            kHeader + "k:\n  - 1\n  - x: 2\n    y: 3\nb: 4\n");
}

TEST(YamlText, AByteZeroIsRefused) {
  EXPECT_THROW(yaml_for_opencv(std::string("a: [0,\0\0\n", 10), "a.yaml"), InputError);
}

// OpenCV's reader would need 25 MB of the stack.
TEST(YamlText, ListsWithinListsWithoutEndAreRefused) {
  std::string brackets;
  for (int i = 0; i < 5000; ++i) brackets += "[\n";
  std::string dashes;
  for (int i = 0; i < 5000; ++i) dashes += "- ";
  for (const std::string& deep : {brackets, dashes})
    EXPECT_THROW(yaml_for_opencv("a: 1\nmore:\n  " + deep + "1\n", "a.yaml"), InputError);
}

}  // namespace
}  // namespace houghstream
