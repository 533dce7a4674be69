#include "tools/studies/speed/speed_bench.hpp"

#include <gtest/gtest.h>

#include <string>

#include "pipeline/base/checks.hpp"

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

}  // namespace
}  // namespace houghstream
