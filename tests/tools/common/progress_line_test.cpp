#include "tools/common/progress_line.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace houghstream {
namespace {

/// Holds an output whose time a test sets.
struct Said {
  double now = 100.0;
  std::string text;

  ProgressOutput output(bool is_terminal) {
    return {[this] { return now; }, [this](const std::string& words) { text += words; }, is_terminal};
  }
};

TEST(ProgressLine, WordsTellHowMuchIsDoneAndHowLongTheRestTakes) {
  EXPECT_EQ(progress_words("a.log", 25.0, 100.0, 4.0), "a.log: 25 %, about 12 s left");
  EXPECT_EQ(progress_words("a.log", 1.0, 100.0, 5.0), "a.log: 1 %, about 8 min 15 s left");
  EXPECT_EQ(progress_words("a.log", 1.0, 1000.0, 10.0), "a.log: 0 %, about 2 h 46 min left");
  EXPECT_EQ(progress_words("a.log", 200.0, 100.0, 4.0), "a.log: 100 %, about 0 s left");
  EXPECT_EQ(progress_words("a.log", 0.0, 100.0, 4.0), "a.log: 0 %");
  EXPECT_EQ(progress_words("frames", 340.0, 0.0, 4.0), "frames: 340 so far");
}

TEST(ProgressLine, WhatEndsSoonSaysNothing) {
  Said said;
  {
    ProgressLine line("work", 10.0, said.output(true));
    said.now += 1.9;
    line.at(9.0);
  }
  EXPECT_EQ(said.text, "");
}

TEST(ProgressLine, OnATerminalOneLineIsWrittenOverAndGoes) {
  Said said;
  std::optional<ProgressLine> line;
  line.emplace("work", 10.0, said.output(true));
  said.now += 2.0;
  line->at(1.0);
  EXPECT_EQ(said.text, "work: 10 %, about 18 s left\r");
  said.text.clear();
  said.now += 0.1;
  line->add(1.0);
  EXPECT_EQ(said.text, "") << "too soon";
  said.now += 1.9;
  line->add(6.0);
  EXPECT_EQ(said.text, "work: 80 %, about 1 s left \r") << "as long as the one before";
  said.text.clear();
  line.reset();
  EXPECT_EQ(said.text, std::string(27, ' ') + "\r");
}

TEST(ProgressLine, ElsewhereALineComesNowAndThen) {
  Said said;
  {
    ProgressLine line("work\x1b", 0.0, said.output(false));
    for (int second = 1; second <= 14; ++second) {
      said.now += 1.0;
      line.at(second);
    }
  }
  EXPECT_EQ(said.text, "work\\x1b: 2 so far\nwork\\x1b: 12 so far\n");
}

}  // namespace
}  // namespace houghstream
