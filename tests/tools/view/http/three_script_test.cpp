#include "tools/view/http/three_script.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace houghstream::view {
namespace {

TEST(ThreeScript, IsTheFirstFileThatCanBeRead) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "three_script";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "empty.js");
  std::ofstream(folder / "second.js") << "var THREE;";
  std::ofstream(folder / "third.js") << "other";
  EXPECT_EQ(read_three_script({folder / "none.js", folder / "empty.js", folder / "second.js", folder / "third.js"}),
            "var THREE;");
}

TEST(ThreeScript, IsNothingWhereThePackageIsMissing) {
  EXPECT_FALSE(read_three_script({"/nowhere/three.js", "/nowhere/too/three.js"}).has_value());
  EXPECT_FALSE(read_three_script({"/"}).has_value()) << "a folder is no script";
}

}  // namespace
}  // namespace houghstream::view
