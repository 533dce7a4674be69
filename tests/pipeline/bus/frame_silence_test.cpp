#include "pipeline/bus/frame_silence.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace houghstream {
namespace {

/// Records the lines that are logged, and when, over some seconds in which frames arrive on some channels.
struct Watched {
  explicit Watched(const std::string& wanted) : silence(wanted, now) {}

  void run(double seconds, bool is_wanted_there, const std::vector<std::string>& others) {
    for (int step = 0; step < static_cast<int>(seconds * 20); ++step) {
      now += std::chrono::milliseconds(50);
      time_s += 0.05;
      if (is_wanted_there) silence.note_wanted(now);
      if (silence.wants_to_listen(now)) {
        listened_s += 0.05;
        for (const std::string& channel : others) silence.note_elsewhere(channel);
      }
      if (const auto words = silence.words(now)) {
        said.push_back(*words);
        said_at_s.push_back(time_s);
      }
    }
  }

  FrameSilence::Clock::time_point now;
  FrameSilence silence;
  double time_s = 0.0;
  double listened_s = 0.0;
  std::vector<std::string> said;
  std::vector<double> said_at_s;
};

TEST(FrameSilence, TheChannelsOfFramesAreNamedOnceAfterThreeSeconds) {
  Watched watched("OPENNI_FRAME");
  watched.run(100.0, false, {"RIGHT", "LEFT", "LEFT"});
  EXPECT_EQ(watched.said, (std::vector<std::string>{"no frame on OPENNI_FRAME; frames come on LEFT, RIGHT"}));
  EXPECT_GE(watched.said_at_s.at(0), 3.0);
  EXPECT_LE(watched.said_at_s.at(0), 4.0);
  EXPECT_LT(watched.listened_s, 20.0) << "to listen to everything costs";
}

TEST(FrameSilence, WhereFramesComeNothingIsListenedToNorSaid) {
  Watched watched("OPENNI_FRAME");
  watched.run(60.0, true, {"LEFT"});
  EXPECT_EQ(watched.listened_s, 0.0);
  EXPECT_TRUE(watched.said.empty());
}

TEST(FrameSilence, WhatComesLaterIsSaidThenAndNothingAtAllAfterTenSeconds) {
  Watched watched("OPENNI_FRAME");
  watched.run(9.0, false, {});
  EXPECT_TRUE(watched.said.empty()) << "a source may start a little later";
  watched.run(20.0, false, {});
  EXPECT_EQ(watched.said, (std::vector<std::string>{"no frame on OPENNI_FRAME, nor on any other channel"}));
  watched.run(20.0, false, {"LEFT"});
  ASSERT_EQ(watched.said.size(), 2U);
  EXPECT_EQ(watched.said.back(), "no frame on OPENNI_FRAME; frames come on LEFT");
}

TEST(FrameSilence, NamesOfSomebodysMakingAreFewAndHarmless) {
  Watched watched("OPENNI_FRAME");
  std::vector<std::string> channels = {"\x1b[2J"};
  for (int i = 0; i < 1000; ++i) channels.push_back("C" + std::to_string(1000 + i));
  watched.run(5.0, false, channels);
  ASSERT_EQ(watched.said.size(), 1U);
  EXPECT_EQ(watched.said.front().find('\x1b'), std::string::npos);
  EXPECT_LT(watched.said.front().size(), 200U);
}

}  // namespace
}  // namespace houghstream
