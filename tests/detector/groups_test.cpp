#include <gtest/gtest.h>

#include <algorithm>

#include "detector/detector.hpp"
#include "detector/stages.hpp"
#include "detector/training/object_removal.hpp"
#include "tests/detector/same_detections.hpp"
#include "tests/detector/toy_data.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

// Several forests of groups of objects, searched in one frame.

namespace houghstream {
namespace {

/// Returns a forest of one of the toy's objects.
const Forest& stripes() {
  static const Forest forest = training::remove_object(toy::forest(), "rings");
  return forest;
}

const Forest& rings() {
  static const Forest forest = training::remove_object(toy::forest(), "stripes");
  return forest;
}

DetectionSettings settings_without_colours() {
  DetectionSettings settings;
  settings.evidence.threshold = 0.3F;
  settings.evidence.learn_camera_colours = false;  // groups do not learn colours of each other
  return settings;
}

RgbdFrame both_tiles() {
  RgbdFrame frame = toy::background(77);
  toy::put_tile(0, 90, 100, 0.7, frame);
  toy::put_tile(1, 230, 120, 0.8, frame);
  return frame;
}

/// Returns the detections of one class.
Detections of_class(const Detections& all, const std::string& name) {
  Detections some;
  for (const Detection& detection : all.detections) {
    if (detection.class_name == name) some.detections.push_back(detection);
  }
  return some;
}

TEST(Groups, TogetherTheyFindWhatEachFindsAlone) {
  const RgbdFrame frame = both_tiles();
  const DetectionSettings settings = settings_without_colours();
  const Detections found = Detector(std::vector<Forest>{stripes(), rings()}, settings).detect(frame);
  for (const Forest* alone : {&stripes(), &rings()}) {
    const std::string& name = alone->classes.front().name;
    const Detections expected = Detector(*alone, settings).detect(frame);
    ASSERT_FALSE(expected.detections.empty()) << name;
    // The strongest: a weaker one may be suppressed by the other group's.
    Detections best = of_class(found, name);
    ASSERT_FALSE(best.detections.empty()) << name;
    best.detections.resize(1);
    expect_same(best, {expected.frame, {expected.detections.front()}, {}});
  }
  EXPECT_EQ(found.stages.size(), 6U) << "a stage of all groups is one stage";
}

TEST(Groups, OneIsSearchedAsAForestByItself) {
  const RgbdFrame frame = both_tiles();
  DetectionSettings settings;
  settings.evidence.candidates_from = 0.0F;
  const Detections alone = Detector(toy::forest(), settings).detect(frame);
  ASSERT_GE(alone.detections.size(), 2U);
  expect_same(Detector(std::vector<Forest>{toy::forest()}, settings).detect(frame), alone);
}

TEST(Groups, AnyNumberOfThreadsAndAUsedWorkspaceGiveTheSame) {
  const RgbdFrame frame = both_tiles();
  DetectionSettings settings;
  settings.evidence.candidates_from = 0.0F;
  settings.threads = 1;
  const Detections serial = Detector(std::vector<Forest>{stripes(), rings()}, settings).detect(frame);
  ASSERT_GE(serial.detections.size(), 2U);
  for (const int threads : {2, 5}) {
    settings.threads = threads;
    const Detector detector(std::vector<Forest>{stripes(), rings()}, settings);
    DetectorWorkspace workspace;
    detector.detect(toy::background(83), workspace);
    expect_same(detector.detect(frame, workspace), serial);
  }
}

TEST(Groups, SelectedOnesFindWhatTheyFindAmongAll) {
  const RgbdFrame frame = both_tiles();
  const Detector detector(std::vector<Forest>{stripes(), rings()}, settings_without_colours());
  const Detections all = detector.detect(frame);
  DetectorWorkspace workspace;
  for (const std::size_t group : {0U, 1U}) {
    const std::string& name = detector.groups()[group].classes.front().name;
    Detections found = detector.detect(frame, workspace, {}, {group});
    Detections expected = of_class(all, name);
    ASSERT_FALSE(expected.detections.empty()) << name;
    EXPECT_EQ(of_class(found, name).detections.size(), found.detections.size()) << "none of the other group";
    EXPECT_EQ(found.stages.size(), all.stages.size());
    // The strongest: a weaker one may be suppressed by the other group's.
    found.detections.resize(1);
    expected.detections.resize(1);
    expect_same(found, expected);
  }
  expect_same(detector.detect(frame, workspace, {}, {0, 1}), all);
}

TEST(Groups, ASelectedOnesShareOfTheCandidatesStaysThatAmongAll) {
  std::vector<Forest> groups{stripes()};
  for (int i = 0; i < 7; ++i) {  // which have no hypothesis
    Forest& absent = groups.emplace_back(rings());
    absent.classes.front().class_id = 10 + i;
    absent.classes.front().name = fmt::format("absent_{}", i);
    absent.classes.front().nominal_vote_mass *= 1e6F;
  }
  DetectionSettings settings = settings_without_colours();
  settings.evidence.threshold = 0.0F;
  settings.voting.candidates_per_class = 12;
  settings.suppression.max_overlap = 1.0F;
  const RgbdFrame frame = both_tiles();
  const Detections alone = Detector(stripes(), settings).detect(frame);
  const Detector detector(std::move(groups), settings);
  const Detections all = detector.detect(frame);
  ASSERT_GT(alone.detections.size(), all.detections.size()) << "of eight classes each has a smaller share";
  DetectorWorkspace workspace;
  expect_same(detector.detect(frame, workspace, {}, {0}), all);
}

TEST(Groups, IndicesThatAreNoneOrOutOfOrderAreRefused) {
  const RgbdFrame frame = both_tiles();
  const Detector detector(std::vector<Forest>{stripes(), rings()}, {});
  DetectorWorkspace workspace;
  for (const std::vector<std::size_t>& selected : {std::vector<std::size_t>{2}, {0, 5}, {1, 0}, {1, 1}})
    EXPECT_THROW(detector.detect(frame, workspace, {}, selected), std::logic_error);
}

TEST(Groups, AGroupsDetectionSuppressesWhatAnotherFindsThere) {
  Forest weaker = stripes();  // the same object under another name, which it never believes in more
  weaker.classes.front().class_id = 9;
  weaker.classes.front().name = "bars";
  weaker.classes.front().score_model.weights = {};
  weaker.classes.front().score_model.weights.constant = -1.0F;
  DetectionSettings settings = settings_without_colours();
  settings.evidence.threshold = 0.0F;
  const RgbdFrame frame = both_tiles();
  const Detection stronger = Detector(stripes(), settings).detect(frame).detections.front();
  const auto is_there = [&](const Detection& it) {
    return box_iou(it.box_px, stronger.box_px) > settings.suppression.max_overlap;
  };
  const Detections alone = Detector(weaker, settings).detect(frame);
  ASSERT_GT(stronger.score, 0.5F);
  ASSERT_TRUE(std::any_of(alone.detections.begin(), alone.detections.end(), is_there));
  for (const std::vector<Forest>& groups : {std::vector<Forest>{stripes(), weaker}, {weaker, stripes()}}) {
    const Detections found = Detector(groups, settings).detect(frame);
    EXPECT_EQ(found.detections.front().score, stronger.score);
    const Detections bars = of_class(found, "bars");
    EXPECT_TRUE(std::none_of(bars.detections.begin(), bars.detections.end(), is_there));
    EXPECT_LT(bars.detections.size(), alone.detections.size());
  }
}

TEST(Groups, ThoseThatCannotBeSearchedTogetherAreRefused) {
  const auto error_with = [](const Forest& second) {
    return error_of([&] { Detector(std::vector<Forest>{stripes(), second}, {}); });
  };
  expect_says(error_with(stripes()), {"forest 2 of 2: object 1 'stripes'", "expected an id and a name"});
  Forest renamed = rings();
  renamed.classes.front().name = "stripes";
  expect_says(error_with(renamed), {"object 2 'stripes'", "that no other has"});
  Forest other = rings();
  other.features.min_max_px = 7;
  expect_says(error_with(other), {"forest 2 of 2", "expected profile", "the settings of the first"});
  other = rings();
  other.features.families = 1;
  EXPECT_NE(error_with(other), "");
  other = rings();
  other.patch.radius += 2;
  EXPECT_NE(error_with(other), "");
  EXPECT_EQ(error_with(rings()), "");
  EXPECT_EQ(error_of([] { Detector(std::vector<Forest>{}, {}); }), "detector: no forest, expected at least one");
}

}  // namespace
}  // namespace houghstream
