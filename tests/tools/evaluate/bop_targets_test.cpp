#include "tools/evaluate/bop_targets.hpp"

#include <gtest/gtest.h>

#include "tests/test_files.hpp"
#include "tools/evaluate/metrics/detection_metrics.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

fs::path file_of(const std::string& text) {
  fs::path file = fresh_folder("bop_targets") / "test_targets_bop19.json";
  write_text(file, text);
  return file;
}

NamedObject object(int object_id, double visible) {
  NamedObject out;
  out.class_name = "object_" + std::to_string(object_id);
  out.truth.object_id = object_id;
  out.truth.visible_fraction = visible;
  out.truth.box_visible_px = {10, 10, 20, 20};
  return out;
}

/// Returns images 3 and 7 of scene 000048.
std::vector<EvaluatedFrame> frames() {
  std::vector<EvaluatedFrame> out(2);
  for (EvaluatedFrame& frame : out) frame.scene = "000048";
  out[0].image_id = 3;
  out[0].objects = {object(2, 0.3), object(2, 0.9), object(5, 1.0)};
  out[1].image_id = 7;
  out[1].objects = {object(5, 0.05)};
  return out;
}

TEST(BopTargets, OnlyWhatIsAskedForIsATarget) {
  const std::vector<EvaluatedFrame> kept = targeted_frames(frames(), {{48, 3, 2, 1}, {1, 7, 5, 1}}, "targets.json");
  ASSERT_EQ(kept.size(), 1U) << "image 7 is another scene's";
  EXPECT_EQ(kept[0].image_id, 3);
  EXPECT_EQ(kept[0].objects[0].is_target, false);
  EXPECT_EQ(kept[0].objects[1].is_target, true) << "the more visible one";
  EXPECT_EQ(kept[0].objects[2].is_target, false);
  EXPECT_EQ(count_required(kept, "object_2", {}), 1);
  EXPECT_EQ(count_required(kept, "object_5", {}), 0);
  const std::vector<EvaluatedFrame> hidden = targeted_frames(frames(), {{48, 7, 5, 1}}, "targets.json");
  EXPECT_EQ(count_required(hidden, "object_5", {}), 1) << "asked for, however little is visible";
}

TEST(BopTargets, FoundThoughNotAskedForIsNeitherTrueNorFalse) {
  std::vector<EvaluatedFrame> kept = targeted_frames(frames(), {{48, 3, 2, 1}}, "targets.json");
  Detection detection;
  detection.class_name = "object_5";
  detection.box_px = {10, 10, 20, 20};
  kept[0].detections = Detections{{}, {detection}, {}};
  EXPECT_EQ(match_detections(kept, "object_5", {})[0].outcome, MatchOutcome::kIgnored);
}

TEST(BopTargets, WhatTheTruthLacksIsRefused) {
  const auto refusal = [](const std::vector<BopTarget>& targets) {
    return error_of([&] { targeted_frames(frames(), targets, "targets.json"); });
  };
  EXPECT_EQ(refusal({{1, 3, 2, 1}}), "targets.json: no targets in scene 000048");
  EXPECT_EQ(refusal({{48, 3, 2, 1}, {48, 9, 2, 1}}),
            "targets.json: image 9 of scene 000048 is asked for, which the scene lacks");
  EXPECT_EQ(refusal({{48, 3, 2, 3}}), "targets.json: scene 000048 image 3: 3 of object 2 asked for, the truth has 2");
}

TEST(BopTargets, TheFileIsReadAsBopPublishesIt) {
  const std::vector<BopTarget> targets =
      read_bop_targets(file_of(R"([{"im_id": 3, "inst_count": 2, "obj_id": 2, "scene_id": 48},
                  {"im_id": 7, "inst_count": 1, "obj_id": 5, "scene_id": 48}])"));
  ASSERT_EQ(targets.size(), 2U);
  EXPECT_EQ(targets[0].scene_id, 48);
  EXPECT_EQ(targets[0].image_id, 3);
  EXPECT_EQ(targets[0].object_id, 2);
  EXPECT_EQ(targets[0].count, 2);
}

TEST(BopTargets, BadFilesAreRefusedWithOneLine) {
  const auto refusal = [](const std::string& text) {
    const std::string line = error_of([&] { read_bop_targets(file_of(text)); });
    return line.substr(line.find("bop19.json"));
  };
  const std::string good = R"({"im_id": 3, "inst_count": 2, "obj_id": 2, "scene_id": 48})";
  EXPECT_EQ(refusal("{}"), "bop19.json: not a JSON list, or cut short");
  EXPECT_EQ(refusal("[" + good), "bop19.json: not a JSON list, or cut short");
  EXPECT_EQ(refusal("[]"), "bop19.json: no targets");
  EXPECT_EQ(refusal("[" + good + "," + good + "]"),
            "bop19.json entry 2: asks again for object 2 in image 3 of scene 48");
  EXPECT_EQ(refusal(R"([{"im_id": 3, "inst_count": 0, "obj_id": 2, "scene_id": 48}])"),
            "bop19.json entry 1: inst_count is 0, expected 1 or more");
  EXPECT_NE(refusal(R"([{"im_id": 3, "obj_id": 2, "scene_id": 48}])").find("no 'inst_count'"), std::string::npos);
  EXPECT_THROW(read_bop_targets("/no/such/file.json"), InputError);
}

}  // namespace
}  // namespace houghstream
