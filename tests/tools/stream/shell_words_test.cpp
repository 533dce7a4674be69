#include "tools/stream/shell_words.hpp"

#include <gtest/gtest.h>

#include "tests/test_files.hpp"

namespace houghstream::stream {
namespace {

using Words = std::vector<std::string>;

TEST(ShellWords, BlanksAreBetweenWords) {
  EXPECT_EQ(shell_words("", "it"), Words());
  EXPECT_EQ(shell_words(" \t ", "it"), Words());
  EXPECT_EQ(shell_words("  --loop\t--rate 5\n", "it"), (Words{"--loop", "--rate", "5"}));
}

TEST(ShellWords, QuotesAndBackslashesKeepThem) {
  EXPECT_EQ(shell_words("--video 'my file.mp4'", "it"), (Words{"--video", "my file.mp4"}));
  EXPECT_EQ(shell_words("--video=\"my file.mp4\" -v", "it"), (Words{"--video=my file.mp4", "-v"}));
  EXPECT_EQ(shell_words("--video my\\ file.mp4", "it"), (Words{"--video", "my file.mp4"}));
  EXPECT_EQ(shell_words("a'b'\"c\"d", "it"), Words{"abcd"});
  EXPECT_EQ(shell_words("'' x", "it"), (Words{"", "x"}));
}

TEST(ShellWords, WhatStandsWithinQuotesIsTakenAsItIs) {
  EXPECT_EQ(shell_words(R"('CAMERA_\d "1"')", "it"), Words{R"(CAMERA_\d "1")"});
  EXPECT_EQ(shell_words(R"("it's \d \" \\")", "it"), Words{R"(it's \d " \)"});
  EXPECT_EQ(shell_words(R"(\'a\"\\)", "it"), Words{R"('a"\)"});
}

TEST(ShellWords, WhatHasNoEndIsRefusedInALine) {
  for (const char* text : {"--video 'my file", "\"", "'it's'", "x\\"}) {
    const std::string error = error_of([&] { shell_words(text, "--view-options"); });
    EXPECT_EQ(error.rfind("--view-options '" + std::string(text) + "': ", 0), 0U) << error;
  }
}

}  // namespace
}  // namespace houghstream::stream
