#include "detector/detection_candidates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "detector/training/forest_trainer.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream {
namespace {

const Forest& toy_forest() {
  static const Forest forest = train_forest(toy::training_views(), toy::quick_profile(), [](const auto&) {});
  return forest;
}

std::vector<Candidate> candidates(const RgbdFrame& frame, const std::vector<std::uint32_t>& forgotten = {}) {
  StageClock clock;
  return find_candidates(toy_forest(), frame, {}, clock, forgotten);
}

TEST(DetectionCandidates, TheStrongestOfAClassComesWithEvidenceForIt) {
  RgbdFrame frame = toy::room(77);
  const cv::Mat mask = toy::put_tile(0, 159.5, 119.5, 0.7, frame);
  const std::vector<Candidate> found = candidates(frame);
  ASSERT_FALSE(found.empty());
  const Candidate& best = found.front();
  EXPECT_EQ(best.detection.class_id, 1);
  EXPECT_GT(best.evidence.mass_share, 0.3F);
  EXPECT_GT(best.evidence.fit.visible, 0.8F);
  EXPECT_GT(best.evidence.fit.likeness, 0.5F);
  EXPECT_GT(box_iou(best.detection.box_px, cv::Rect2f(cv::boundingRect(mask))), 0.7F);
  EXPECT_EQ(best.detection.score, score(toy_forest().classes[0].score_model, best.evidence));
}

TEST(DetectionCandidates, ForgottenViewsAreNotCompared) {
  RgbdFrame frame = toy::room(77);
  toy::put_tile(0, 159.5, 119.5, 0.7, frame);
  std::vector<std::uint32_t> all;
  for (std::uint32_t v = 0; v < toy_forest().views.size(); ++v) all.push_back(v);
  const std::vector<Candidate> found = candidates(frame, all);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front().evidence.fit.visible, 0.0F);
}

TEST(DetectionCandidates, NoClassOffersMoreThanItMay) {
  RgbdFrame frame = toy::room(77);
  toy::put_tile(0, 80, 119.5, 0.7, frame);
  toy::put_tile(0, 240, 119.5, 0.7, frame);
  const auto stripes = [&](int max_per_class) {
    DetectionSettings settings;
    settings.max_per_class = max_per_class;
    StageClock clock;
    const std::vector<Candidate> found = find_candidates(toy_forest(), frame, settings, clock);
    return std::count_if(found.begin(), found.end(), [](const Candidate& c) { return c.detection.class_id == 1; });
  };
  EXPECT_GE(stripes(250), 2);
  EXPECT_EQ(stripes(1), 1);
}

TEST(DetectionCandidates, StagesAreTimed) {
  StageClock clock;
  find_candidates(toy_forest(), toy::room(78), {}, clock);
  std::vector<std::string> names;
  for (const StageTime& time : clock.times()) names.push_back(time.stage);
  EXPECT_EQ(names, (std::vector<std::string>{"detect.resize", "detect.features", "detect.forest", "detect.voting"}));
}

}  // namespace
}  // namespace houghstream
