#include "tools/stream/stream_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream::stream {
namespace {

using Words = std::vector<std::string>;

TEST(StreamPlan, PutsTheStreamTogether) {
  StreamOptions options;
  options.executables = "/bin";
  options.source = "openni2";
  options.forest = "my.forest";
  options.models = "models";
  options.lcm_url = "udpm://239.255.76.67:7777?ttl=0";
  options.detect_options = "--threads 2  --threshold 0.3";
  const std::vector<ChildPlan> plans = plan_stream(options);
  ASSERT_EQ(plans.size(), 4U);
  EXPECT_EQ(plans[0].command, (Words{"/bin/hs-detect", "--channel", "OPENNI_FRAME", "--lcm-url", options.lcm_url,
                                     "--forest", "my.forest", "--threads", "2", "--threshold", "0.3"}));
  EXPECT_EQ(plans[1].name, "pose");
  EXPECT_EQ(plans[2].name, "view");
  EXPECT_EQ(plans[3].command.back(), "openni2");
  EXPECT_FALSE(plans[0].ends_stream);
  EXPECT_TRUE(plans[2].ends_stream);
  EXPECT_TRUE(plans[3].ends_stream);
  for (std::size_t i = 0; i < plans.size(); ++i) EXPECT_EQ(plans[i].is_started_last, i == 3) << "the source";
}

TEST(StreamPlan, AnObjectStoreIsForAll) {
  StreamOptions options;
  options.executables = "/bin";
  options.objects = "store";
  const std::vector<ChildPlan> plans = plan_stream(options);
  ASSERT_EQ(plans.size(), 3U);
  EXPECT_EQ(plans[0].command, (Words{"/bin/hs-detect", "--channel", "OPENNI_FRAME", "--objects", "store"}));
  EXPECT_EQ(plans[1].command, (Words{"/bin/hs-pose", "--channel", "OPENNI_FRAME", "--objects", "store"}));
  EXPECT_EQ(plans[2].command, (Words{"/bin/hs-view", "--channel", "OPENNI_FRAME", "--objects", "store"}));
}

TEST(StreamPlan, WhoFollowsLooksSeldom) {
  StreamOptions options;
  options.objects = "store";
  options.follow = true;
  options.pose_options = "--threads 2";
  EXPECT_EQ(plan_stream(options)[0].command.back(), "5");
  EXPECT_EQ(plan_stream(options)[1].command,
            (Words{"hs-pose", "--channel", "OPENNI_FRAME", "--objects", "store", "--follow", "--threads", "2"}));
  options.detect_options = "--looks-per-second 3";
  const Words own = plan_stream(options)[0].command;
  EXPECT_EQ(own.back(), "3");
  EXPECT_EQ(std::count(own.begin(), own.end(), "--looks-per-second"), 1);
}

TEST(StreamPlan, FurtherOptionsMayHaveBlanksInQuotes) {
  StreamOptions options;
  options.objects = "store";
  options.view_options = "--video 'my file.mp4'";
  EXPECT_EQ(plan_stream(options)[2].command.back(), "my file.mp4");
  options.view_options = "--video 'my file.mp4";
  EXPECT_THROW(plan_stream(options), InputError);
}

TEST(StreamPlan, LeavesOutWhatIsNotAskedFor) {
  StreamOptions options;
  options.executables = "/bin";
  options.forest = "my.forest";
  options.camera = "640x480,525,525,319.5,239.5";
  options.view = false;
  const std::vector<ChildPlan> plans = plan_stream(options);
  ASSERT_EQ(plans.size(), 1U) << "another driver sends the frames, there are no models and no window";
  EXPECT_EQ(plans[0].command, (Words{"/bin/hs-detect", "--channel", "OPENNI_FRAME", "--forest", "my.forest", "--camera",
                                     options.camera}));
}

TEST(StreamPlan, TrackingIsAskedForAndTakesTheModels) {
  StreamOptions options;
  options.executables = "";
  options.objects = "store";
  options.view = false;
  EXPECT_EQ(plan_stream(options).size(), 2U);
  options.track = true;
  options.track_options = "--cameras c.yaml";
  const std::vector<ChildPlan> plans = plan_stream(options);
  ASSERT_EQ(plans.size(), 3U);
  EXPECT_EQ(plans[2].name, "track");
  EXPECT_EQ(plans[2].command, (std::vector<std::string>{"hs-track", "--channel", "OPENNI_FRAME", "--objects", "store",
                                                        "--cameras", "c.yaml"}));
}

TEST(StreamPlan, APrecisionGoesToDetectionAndPoses) {
  StreamOptions options;
  options.objects = "store";
  options.precision = 0.98;
  options.track = true;
  for (const ChildPlan& child : plan_stream(options)) {
    const bool is_for_it = child.name == "detect" || child.name == "pose";
    EXPECT_EQ(std::count(child.command.begin(), child.command.end(), "--precision"), is_for_it ? 1 : 0) << child.name;
    if (is_for_it) {
      EXPECT_EQ(child.command.back(), "0.98");
    }
  }
}

TEST(StreamPlan, ThresholdsAndPlacesOfCamerasGoToThoseThatTakeThem) {
  StreamOptions options;
  options.objects = "store";
  options.threshold = 0.6;
  options.min_quality = 0.25;
  options.cameras = "my cameras.yaml";
  const std::vector<ChildPlan> plans = plan_stream(options);
  ASSERT_EQ(plans.size(), 4U) << "where cameras stand is for hs-track";
  const Words all = {"--channel", "OPENNI_FRAME", "--objects", "store"};
  const std::vector<Words> own = {
      {"--threshold", "0.6"}, {"--min-quality", "0.25"}, {"--cameras", "my cameras.yaml"}, {}};
  for (std::size_t i = 0; i < plans.size(); ++i) {
    Words expected = {"hs-" + plans[i].name};
    expected.insert(expected.end(), all.begin(), all.end());
    expected.insert(expected.end(), own[i].begin(), own[i].end());
    EXPECT_EQ(plans[i].command, expected);
  }
}

TEST(StreamPlan, EachOfSeveralCamerasHasACaptureOfItsOwn) {
  StreamOptions options;
  options.objects = "store";
  options.view = false;
  options.source = "LEFT=openni2:#1 RIGHT='bop:my scene=1'";
  const std::vector<ChildPlan> plans = plan_stream(options);
  ASSERT_EQ(plans.size(), 4U);
  EXPECT_EQ(plans[0].command, (Words{"hs-detect", "--channel", "LEFT|RIGHT", "--objects", "store"}));
  EXPECT_EQ(plans[2].name, "capture LEFT");
  EXPECT_EQ(plans[2].command, (Words{"hs-capture", "--channel", "LEFT", "--source", "openni2:#1"}));
  EXPECT_EQ(plans[3].command, (Words{"hs-capture", "--channel", "RIGHT", "--source", "bop:my scene=1"}));
  EXPECT_TRUE(plans[2].is_started_last && plans[3].is_started_last);
  for (const std::string wrong : {"LEFT=openni2 openni2:#2", "LEFT=openni2:#1 LEFT=openni2:#2"}) {
    options.source = wrong;
    EXPECT_THROW(plan_stream(options), InputError) << wrong;
  }
}

TEST(StreamPlan, ASourceWithBlanksOrAnEqualsSignInItsNameIsOne) {
  StreamOptions options;
  options.objects = "store";
  options.view = false;
  options.source = "bop:my folder/a=b";
  const std::vector<ChildPlan> plans = plan_stream(options);
  ASSERT_EQ(plans.size(), 3U);
  EXPECT_EQ(plans[2].command, (Words{"hs-capture", "--channel", "OPENNI_FRAME", "--source", "bop:my folder/a=b"}));
}

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
