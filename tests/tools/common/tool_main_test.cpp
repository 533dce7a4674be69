#include "tools/common/tool_main.hpp"

#include <gtest/gtest.h>

#include "tools/common/usage_error.hpp"

namespace houghstream {
namespace {

/// Runs run_tool with `words`; the captured streams show the output of `body`.
int run(std::vector<std::string> words, const std::function<void()>& body) {
  words.insert(words.begin(), "path/of/the/tool");
  std::vector<char*> argv;
  argv.reserve(words.size());
  for (std::string& word : words) argv.push_back(word.data());
  CommandLine line("words", "hs-tool");
  return run_tool(line, static_cast<int>(argv.size()), argv.data(), body);
}

TEST(ToolMain, AFailureIsOneLineAndAStatus) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(run({}, [] { fail("a.txt: 3 legs, expected 4"); }), 1);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "hs-tool: a.txt: 3 legs, expected 4\n");
}

TEST(ToolMain, WordsThatDoNotGoTogetherHaveTheStatusOfAnUnknownOption) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(run({}, [] { require_usage(false, "--a and --b, expected one of them"); }), 2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "hs-tool: --a and --b, expected one of them\n");
  testing::internal::CaptureStderr();
  EXPECT_EQ(run({"--nonsense"}, [] {}), 2);
  testing::internal::GetCapturedStderr();
}

TEST(ToolMain, WhatWorksEndsWithZero) {
  bool ran = false;
  EXPECT_EQ(run({"-v"}, [&] { ran = true; }), 0);
  EXPECT_TRUE(ran);
}

TEST(ToolMain, WhatIsNotUnderstoodIsNotBegun) {
  bool ran = false;
  testing::internal::CaptureStderr();
  EXPECT_NE(run({"--nonsense"}, [&] { ran = true; }), 0);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("--nonsense"), std::string::npos);
  EXPECT_FALSE(ran);
}

TEST(ToolMain, ItKnowsItsVersion) {
  bool ran = false;
  testing::internal::CaptureStdout();
  EXPECT_EQ(run({"--version"}, [&] { ran = true; }), 0);
  EXPECT_EQ(testing::internal::GetCapturedStdout().rfind("hs-tool ", 0), 0U);
  EXPECT_FALSE(ran);
}

}  // namespace
}  // namespace houghstream
