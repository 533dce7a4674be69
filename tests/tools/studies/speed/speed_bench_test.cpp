#include "tools/studies/speed/speed_bench.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "detector/forest/forest_file.hpp"
#include "detector/training/forest_trainer.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream {
namespace {

std::vector<RgbdFrame> some_frames(int count) {
  std::vector<RgbdFrame> frames(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) frames[static_cast<std::size_t>(i)].id.utime = i;
  return frames;
}

/// Writes its name and the frame's number down.
BenchmarkedDetector scribe(const std::string& name, std::size_t frames, std::string& words) {
  BenchmarkedDetector contender;
  contender.name = name;
  contender.frames = frames;
  contender.detect = [name, &words](const RgbdFrame& frame) {
    words += name + std::to_string(frame.id.utime) + " ";
    Detections found;
    found.stages = {{"detect.leaves", 1500}};
    found.detections.resize(2);
    return found;
  };
  return contender;
}

TEST(MeasureSpeed, AllLookAtAFrameBeforeTheNextAndTakeTurnsToBegin) {
  std::string words;
  const std::vector<BenchmarkedDetector> contenders = {scribe("a", 100, words), scribe("b", 100, words),
                                                       scribe("slow", 1, words)};
  const auto results = measure_speed(contenders, some_frames(3));
  EXPECT_EQ(words, "a0 a0 b0 b0 slow0 b1 a1 a2 b2 ");  // the first ones are for warming up
  EXPECT_EQ(results[0].ms.size(), 3U);
  EXPECT_EQ(results[2].ms.size(), 1U);
}

TEST(MeasureSpeed, StagesAndDetectionsAreAddedUp) {
  std::string words;
  const std::vector<BenchmarkedDetector> contenders = {scribe("a", 100, words)};
  const auto results = measure_speed(contenders, some_frames(4));
  const nlohmann::json json = to_json(contenders, results);
  EXPECT_EQ(json["a"]["frames"], 4);
  EXPECT_EQ(json["a"]["detections"], 8);
  EXPECT_EQ(json["a"]["stage_ms"]["detect.leaves"], 1.5);
  EXPECT_LE(json["a"]["ms"]["p10"], json["a"]["ms"]["p90"]);
  EXPECT_NE(speed_table(contenders, results).find("a "), std::string::npos);
}

TEST(MeasureSpeed, NoFramesIsAnError) {
  EXPECT_THROW(measure_speed({}, {}), InputError);
}

class ParseContender : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    save_forest(training::train_forest(toy::training_views(), toy::quick_profile(), [](const auto&) {}), forest_file());
  }
  static void TearDownTestSuite() { std::filesystem::remove(forest_file()); }
  static std::string forest_file() {
    return (std::filesystem::temp_directory_path() / "contender_test.forest").string();
  }

  static BenchmarkedDetector parse(const std::string& wishes) {
    return parse_contender("ours=" + forest_file() + wishes);
  }
};

TEST_F(ParseContender, WishesAreGranted) {
  const BenchmarkedDetector contender = parse(",threads=1,frames=3,scale=0.5");
  EXPECT_EQ(contender.name, "ours");
  EXPECT_EQ(contender.frames, 3U);
  EXPECT_EQ(contender.image_scale, 0.5);
  EXPECT_EQ(contender.instruction_set, 0);
}

TEST_F(ParseContender, ItDetectsAsTheDetectorDoes) {
  RgbdFrame frame = toy::background(77);
  toy::put_tile(0, 200, 200, 0.8, frame);
  const Detections fast = parse(",threads=2").detect(frame);
  const Detections reference = parse(",threads=1,reference").detect(frame);
  ASSERT_FALSE(fast.detections.empty());
  ASSERT_EQ(fast.detections.size(), reference.detections.size());
  EXPECT_EQ(fast.detections[0].score, reference.detections[0].score);
  EXPECT_FALSE(fast.stages.empty());
}

TEST_F(ParseContender, ItReportsFromTheThresholdAndMassThatItIsTold) {
  RgbdFrame frame = toy::background(77);
  toy::put_tile(0, 200, 200, 0.8, frame);
  const std::size_t usual = parse("").detect(frame).detections.size();
  EXPECT_GT(parse(",threshold=0,min-mass=0").detect(frame).detections.size(), usual);
  EXPECT_TRUE(parse(",threshold=1").detect(frame).detections.empty());
}

TEST_F(ParseContender, WhatIsNotUnderstoodIsNamed) {
  const auto words = [](const std::string& text) {
    try {
      parse_contender(text);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(words("no_forest"), ::testing::HasSubstr("expected NAME=FOREST"));
  for (const std::string wish : {"threads=0", "threads=two", "trees=1000", "frames=1.5", "scale=-1", "set=MMX", "fast",
                                 "threshold=2", "min-mass=low"}) {
    EXPECT_THAT(words("ours=" + forest_file() + "," + wish), ::testing::Not("no error")) << wish;
  }
}

TEST(ResizedFrame, CameraAndDepthFollow) {
  const RgbdFrame frame = toy::background(5);
  const RgbdFrame half = resized_frame(frame, 0.5);
  EXPECT_EQ(half.colour.cols, frame.colour.cols / 2);
  EXPECT_EQ(half.depth.size(), half.colour.size());
  EXPECT_DOUBLE_EQ(half.camera.fx, frame.camera.fx / 2);
  EXPECT_NO_THROW(check_frame(half, "half"));
}

}  // namespace

}  // namespace houghstream
